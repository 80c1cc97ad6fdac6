#!/usr/bin/env python3
"""Checks that judges refuse: all edits of refused.txt that belong to a judge, made in a copy of the sources, must be named by it.
    refused.py JUDGE...     JUDGE: a program of fpga, such as checks/form.py; with none it only reads refused.txt
"""
import pathlib
import subprocess
import sys
import tempfile

import edits

CASES = pathlib.Path(__file__).resolve().parent / "refused.txt"
JUDGES = ["bench/modules", *(f"checks/{name}.py" for name in ("crossings", "dialect", "form", "parameters", "refused", "wire"))]


def missed(judge, cases):
    with tempfile.TemporaryDirectory() as scratch:
        tree = pathlib.Path(scratch)
        edits.spoil(tree, cases)
        done = subprocess.run([sys.executable, tree / "fpga" / judge], capture_output=True, text=True)
        said = done.stdout + done.stderr
        return [f"{judge} does not refuse {path}: {edit}" for path, edit, spoilt in cases if not done.returncode or spoilt not in said]


def main():
    all_cases = edits.by_kind(CASES, JUDGES)
    for judge in sys.argv[1:]:
        cases = all_cases[judge]
        if wrong := missed(judge, cases):
            sys.exit("refused: " + "\nrefused: ".join(wrong))
        print(f"PASS {judge} refuses {len(cases)} edits")


if __name__ == "__main__":
    main()
