#!/usr/bin/env python3
"""Holds the numbers of fpga/rtl/halfrow_wire.vh to the tables of protocol/WIRE.md, both ways: none is missing, none is
extra."""
import re
import sys

import rtl

PAGE = rtl.RTL.parent.parent / "protocol" / "WIRE.md"
INCLUDE = rtl.RTL / "halfrow_wire.vh"
DATAPATH = rtl.RTL.parent / "DATAPATH.md"
AT_SPEED = rtl.RTL.parent / "AT-SPEED.md"


def constant(name):
    return re.sub(r"\W+", "_", name.strip()).upper()


def section(page, begin, end):
    found = re.search(rf"^#+ {begin}.*?(?=^#+ {end})", page, re.MULTILINE | re.DOTALL)
    if not found:
        sys.exit(f"wire: {PAGE.name} has no section {begin}")
    return found[0]


def expected(page):
    """The page's numbers by their names in the include file."""
    numbers = {}
    for heading in re.findall(r"^### ([0-9a-f]{2} [A-Z].*)$", page, re.MULTILINE):
        for code, name in re.findall(r"([0-9a-f]{2}) ([A-Z_]+)", heading):
            numbers[f"KIND_{name}"] = int(code, 16)
    refusals = section(page, "6. Refusals", "7")
    numbers["KIND_REFUSAL"] = int(re.search(r"Kind ([0-9a-f]{2}), as a reply", refusals)[1], 16)
    for code, name in re.findall(r"^\| (\d+) \| ([a-z ]+) \|", refusals, re.MULTILINE):
        numbers[f"REFUSAL_{constant(name)}"] = int(code)
    tags = section(page, "01 CAPABILITIES", "02")
    for tag, value in re.findall(r"^\| ([0-9a-f]{2}) \| ([^|]+) \|", tags, re.MULTILINE):
        name = "TAG_" + (constant(value.split()[1].strip(",")) if value.startswith("`") else "NAME")
        if name in numbers:
            sys.exit(f"wire: the tags {numbers[name]:02x} and {tag} of {PAGE.name} are both {name}; a value without a type is the board's name alone")
        numbers[name] = int(tag, 16)
    for group, row, names in [("CLOCK", "clock_source", {"the host's own": "HOST", "the sensor's PIXCLK": "PIXCLK", "a PLL": "PLL"}),
                              ("NATURE", "nature", {name: name.upper() for name in ("hardware", "simulation", "mock")})]:
        text = re.search(rf"`u8` {row} \| (.*?) \|$", tags, re.MULTILINE)[1]
        for number, name in re.findall(r"(\d): ([^,(]+?)(?= \(|,|$)", text):
            numbers[f"{group}_{names[name]}"] = int(number)
    status = section(page, "02 STATUS", "03")
    for number, name in re.findall(r"^\| (\d+) \| (\w+) \|", status, re.MULTILINE):
        numbers[f"COUNTER_{constant(name)}"] = int(number)
    return numbers


def alone(page):
    """Numbers from the page's sentences."""
    flat = " ".join(page.split())

    def said(pattern, base=10):
        found = re.search(pattern, flat)
        if not found:
            sys.exit(f"wire: {PAGE.name} does not say {pattern!r}")
        return int(found[1].replace(" ", ""), base)

    magic = bytes.fromhex(re.search(r"magic `([0-9a-f ]+)`", page)[1])
    span = re.search(r"A \*\*span\*\* is (.*?)\. An", page, re.DOTALL)[1]
    return {
        "WIRE_VERSION": said(r"`u8` version \| (\d+)\."),
        "WIRE_MAGIC": int.from_bytes(magic, "little"),
        "DATAPATH_ID": int(re.search(r"\*\*datapath id\*\* of this page is \*\*(\d+)\*\*", DATAPATH.read_text())[1]),
        "GRID_DATAPATH_ID": said(r"a further datapath of \[DATAPATH.md\]\([^)]*\), which is (\d+):"),
        "CONTENT_ID": int(re.search(r"\*\*content id\*\* of this page is \*\*(\d+)\*\*", AT_SPEED.read_text())[1]),
        "RECORD_BYTES": said(r"count records of (\d+) bytes"),
        "RESET_CLOSES": said(r"; (\d) also closes the session"),
        "RESET_WIPES": said(r"; (\d) also drops configuration and tables"),
        "TABLE_STEPS": said(r"`u8` table \((\d): row factors,"),
        "TABLE_KERNEL": said(r"`u8` table \([^)]*(\d): kernel,"),
        "TABLE_GRID": said(r"`u8` table \([^)]*(\d): grid\)"),
        "SPAN_BYTES": sum(int(bits) for bits in re.findall(r"`u(\d+)`", span)) // 8,
        "MOST_PAYLOAD": said(r"Request: any bytes, up to (\d+)\."),
        "NODES": said(r"Spans end before row max_height, node (\d+) and grid entry T"),
        "LEAST_WIDTH": said(r"Width is even, (\d+) to max_width"),
    }


def included():
    numbers = {}
    for name, digits in re.findall(r"^localparam (?:\[\d+:0\] )?(\w+) = ([^;]+);", INCLUDE.read_text(), re.MULTILINE):
        sized = re.fullmatch(r"\d+'([hd])(\w+)", digits)
        numbers[name] = int(sized[2], 16 if sized[1] == "h" else 10) if sized else int(digits)
    return numbers


def main():
    page = PAGE.read_text()
    tables = expected(page)
    groups = {group: sum(name.startswith(group + "_") for name in tables) for group in
              ("KIND", "REFUSAL", "TAG", "CLOCK", "NATURE", "COUNTER")}
    # Fewer than version 1 has means that the page's form has changed and is no longer understood.
    least = {"KIND": 18, "REFUSAL": 12, "TAG": 20, "CLOCK": 3, "NATURE": 3, "COUNTER": 16}
    if any(groups[group] < least[group] for group in least):
        sys.exit(f"wire: found only {groups} in {PAGE.name}; has the form of its tables changed?")
    wanted, given = {**tables, **alone(page)}, included()
    wrong = [f"{name} is {given.get(name, 'missing')} in {INCLUDE.name} and {wanted.get(name, 'not there')} on the page"
             for name in sorted(wanted.keys() | given.keys()) if wanted.get(name) != given.get(name)]
    if wrong:
        sys.exit("wire: " + "\nwire: ".join(wrong))
    print(f"PASS {INCLUDE.name}: {len(given)} numbers are those of {PAGE.name}")


if __name__ == "__main__":
    main()
