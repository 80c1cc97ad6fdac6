#!/usr/bin/env python3
"""The commit that a bitstream is built from, as git says it.
    commit.py     prints its first eight digits, or zeros where there is no git or no repository"""

import pathlib
import subprocess

FPGA = pathlib.Path(__file__).resolve().parent.parent
NONE = "0" * 40


def git(*arguments):
    """What git says of the project, or None where there is no git or no repository."""
    try:
        done = subprocess.run(["git", "-C", FPGA.parent, *arguments], capture_output=True, text=True)
    except OSError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def whole():
    """Forty digits."""
    return git("rev-parse", "HEAD") or NONE


def start():
    """Eight digits, HALFROW_BUILD of the sources."""
    return whole()[:8]


def modified(*but):
    """Whether the folder `fpga`, but for these files, is not as the commit has it, or nobody knows."""
    excluded = (f":!{path.relative_to(FPGA.parent)}" for path in but)
    return git("status", "--porcelain", "--", FPGA.name, *excluded) != ""


if __name__ == "__main__":
    print(start())
