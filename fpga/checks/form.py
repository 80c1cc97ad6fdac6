#!/usr/bin/env python3
"""Holds the files of fpga/rtl to one form: one module a file, named like the file, in a folder; under 400 lines of at most 120 columns; no
tabs, no spaces at the ends of lines; `default_nettype none at the top and wire at the end; every parameter and every port on a line of its
own, ports in columns; no other alignment in code, so that a changed line leaves its neighbours alone.
"""
import re
import sys

import rtl

COLUMNS, LINES = 120, 400
PORT = re.compile(r"    (input |output|inout ) (wire|reg ) (signed )?(\[[^]]+\])? *\w+( = [0-9]+'[bdh][0-9a-f]+)?,?$")


def parameters(lines):
    """A module's parameters must be in its head, one a line, so that rtl.py finds them all."""
    in_head = False
    for number, line in enumerate(lines, 1):
        code = re.sub(r'"[^"]*"', '""', line.split("//")[0].rstrip())
        in_head = in_head and not line.startswith(") (")
        alone = len(re.findall(r"(?<![=!<>])=(?!=)", code)) == 1
        if (code and not (rtl.PARAMETER.match(code) and alone)) if in_head else re.search(r"\bparameter\b", code):
            yield number, "a parameter that is not `parameter [type] [range] NAME = value` on a line of the module's head"
        in_head = in_head or line.startswith("module ") and line.endswith(" #(")


def offences(path):
    text = path.read_text()
    lines = text.split("\n")
    if len(lines) > LINES:
        yield 1, f"{LINES} lines or more"
    if lines[-1] != "":
        yield len(lines), "no newline at the end"
    if path.suffix == ".v":
        if re.findall(r"^module (\w+)", text, re.MULTILINE) != [path.stem]:
            yield 1, f"is not the module {path.stem} and no other"
        code = [line for line in lines if line and not line.startswith("//")]
        if code[0] != "`default_nettype none" or code[-1] != "`default_nettype wire":
            yield 1, "is not between `default_nettype none and `default_nettype wire"
    yield from parameters(lines)
    in_ports, columns = False, set()
    for number, line in enumerate(lines, 1):
        if len(line) > COLUMNS:
            yield number, f"more than {COLUMNS} columns"
        if "\t" in line or line != line.rstrip():
            yield number, "a tab, or spaces at the end"
        in_ports = in_ports or line.startswith(") (") or (line.startswith("module ") and line.endswith(" ("))
        code = re.sub(r'"[^"]*"', '""', line.split("//")[0].rstrip())
        if in_ports and re.match(r"    (input|output|inout)\b", code):
            if not PORT.match(code):
                yield number, "a port that is not `direction type [range] name`"
            columns.add(re.search(r"\w+( = \S+)?,?$", code).start())
        elif re.search(r"\S  ", code) or re.search(r"\[ ", code):
            yield number, "code that is aligned by spaces"
        if in_ports and line.startswith(");"):
            in_ports = False
            if len(columns) > 1:
                yield number, "the ports' names do not stand in one column"


def main():
    found = 0
    if list(rtl.RTL.glob("*.v")) or not rtl.modules():
        sys.exit("form: modules stand in the folders of fpga/rtl")
    files = [*rtl.modules().values(), *sorted(rtl.RTL.glob("*.vh"))]
    for path in files:
        for number, what in offences(path):
            print(f"{path}:{number}: {what}", file=sys.stderr)
            found += 1
    if found:
        sys.exit(f"form: {found} lines are not of the one form")
    print(f"PASS {len(files)} files are of the one form")


if __name__ == "__main__":
    main()
