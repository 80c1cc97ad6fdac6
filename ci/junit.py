"""Prints a JUnit report as a table in Markdown, for systems that show no JUnit by themselves: python3 junit.py report.xml"""

import sys
import xml.etree.ElementTree

MARKS = {"failure": "FAIL", "error": "ERROR", "skipped": "skipped"}


def cell(text):
    """Text that ends no cell of a table, and is no markup."""
    for plain, written in (("&", "&amp;"), ("<", "&lt;"), ("|", "\\|"), ("\n", " ")):
        text = text.replace(plain, written)
    return text


def rows(suites):
    for case in suites.iter("testcase"):
        unlucky = [(mark, said) for said in case if (mark := MARKS.get(said.tag))]
        mark, said = unlucky[0] if unlucky else ("passed", None)
        message = "" if said is None else said.get("message") or (said.text or "").strip()
        yield f"| {cell(case.get('name', ''))} | {mark} | {cell(message)} |"


def main():
    try:
        suites = xml.etree.ElementTree.parse(sys.argv[1]).getroot()
    except (OSError, IndexError, xml.etree.ElementTree.ParseError) as problem:
        # A run that was refused has no report; its message stands in the log.
        print(f"No report could be read: {cell(str(problem))}")
        return
    print("| check | | |\n|---|---|---|", *rows(suites), sep="\n")


main()
