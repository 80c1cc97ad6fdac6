#!/usr/bin/env python3
"""Holds fpga/rtl and the boards' sources to what XST of ISE 14.7 reads for certain, where Verilog-2001 as other tools know it allows more.
A rule is a function; the file of its name in fpga/checks/dialect breaks it, and must be refused by it alone.
"""
import itertools
import pathlib
import re
import subprocess
import sys
import tempfile

import rtl

HERE = pathlib.Path(__file__).resolve().parent
MEMORY = re.compile(r"^ *(\(\*.*?\*\) *)?reg\b[^;=\n]*?\b(\w+) \[[^\]]*:[^\]]*\];", re.MULTILINE)
# A replication whose count is no plain number.
REPLICATION = re.compile(r"\{ *([^{},;\"]*[A-Za-z_][^{},;\"]*)\{")


def bare(text):
    """Without comments and strings, and with as many lines."""
    return re.sub(r'//[^\n]*|"[^"\n]*"', "", text)


def line_of(text, place):
    return text.count("\n", 0, place) + 1


def memories(text):
    """Name, attributes, line."""
    return [(found[2], found[1] or "", line_of(text, found.start(2))) for found in MEMORY.finditer(text)]


def ram_style_missing(text):
    """A memory's kind is said and not left to a size that XST decides by."""
    for name, attributes, line in memories(text):
        if "ram_style" not in attributes:
            yield line, f"the memory {name} has no ram_style"


def memory_of_many_writers(text):
    """XST may take elements that are driven from several always blocks for several drivers of one memory."""
    code = bare(text)
    loops = [found.start() for found in re.finditer(r"\bfor \(\w+ = .*?\) begin :", code)]
    for name, _, line in memories(text):
        writes = [found.start() for found in re.finditer(rf"\b{name}\[[^;<]*\] <= ", code)]
        blocks = {code.rfind("always", 0, place) for place in writes}
        if len(blocks) > 1 or any(loop < block for loop in loops for block in blocks):
            yield line, f"the elements of {name} are driven from several always blocks; use a vector"


def initial_value_missing(text):
    """A register without one starts as 0, which is active at a pin whose name ends in _n."""
    for found in re.finditer(r"^ *output +reg +(?:\[[^\]]+\] +)?(\w+_n)\b(?! = )", bare(text), re.MULTILINE):
        yield line_of(text, found.start(1)), f"{found[1]} is active from the configuration to its first clock; give it an initial value"


def probed(path, text):
    """The module with a look at every replication's count at its end."""
    code = bare(text)
    probes = [f'    initial if (({found[1]}) < 1) $display("{path}:{line_of(code, found.start())}: a replication of {found[1].strip()} = %0d", {found[1]});'
              for found in REPLICATION.finditer(code)]
    return re.sub(r"^endmodule", "\n".join([*probes, "endmodule"]), text, flags=re.MULTILINE)


def zero_replications(sources, top, parameters=()):
    """No replication of none, which is legal from Verilog-2005 on. Counts are those of the build, so it is elaborated."""
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        for path in sources:
            (folder / path.name).write_text(probed(path, path.read_text()))
        built = subprocess.run(["iverilog", "-g2005", f"-I{rtl.RTL}", "-y", work, "-s", top, *(f"-P{top}.{word}" for word in parameters),
                                "-o", f"{work}/built", f"{work}/{top}.v"], capture_output=True, text=True)
        if built.returncode != 0:
            sys.exit(f"dialect: {top} with {' '.join(parameters)} does not elaborate:\n{built.stderr}")
        return subprocess.run(["vvp", "-n", f"{work}/built"], capture_output=True, text=True, check=True).stdout.splitlines()


RULES = [ram_style_missing, memory_of_many_writers, initial_value_missing]


def offences(path):
    text = path.read_text()
    return [(rule.__name__, f"{path}:{line}: {what}") for rule in RULES for line, what in rule(text)]


def refuses_its_cases():
    cases = {path.stem: path for path in (HERE / "dialect").glob("*.v")}
    if set(cases) != {"zero_replications", *(rule.__name__ for rule in RULES)}:
        sys.exit("dialect: fpga/checks/dialect has not one file a rule")
    for name, path in cases.items():
        broken = {rule for rule, _ in offences(path)} | ({"zero_replications"} if zero_replications([path], path.stem) else set())
        if broken != {name}:
            sys.exit(f"dialect: {path} must break {name} alone, and breaks {', '.join(sorted(broken)) or 'nothing'}")
    return len(cases)


def main():
    modules = list(rtl.modules().values())
    boards = sorted((HERE.parent / "boards").glob("*/*.v"))
    wrong = [what for path in modules + boards for _, what in offences(path)]
    for top, taps, banks, trap in itertools.product(("halfrow_fifo_bridge", "halfrow_uart_bridge"), (5, 7), (1, 2), (0, 1)):
        wrong += zero_replications(modules, top, (f"TAPS={taps}", f"TABLE_BANKS={banks}", f"TRAP={trap}"))
    if wrong:
        sys.exit("dialect: " + "\ndialect: ".join(sorted(set(wrong))))
    print(f"PASS {len(modules) + len(boards)} files keep to XST's dialect, and each of {refuses_its_cases()} rules refuses its case")


main()
