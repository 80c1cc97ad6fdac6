#!/usr/bin/env python3
"""Holds fpga/rtl and the boards' sources to what XST of ISE 14.7 is sure to read, which is less than the Verilog-2001 that other tools
accept. A rule is a function. The file of its name in fpga/checks/dialect breaks it, and must be refused by this rule alone.
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
# The names of a declaration, without its attributes and range.
REGISTERS = re.compile(r"^ *(?:\(\*.*?\*\) *)?reg\b(?: signed)?(?: *\[[^\]]*\])* ([^;]*);", re.MULTILINE)
# A replication whose count is not a plain number.
REPLICATION = re.compile(r"\{ *([^{},;\"]*[A-Za-z_][^{},;\"]*)\{")
ACTIVE = "may be active from the configuration to its first clock; give its register an initial value"


def bare(text):
    """The text without comments and strings, with the same number of lines."""
    return re.sub(r'//[^\n]*|"[^"\n]*"', "", text)


def line_of(text, place):
    return text.count("\n", 0, place) + 1


def memories(text):
    """Name, attributes and line of each memory."""
    return [(found[2], found[1] or "", line_of(text, found.start(2))) for found in MEMORY.finditer(text)]


def ram_style_missing(text):
    """The kind of a memory must be given, and not left to XST, which decides by size."""
    for name, attributes, line in memories(text):
        if "ram_style" not in attributes:
            yield line, f"the memory {name} has no ram_style"


def memory_of_many_writers(text):
    """XST might take elements that are driven from several always blocks for several drivers of one memory."""
    code = bare(text)
    loops = [found.start() for found in re.finditer(r"\bfor \(\w+ = .*?\) begin :", code)]
    for name, _, line in memories(text):
        writes = [found.start() for found in re.finditer(rf"\b{name}\[[^;<]*\] <= ", code)]
        blocks = {code.rfind("always", 0, place) for place in writes}
        if len(blocks) > 1 or any(loop < block for loop in loops for block in blocks):
            yield line, f"the elements of {name} are driven from several always blocks; use a vector"


def initial_value_missing(text):
    """A register without an initial value starts as 0, which is active at a pin whose name ends in _n."""
    code = bare(text)
    for found in re.finditer(r"^ *output +reg +(?:\[[^\]]+\] +)?(\w+_n)\b(?! = )", code, re.MULTILINE):
        yield line_of(text, found.start(1)), f"{found[1]} {ACTIVE}"
    declared = [found[1].split(",") for found in REGISTERS.finditer(code)]
    started_as_0 = {name.strip() for names in declared for name in names if "=" not in name}
    for found in re.finditer(r"\bassign (\w+_n) = ([^;]*);", code):
        if started_as_0 & set(re.findall(r"\w+", found[2])):
            yield line_of(text, found.start(1)), f"{found[1]} {ACTIVE}"


def probes(path, text):
    """Conditions that only an elaborated build can show: (rule, condition of a fault, message, its values). The register of a
    pin may be in another module."""
    code = bare(text)
    for found in REPLICATION.finditer(code):
        yield "zero_replications", f"({found[1]}) < 1", f"{path}:{line_of(code, found.start())}: a replication of {found[1].strip()} = %0d", found[1]
    for found in re.finditer(r"^ *output +(?:reg|wire) +(?:\[[^\]]+\] +)?(\w+_n)\b", code, re.MULTILINE):
        yield "initial_value_missing", f"&{found[1]} !== 1'b1", f"{path}:{line_of(code, found.start(1))}: {found[1]} is %b and {ACTIVE}", found[1]


def probed(path, text):
    """The module with its probes added at its end."""
    looks = [f'    initial #0 if ({fails}) $display("{rule} {what}", {values});' for rule, fails, what, values in probes(path, text)]
    return re.sub(r"^endmodule", "\n".join([*looks, "endmodule"]), text, flags=re.MULTILINE)


def judged_build(sources, top, parameters=()):
    """What a build breaks, as (rule, what), and the modules in it. The build is elaborated, since counts and pins depend on it.
    It must have no replication with a count of 0, which is legal only from Verilog-2005 on, and no pin that is active before
    the first clock."""
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        for path in sources:
            (folder / path.name).write_text(probed(path, path.read_text()))
        built = subprocess.run(["iverilog", "-g2005", f"-I{rtl.RTL}", "-y", work, "-s", top, *(f"-P{top}.{word}" for word in parameters),
                                "-o", f"{work}/built", f"{work}/{top}.v"], capture_output=True, text=True)
        if built.returncode != 0:
            sys.exit(f"dialect: {top} with {' '.join(parameters)} does not elaborate:\n{built.stderr}")
        said = subprocess.run(["vvp", "-n", f"{work}/built"], capture_output=True, text=True, check=True).stdout.splitlines()
        inside = set(re.findall(r'^S_\w+ \.scope module[^"]*"[^"]*" "([^"]*)"', (folder / "built").read_text(), re.MULTILINE))
        return [tuple(line.split(" ", 1)) for line in said], inside


RULES = [ram_style_missing, memory_of_many_writers, initial_value_missing]


def offences(path):
    text = path.read_text()
    return [(rule.__name__, f"{path}:{line}: {what}") for rule in RULES for line, what in rule(text)]


def refuses_its_cases():
    cases = {path.stem: path for path in (HERE / "dialect").glob("*.v")}
    if set(cases) != {"zero_replications", *(rule.__name__ for rule in RULES)}:
        sys.exit("dialect: fpga/checks/dialect has not one file a rule")
    for name, path in cases.items():
        broken = {rule for rule, _ in offences(path) + judged_build([path], path.stem)[0]}
        if broken != {name}:
            sys.exit(f"dialect: {path} must break {name} alone, and breaks {', '.join(sorted(broken)) or 'nothing'}")
    return len(cases)


def of_builds(modules):
    """What the builds of both bridges break, and the modules that are in none of them, so that nothing here has checked them in
    a whole build."""
    wrong, missing = [], {path.stem for path in modules}
    links, sizes = ("halfrow_fifo_bridge", "halfrow_uart_bridge"), {"TAPS": (5, 7), "TABLE_BANKS": (1, 2), "TRAP": (0, 1), "GRID": (0, 1)}
    for top, *values in itertools.product(links, *sizes.values()):
        broken, inside = judged_build(modules, top, [f"{name}={value}" for name, value in zip(sizes, values)])
        wrong += [what for _, what in broken]
        missing -= inside
    return wrong + [f"{name} is in none of the builds" for name in missing]


def main():
    modules = list(rtl.modules().values())
    boards = sorted((HERE.parent / "boards").glob("*/*.v"))
    wrong = [what for path in modules + boards for _, what in offences(path)] + of_builds(modules)
    if wrong:
        sys.exit("dialect: " + "\ndialect: ".join(sorted(set(wrong))))
    print(f"PASS {len(modules) + len(boards)} files keep to XST's dialect, and each of {refuses_its_cases()} rules refuses its case")


if __name__ == "__main__":
    main()
