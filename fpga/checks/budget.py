"""Reads budget.ini, and refuses keys that no check uses and limits in the wrong unit."""

import configparser
import pathlib
import re
import sys

import tops as boards

# The keys that describe a build; a board's top has the last three.
BUILD = {"top", "parameters", "board", "kind", "sensor"}
NUMBER, SHARE = r"[0-9]+(\.[0-9]+)?", r"[0-9]+(\.[0-9]+)?%"
EITHER = f"{NUMBER}|{SHARE}"
# The unit of each limit: a number, a share of the chip, or either.
LIMITS = {"luts": EITHER, "registers": EITHER, "block_rams": EITHER, "dsps": EITHER, "mean": SHARE, "whole_rams": NUMBER,
          "arithmetic": NUMBER, "carry_bits": NUMBER, "lut_levels": NUMBER, "mhz": NUMBER, "crossing_ns": NUMBER}


def read(text):
    """All builds by name."""
    parser = configparser.ConfigParser(interpolation=None)
    parser.read_string(text)
    return {name: parser[name] for name in parser.sections()}


def faults(builds):
    """Keys and limits that no check could hold a build to."""
    for name, build in builds.items():
        for key, value in build.items():
            if key not in BUILD and key not in LIMITS:
                yield f"[{name}] {key} is none of {', '.join(sorted(BUILD | set(LIMITS)))}"
            elif key in LIMITS and not re.fullmatch(LIMITS[key], value):
                units = {NUMBER: "a number", SHARE: "a share with %", EITHER: "a number, or a share with %"}
                yield f"[{name}] {key} is {value!r}, not {units[LIMITS[key]]}"


def sections():
    """All builds of budget.ini by name."""
    builds = read((pathlib.Path(__file__).resolve().parent / "budget.ini").read_text())
    wrong = list(faults(builds))
    if wrong:
        sys.exit("budget.ini: " + "\nbudget.ini: ".join(wrong))
    return builds


def top_of(build):
    """The board's top that the build is, or None for a module of fpga/rtl."""
    return boards.Top(build["board"], build["kind"], build.getboolean("sensor")) if "board" in build else None


def tops():
    """The builds that are tops of boards: (top, limits)."""
    return [(top_of(build), build) for build in sections().values() if top_of(build)]
