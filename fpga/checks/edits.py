"""Edits of the sources that a check must refuse: how their files are read, and a copy of the sources with the edits made."""

import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
IGNORED = shutil.ignore_patterns("target", "model", "mock", "sim", "coverage", "__pycache__")


def by_kind(file, kinds):
    """(file in the project, edit for `sed -E`, what the check must say) of each line, by its first column, which is one of these kinds.
    An edit of another kind would never be tried, so it is refused, and so is a kind without an edit."""
    lines = [line.strip() for line in file.read_text().splitlines() if line and not line.startswith("#")]
    found = {kind: [] for kind in kinds}
    for first, *rest in (re.split(r"\s{2,}", line, maxsplit=3) for line in lines):
        found.setdefault(first, []).append(tuple(rest))
    wrong = [f"{first} is no kind of {file.name}" for first in found if first not in kinds]
    wrong += [f"{file.name} has no edit of {kind}" for kind in kinds if not found[kind]]
    if wrong:
        sys.exit("edits: " + "\nedits: ".join(wrong))
    return found


def spoil(tree, edits):
    """Makes the folder `tree` a copy of fpga and of protocol/WIRE.md with all these edits."""
    shutil.copytree(ROOT / "fpga", tree / "fpga", ignore=IGNORED)
    (tree / "protocol").mkdir()
    shutil.copy(ROOT / "protocol/WIRE.md", tree / "protocol")
    for path, edit, _ in edits:
        before = (tree / path).read_text()
        after = subprocess.run(["sed", "-E", edit], input=before, capture_output=True, text=True, check=True).stdout
        if after == before:
            sys.exit(f"edits: {edit} changes nothing in {path}")
        (tree / path).write_text(after)
