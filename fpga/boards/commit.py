#!/usr/bin/env python3
"""The commit that a bitstream is built from: from the archive of the sources, or from git.
    commit.py     prints its first eight digits, or zeros where neither tells it"""

import pathlib
import re
import subprocess

FPGA = pathlib.Path(__file__).resolve().parent.parent
NONE = "0" * 40
# Filled in by `git archive`, so that an archive knows its commit.
ARCHIVED = FPGA.parent / "host/judge/commit.txt"


def said(*arguments):
    """The output of git in the project's folder, or None where it fails or is missing."""
    try:
        done = subprocess.run(["git", "-C", FPGA.parent, *arguments], capture_output=True, text=True)
    except OSError:
        return None
    return done.stdout.strip() if done.returncode == 0 else None


def git(*arguments):
    """The output of git for the project, or None where it has no repository. One that the project was copied into has commits of
    its own."""
    return said(*arguments) if said("rev-parse", "--show-prefix") == "" else None


def archived():
    """All forty digits as the archive of the sources has them, or None in a repository."""
    found = re.match("[0-9a-f]{40}$", ARCHIVED.read_text()) if ARCHIVED.exists() else None
    return found and found[0]


def whole():
    """All forty digits."""
    return archived() or git("rev-parse", "HEAD") or NONE


def start():
    """The first eight digits: HALFROW_BUILD of the sources."""
    return whole()[:8]


def modified(*but):
    """Whether the folder `fpga`, without these files, differs from the commit. True also if git cannot tell; an archive is taken as it
    was given away."""
    if archived():
        return False
    excluded = (f":!{path.relative_to(FPGA.parent)}" for path in but)
    return git("status", "--porcelain", "--", FPGA.name, *excluded) != ""


if __name__ == "__main__":
    print(start())
