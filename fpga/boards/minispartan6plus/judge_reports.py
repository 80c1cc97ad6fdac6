#!/usr/bin/env python3
"""Reads the reports of an ISE build and refuses a bitstream that they do not show to be what was asked for: every report there; no error, no
latch, no net with several drivers; every constraint of top.ucf as strict as constraints.py has it, met, and covering a path or a net; no
path that no constraint covers; all nets routed; block RAMs and DSP slices as fpga/checks/budget.ini expects.
    judge_reports.py FOLDER KIND [sensor]     FOLDER holds top.ucf, top.syr (or top.edif by yosys), top.bld, top_map.mrp, top.par, top.twr
The forms are those of ISE 14.7 (UG628, UG687, and reports that others have published); none of ours has been made by ISE."""

import fnmatch
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "checks"))

import budget
import constraints

BOARD = pathlib.Path(__file__).resolve().parent.name
# Registers of paths that need no constraint, and why.
UNCONSTRAINED = {
    "board/number/*": "the FPGA's own number is shifted by a clock of 1.5 MHz that a register makes, half a period away from its data",
}
COUNTED = {"RAMB16BWER": "whole_rams", "DSP48A1": "dsps"}


def first(pattern, text):
    found = re.search(pattern, text)
    return int(found[1].replace(",", "")) if found else None


def errors(report, text, form=r"Number of errors:\s*([\d,]+)"):
    """Faults by a report's own count of errors."""
    count = first(form, text)
    if count != 0:
        yield f"{report}: {'no count of errors' if count is None else f'{count} errors'}"


def synthesis(text):
    """Faults in top.syr, by XST."""
    for latch in re.findall(r"Found \d+-bit latch for signal <[^\n]*?>(?=\.)", text):
        yield f"top.syr: {latch}"
    for kind, count in re.findall(r"^#\s+(LD[A-Z]*(?:_1)?)\s+: (\d+)", text, re.MULTILINE):
        yield f"top.syr: {count} latches {kind}"
    for line in re.findall(r"^.*(?:Multi-source|multiple drivers).*$", text, re.MULTILINE):
        yield f"top.syr: {line.strip()}"
    yield from errors("top.syr", text, r"Number of errors\s*:\s*([\d,]+)")


def translation(text):
    """Faults in top.bld, by ngdbuild."""
    for line in re.findall(r"^(?:WARNING|ERROR):ConstraintSystem.*$", text, re.MULTILINE):
        yield f"top.bld: {line.strip()}"
    for line in re.findall(r"^.*multiple drivers.*$", text, re.MULTILINE):
        yield f"top.bld: {line.strip()}"
    yield from errors("top.bld", text)


def mapping(text, expected):
    """Faults in top_map.mrp, by map."""
    yield from errors("top_map.mrp", text)
    latches = first(r"Number used as Latches:\s*([\d,]+)", text)
    if latches != 0:
        yield f"top_map.mrp: {'no count of latches' if latches is None else f'{latches} latches'}"
    for kind, key in COUNTED.items():
        count = first(rf"Number of {kind}s:\s*([\d,]+) out of", text)
        if count != int(expected[key]):
            yield f"top_map.mrp: {count} {kind}, and {expected[key]} are expected"
    if small := first(r"Number of RAMB8BWERs:\s*([\d,]+) out of", text):
        yield f"top_map.mrp: {small} RAMB8BWER, and none are expected"


def routing(text):
    """Faults in top.par, by par."""
    for wanted in ("All signals are completely routed", "All constraints were met"):
        if wanted not in text:
            yield f"top.par does not say: {wanted}"


def wanted_constraints(ucf):
    """The name of each timing constraint of a UCF that is no TIG, with a pattern for the name that trce gives it."""
    lines = re.sub(r"^\s*#.*$", "", ucf, flags=re.MULTILINE)
    for name in re.findall(r'^TIMESPEC\s+"(\w+)"', lines, re.MULTILINE):
        yield name, rf"{name} ="
    for direction in re.findall(r"^OFFSET\s*=\s*(IN|OUT)\b", lines, re.MULTILINE):
        yield f"OFFSET = {direction}", rf"OFFSET = {direction} "
    for net in re.findall(r'^NET\s+"([^"]+)"\s+MAXDELAY', lines, re.MULTILINE):
        yield f"MAXDELAY of {net}", rf'NET "{re.escape(net)}" MAXDELAY'


