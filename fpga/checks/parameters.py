#!/usr/bin/env python3
"""Elaborates the builds of parameters.ini with Icarus Verilog, which is the quickest. An illegal build must fail, and the failure must name
the parameter; builds at the ends of the legal range must pass. Every parameter of fpga/rtl must be listed there.
    fpga/checks/parameters.py [long] [MODULE...]     long: with Verilator and yosys as well
"""
import concurrent.futures
import configparser
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import rtl

HERE = pathlib.Path(__file__).resolve().parent
OTHERS = ("legal", "any")
TOOLS = ("iverilog", "verilator", "yosys")


def unlisted(cases):
    """Parameters that no section lists, and keys of sections that are not parameters."""
    inside = {f"halfrow_{name}" for name in cases["inside"]["modules"].split()}
    for module, path in rtl.modules().items():
        names = set(rtl.parameters(path.read_text()))
        if module in cases:
            listed = {key for key in cases[module] if key not in OTHERS} | set(cases[module].get("any", "").split())
            yield from (f"{module}: {name}" for name in sorted(names ^ listed))
        elif (names != set()) != (module in inside):
            yield f"{module}: {'its parameters' if names else 'it has none'}"


def undeclared():
    """Parameters that mutation.ini gives to modules that do not have them."""
    builds = configparser.ConfigParser(interpolation=None)
    builds.read(HERE / "mutation.ini")
    for module in builds.sections():
        given = (word.split("=")[0] for word in builds[module].get("parameters", "").split())
        yield from (f"mutation.ini: {module}: {name}" for name in sorted(set(given) - set(rtl.parameters(rtl.modules()[module].read_text()))))


def wrapper(module, values):
    return f"module elaborated;\n    {module} #({', '.join(f'.{name}({value})' for name, value in values)}) dut ();\nendmodule\n"


def assignments(first, words):
    """`VALUE, NAME=VALUE...` or `NAME=VALUE, ...` as pairs."""
    parts = [part.strip() for part in re.split(r',(?=(?:[^"]*"[^"]*")*[^"]*$)', words)]
    return [tuple(part.split("=", 1)) if re.match(r"[A-Z_]+=", part) else (first, part) for part in parts]


def commands(source, folder):
    folders = sorted({path.parent for path in rtl.modules().values()})
    search = [f"-I{rtl.RTL}", *(word for place in folders for word in ("-y", str(place)))]
    return {
        "verilator": ["verilator", "--lint-only", "-Wno-fatal", "-Wno-PINMISSING", "--Mdir", str(folder), "--top-module", "elaborated", *search,
                      str(source)],
        "iverilog": ["iverilog", "-g2001", "-t", "null", "-s", "elaborated", *search, str(source)],
        "yosys": ["yosys", "-q", "-p",
                  f"{rtl.includes()}read_verilog {source}; hierarchy -check {rtl.libraries()} -top elaborated"],
    }


def judged(module, parameter, values, tools, work):
    """What is wrong with a case by these of TOOLS. `parameter` names the illegal parameter; it is None for a legal case."""
    with tempfile.TemporaryDirectory(dir=work) as folder:
        source = pathlib.Path(folder) / "elaborated.v"
        source.write_text(wrapper(module, values))
        wrong = []
        for tool in tools:
            done = subprocess.run(commands(source, folder)[tool], capture_output=True, text=True)
            said = done.stdout + done.stderr
            shown = f"{tool}: {module} with {', '.join(f'{name}={value}' for name, value in values)}"
            if parameter is None and done.returncode != 0:
                wrong.append(f"{shown} is legal and does not elaborate:\n{said[-1500:]}")
            elif parameter is not None and done.returncode == 0:
                wrong.append(f"{shown} elaborates")
            elif parameter is not None and not re.search(rf"\bhalfrow_illegal_{parameter}\b", said):
                wrong.append(f"{shown} does not elaborate, but {parameter} is not named:\n{said[-1500:]}")
        return wrong


def main():
    cases = configparser.ConfigParser(interpolation=None, comment_prefixes=(";",), inline_comment_prefixes=None)
    cases.optionxform = str
    cases.read(HERE / "parameters.ini")
    missing = [*unlisted(cases), *undeclared()]
    if missing:
        sys.exit("parameters: parameters.ini and fpga/rtl do not agree on\n  " + "\n  ".join(missing))
    words = sys.argv[1:]
    tools = TOOLS if "long" in words else TOOLS[:1]
    known = [section for section in cases.sections() if section != "inside"]
    chosen = [word for word in words if word != "long"] or known
    if unknown := set(chosen) - set(known):
        sys.exit(f"parameters: there is no {', '.join(sorted(unknown))} in parameters.ini, but {', '.join(known)}")
    illegal = [(module, name, assignments(name, told)) for module in chosen for name, line in cases[module].items()
               if name not in OTHERS for told in line.split(";")]
    legal = [(module, None, assignments(None, told)) for module in chosen for told in cases[module]["legal"].split(";")]
    tried = [(*case, tools) for case in legal + illegal]
    with tempfile.TemporaryDirectory() as work, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = [line for lines in pool.map(lambda case: judged(*case, work), tried) for line in lines]
    if wrong:
        sys.exit("parameters: " + "\nparameters: ".join(wrong))
    print(f"PASS {len(illegal)} builds that cannot be are refused, {len(legal)} at the ends of what is legal are not, by {', '.join(tools)}")


if __name__ == "__main__":
    main()
