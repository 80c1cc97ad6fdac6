#!/usr/bin/env python3
"""Tests judge_reports.py on the reports of reports/: as they are it must accept them; with each fault of reports/bad.txt it must refuse
them and say what is given there; and without one of them. The constraints of all four tops are held to constraints.py."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import constraints
import judge_reports
import edif  # found where judge_reports looks

HERE = pathlib.Path(__file__).resolve().parent
REPORTS = ("top.syr", "top.bld", "top_map.mrp", "top.par", "top.twr")


def judged(folder):
    return subprocess.run([sys.executable, HERE / "judge_reports.py", folder, "fifo", "sensor"], capture_output=True, text=True)


def laid(folder):
    """Copies the good reports to the folder, and the constraints that belong to them."""
    for name in REPORTS:
        shutil.copy(HERE / "reports" / name, folder)
    (folder / "top.ucf").write_text(edif.ucf_of(edif.tops.Top(judge_reports.BOARD, "fifo", True)))


def too_slack():
    """Where a top's constraints ask too little."""
    for top, limits in judge_reports.budget.tops():
        if top.board == judge_reports.BOARD:
            yield from constraints.faults(edif.ucf_of(top), top.kind, top.sensor, float(limits["crossing_ns"]))


def refused(folder, wanted):
    ended = judged(folder)
    return [] if ended.returncode != 0 and wanted in ended.stderr else [f"`{wanted}` is not refused: {ended.stdout}{ended.stderr}"]


def main():
    wrong, count = list(too_slack()), 0
    lines = (HERE / "reports/bad.txt").read_text().splitlines()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        laid(folder)
        good = judged(folder)
        if good.returncode != 0:
            wrong.append(f"the good reports are refused: {good.stderr}")
        for line in lines:
            if line.startswith("#"):
                continue
            name, edit, wanted = re.match(r"(\S+)\s+(.*\S)\s{2,}(.*)", line).groups()
            laid(folder)
            before = (folder / name).read_text()
            after = subprocess.run(["sed", "-E", edit], input=before, capture_output=True, text=True, check=True).stdout
            if after == before:
                wrong.append(f"bad.txt: {edit} changes nothing in {name}")
            (folder / name).write_text(after)
            wrong += refused(folder, wanted)
            count += 1
        for name in REPORTS:
            laid(folder)
            (folder / name).unlink()
            wrong += refused(folder, f"{name} cannot be read")
    if wrong:
        sys.exit("judge_cases: " + "\njudge_cases: ".join(wrong))
    print(f"PASS {count} faults in the reports of a build are refused")


if __name__ == "__main__":
    main()
