"""Prints a JUnit report in Markdown, for systems that show no JUnit by themselves: the verdict with what it means, what to do, and a
table of the checks. python3 junit.py report.xml"""

import re
import sys
import xml.etree.ElementTree

MARKS = {"failure": "FAIL", "error": "ERROR", "skipped": "skipped"}
ENTITIES = {"&": "&amp;", "<": "&lt;"}


def cell(text):
    """Text that ends no cell of a table, and is shown as it is: CommonMark takes a backslash before any ASCII punctuation."""
    line = re.sub(r"[ \t\r\n]+", " ", text.strip())
    return re.sub(r"[!-/:-@[-`{-~]", lambda mark: ENTITIES.get(mark[0], "\\" + mark[0]), line)


def rows(suites):
    for case in suites.iter("testcase"):
        unlucky = [(mark, said) for said in case if (mark := MARKS.get(said.tag))]
        mark, said = unlucky[0] if unlucky else ("passed", None)
        message = "" if said is None else said.get("message") or (said.text or "").strip()
        yield f"| {cell(case.get('name', ''))} | {mark} | {cell(message)} |"


def head(suites):
    """The verdict's line, which says what was tested, what was not exercised, and what to do."""
    for said in suites.iter("system-out"):
        verdict = (said.text or "").strip().split("\n")[0]
        if verdict:
            yield f"**{cell(verdict)}**\n"
    for said in suites.iter("property"):
        if said.get("name") == "not_exercised":
            yield f"{cell(said.get('value', ''))}\n"
    for case in suites.iter("testcase"):
        if case.get("name") == "verdict":
            lines = [line for said in case for line in (said.text or "").strip().split("\n") if line.strip()]
            yield from (f"- {cell(line)}" for line in lines)
            yield from [""] * bool(lines)


def main():
    try:
        suites = xml.etree.ElementTree.parse(sys.argv[1]).getroot()
    except (OSError, IndexError, xml.etree.ElementTree.ParseError) as problem:
        # A run that was refused has no report; its message stands in the log.
        print(f"No report could be read: {cell(str(problem))}")
        return
    print(*head(suites), sep="\n")
    print("| check | | |\n|---|---|---|", *rows(suites), sep="\n")


main()
