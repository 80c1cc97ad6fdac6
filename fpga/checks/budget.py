"""Reads budget.ini."""

import configparser
import pathlib

import tops as boards


def sections():
    """All builds by name."""
    read = configparser.ConfigParser(interpolation=None)
    read.read_string((pathlib.Path(__file__).resolve().parent / "budget.ini").read_text())
    return {name: read[name] for name in read.sections()}


def top_of(build):
    """The board's top that a build is, or None where it is a module of fpga/rtl."""
    return boards.Top(build["board"], build["kind"], build.getboolean("sensor")) if "board" in build else None


def tops():
    """The builds that are a board's tops: (top, limits)."""
    return [(top_of(build), build) for build in sections().values() if top_of(build)]
