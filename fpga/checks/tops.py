#!/usr/bin/env python3
"""The boards' tops as yosys reads them: once for every check that looks at them. What it made is kept
where everything is built, in hardware/tops, for as long as the sources are the same.
    tops.py words|cells BOARD fifo|uart [sensor]     prints the file of the netlist
    tops.py header BUILD SERIAL [sensor]             prints halfrow_build.vh; BUILD: eight hexadecimal digits
words: flat, in front of mapping, read without a warning. cells: flat, of the vendor's cells. Those of the miniSpartan6+ have their
pads, as `build --yosys` takes them; those of the ULX3S are made of the words, without the names that place and route would want."""

import collections
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import rtl

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TARGET = ROOT / os.environ.get("CARGO_TARGET_DIR", "target")
KEPT = TARGET / "hardware/tops"
# The vendor's cells, by board.
CELLS = {"minispartan6plus": "-specify +/xilinx/cells_sim.v +/xilinx/cells_xtra.v", "ulx3s": "+/ecp5/cells_bb.v"}
WORDS = "hierarchy -check {libraries} -top {top}; proc; check -assert; flatten; opt_expr; opt_dff; opt_clean; memory_collect"
CELLS_OF = {
    # No shift registers: yosys 0.23 forgets the clock enable of those that it extracts from registers.
    "minispartan6plus": "synth_xilinx -family xc6s -ise -flatten -nosrl -top {top}",
    # Names and the final checks would take a third of the time.
    "ulx3s": "opt_clean -purge; setattr -unset src */w:* */c:* */m:*; synth_ecp5 -top {top} -run begin:check; delete =A:blackbox =A:whitebox",
}
STAGES = ("words", "cells")
# Messages of yosys about a top that are not faults of it.
EXPECTED = ["tri-state", "floating point", "Replacing memory"]

Top = collections.namedtuple("Top", "board kind sensor")


def all_of(board="minispartan6plus"):
    return [Top(board, kind, sensor) for kind in ("fifo", "uart") for sensor in (False, True)]


def module_of(top):
    return f"{top.board}_{top.kind}"


def name_of(top):
    return module_of(top) + (" with sensor" if top.sensor else "")


def sources(top, tree=ROOT):
    """The files to read: all that a vendor's project lists, or the top alone if yosys finds the rest in `libraries`."""
    board = tree / "fpga/boards" / top.board
    listed = board / f"{top.kind}.prj"
    if not listed.exists():
        return [board / f"{module_of(top)}.v"]
    return [tree / path for path in re.findall(r"^verilog work (.*)$", listed.read_text(), re.MULTILINE)]


def libraries(top, tree=ROOT):
    """For yosys' `hierarchy`: the folders with the modules that were not read."""
    if len(sources(top, tree)) > 1:
        return ""
    of_board = f"-libdir fpga/boards/{top.board} -libdir fpga/boards/common"
    return f"{rtl.libraries(tree / 'fpga/rtl').replace(f'{tree}/', '')} {of_board}"


def build_header(build, sensor, serial=1):
    """halfrow_build.vh, as a build script writes it."""
    lines = [f"`define HALFROW_BUILD 32'h{build}", f"`define HALFROW_SERIAL 64'd{serial}"] + ["`define HALFROW_SENSOR"] * bool(sensor)
    return "\n".join(lines) + "\n"


def netlist(top, stage, tree=ROOT):
    """The top's flat module, in yosys' JSON."""
    return json.loads(made(top, stage, tree).read_text())["modules"][module_of(top)]


def made(top, stage, tree=ROOT):
    """The file of that netlist. A tree other than the project's own keeps its file inside it."""
    kept = KEPT if tree == ROOT else tree / "netlists"
    stem = kept / (name_of(top).replace(" ", "_") + f"-{stage}")
    file, mark = stem.with_suffix(".json"), stem.with_suffix(".key")
    key = key_of(top, stage, tree)
    if not (file.exists() and mark.exists() and mark.read_text() == key):
        kept.mkdir(parents=True, exist_ok=True)
        mark.unlink(missing_ok=True)
        run(top, stage, tree, file)
        mark.write_text(key)
    return file


def key_of(top, stage, tree):
    """A hash of everything that the netlist depends on."""
    digest = hashlib.sha256()
    folders = [tree / "fpga/rtl", tree / "fpga/boards" / top.board, tree / "fpga/boards/common"]
    found = {path for folder in folders for kind in ("*.v", "*.vh", "*.prj") for path in folder.rglob(kind)}
    digest.update(pathlib.Path(__file__).read_bytes())
    for path in sorted(found):
        digest.update(str(path.relative_to(tree)).encode() + b"\0" + path.read_bytes())
    version = subprocess.run(["yosys", "-V"], check=True, capture_output=True).stdout
    # The commands, since other files have a part in them.
    digest.update(version + repr((top, stage, script(top, stage, "header", tree))).encode())
    return digest.hexdigest()


def script(top, stage, header, tree=ROOT):
    """yosys commands, for the folder `tree`, that make the netlist of a top; `header` is the folder of halfrow_build.vh. Names
    in a netlist contain the sources' paths, so these must not depend on where the project is."""
    found = " ".join(f"-I{folder}" for folder in (header, "fpga/rtl", "fpga/boards/common"))
    reading = "; ".join(f"read_verilog {path.relative_to(tree)}" for path in sources(top, tree))
    if stage == "cells" and top.board == "ulx3s":
        return f"read_rtlil {made(top, 'words', tree).with_suffix('.il')}; {CELLS_OF[top.board].format(top=module_of(top))}"
    commands = (WORDS if stage == "words" else CELLS_OF[top.board]).format(top=module_of(top), libraries=libraries(top, tree))
    return f"read_verilog -lib {CELLS[top.board]}; verilog_defaults -add {found}; {reading}; {commands}"


def run(top, stage, tree, file, build="12345678"):
    """Makes the netlist anew with yosys."""
    with tempfile.TemporaryDirectory(dir=file.parent) as work:
        (pathlib.Path(work) / "halfrow_build.vh").write_text(build_header(build, top.sensor))
        aside = pathlib.Path(work) / file.name
        # Mapping warns about each block RAM whose ports are narrower than the vendor's.
        strict = ["-e", "."] if stage == "words" else []
        expected = [word for text in EXPECTED for word in ("-w", text)]
        commands = f"{script(top, stage, work, tree)}; write_json {aside}"
        if stage == "words":
            commands += f"; delete =A:blackbox; write_rtlil {file.with_suffix('.il')}"
        done = subprocess.run(["yosys", "-q", *expected, *strict, "-p", commands], capture_output=True, text=True, cwd=tree)
        if done.returncode:
            sys.exit(f"tops: yosys does not make {stage} of {name_of(top)}:\n{done.stdout[-1500:]}{done.stderr[-1500:]}")
        aside.replace(file)


def main():
    if sys.argv[1:2] == ["header"] and len(sys.argv) in (4, 5) and sys.argv[4:] in ([], ["sensor"]):
        return print(build_header(sys.argv[2], sys.argv[4:], sys.argv[3]), end="")
    try:
        stage, board, kind, *sensor = sys.argv[1:]
        known = stage in STAGES and board in CELLS and kind in ("fifo", "uart") and sensor in ([], ["sensor"])
    except ValueError:
        known = False
    if not known:
        sys.exit(__doc__)
    print(made(Top(board, kind, bool(sensor)), stage))


if __name__ == "__main__":
    main()
