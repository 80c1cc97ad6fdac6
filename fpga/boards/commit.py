#!/usr/bin/env python3
"""The commit that a bitstream is built from, from git.
    commit.py     prints its first eight digits, or zeros where there is no git or no repository"""

import pathlib
import subprocess

FPGA = pathlib.Path(__file__).resolve().parent.parent
NONE = "0" * 40


def git(*arguments):
    """The output of git for the project, or None where there is no git or no repository."""
    try:
        done = subprocess.run(["git", "-C", FPGA.parent, *arguments], capture_output=True, text=True)
    except OSError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def whole():
    """All forty digits."""
    return git("rev-parse", "HEAD") or NONE


def start():
    """The first eight digits: HALFROW_BUILD of the sources."""
    return whole()[:8]


def modified(*but):
    """Whether the folder `fpga`, without these files, differs from the commit. True also if git cannot tell."""
    excluded = (f":!{path.relative_to(FPGA.parent)}" for path in but)
    return git("status", "--porcelain", "--", FPGA.name, *excluded) != ""


if __name__ == "__main__":
    print(start())