def sections(text):
    """The constraints of a trce report: (its text in one line, what follows below it)."""
    parts = re.split(r"^Timing constraint:\s*", text, flags=re.MULTILINE)[1:]
    for part in parts:
        words, rest = (re.split(r"For more information|\n\s*\n", part, maxsplit=1) + [""])[:2]
        yield " ".join(words.split()), rest


def covered(rest):
    """How many paths or nets a constraint was checked on."""
    return first(r"([\d,]+) (?:paths?|nets?|items?) analyzed", rest) or 0


def timing(text, ucf):
    """Faults in top.twr, by trce -v -u."""
    if not re.search(r"^Timing errors: 0 ", text, re.MULTILINE):
        yield "top.twr: a timing constraint is not met, or none was tried"
    found = list(sections(text))
    for name, pattern in wanted_constraints(ucf):
        of_it = [rest for words, rest in found if re.match(pattern, words)]
        # trce turns the constraint of a PLL's input into one for each output, which names it.
        derived = [rest for words, rest in found if re.search(rf"\b{re.escape(name)}\b [*/]", words)]
        if not of_it:
            yield f"top.twr: the constraint {name} is missing"
        elif not any(covered(rest) for rest in of_it + derived):
            yield f"top.twr: the constraint {name} covers no path"
    free = [(words, rest) for words, rest in found if words.startswith("Unconstrained")]
    if not any(words.startswith("Unconstrained path") for words, _ in free):
        yield "top.twr does not tell of unconstrained paths; call trce with -u"
    for words, rest in free:
        yield from unconstrained(words, rest)


def unconstrained(words, rest):
    """Those of a section's paths that are not known to need no constraint."""
    listed = re.findall(r"Source:\s+(\S+).*?Destination:\s+(\S+)", rest, re.DOTALL)
    for source, destination in listed:
        if not any(fnmatch.fnmatchcase(end, known) for end in (source, destination) for known in UNCONSTRAINED):
            yield f"top.twr: no constraint covers the path from {source} to {destination}"
    count = covered(rest)
    if count > len(listed):
        yield f"top.twr: {count} paths under `{words}`, of which {len(listed)} are told; call trce with a larger -u"


def faults(folder, kind, sensor):
    texts, by_yosys = {}, (folder / "top.edif").exists()
    names = ["top.ucf", "top.bld", "top_map.mrp", "top.par", "top.twr"] + ([] if by_yosys else ["top.syr"])
    for name in names:
        try:
            texts[name] = (folder / name).read_text(errors="replace")
        except OSError as error:
            yield f"{name} cannot be read: {error.strerror}"
    if len(texts) < len(names):
        return
    expected = next(limits for top, limits in budget.tops() if (top.board, top.kind, top.sensor) == (BOARD, kind, sensor))
    yield from constraints.faults(texts["top.ucf"], kind, sensor, float(expected["crossing_ns"]))
    if not by_yosys:
        yield from synthesis(texts["top.syr"])
    yield from translation(texts["top.bld"])
    yield from mapping(texts["top_map.mrp"], expected)
    yield from routing(texts["top.par"])
    yield from timing(texts["top.twr"], texts["top.ucf"])


def main():
    if len(sys.argv) not in (3, 4) or sys.argv[2] not in ("fifo", "uart") or sys.argv[3:] not in ([], ["sensor"]):
        sys.exit(__doc__)
    wrong = list(faults(pathlib.Path(sys.argv[1]), sys.argv[2], bool(sys.argv[3:])))
    if wrong:
        sys.exit("the reports do not prove this bitstream:\n  " + "\n  ".join(wrong))
    print("the reports show what was asked for")


if __name__ == "__main__":
    main()
