#!/usr/bin/env python3
"""Says which single faults of the Verilog a run of `halfrow verify` finds, and by what.
    fpga/checks/coverage.py WORK RUNNER COUNT [BLOCK...]
coverage.ini says where faults are put. yosys draws them into the netlist of the whole board, a library a block, in which a number
chooses one; RUNNER (halfrow-coverage) judges the board with each. What was found is kept in WORK, and a run that was stopped goes on.
"""
import collections
import configparser
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import threading
import zlib

import rtl

HERE = pathlib.Path(__file__).resolve().parent
SHIM = HERE.parent / "sim" / "shim"
SEED = 1
TOP = "halfrow_bridge"
# Width, height and the lens's radius in pixels.
SIZES = ["64", "16", "40"]
AT_ONCE = 2
BOARD = "uniquify; prep -top {top}; wreduce; opt -full; opt_clean -purge; write_ilang {base}"
# Contents of memories are no fault of the design, and yosys 0.23 cannot put a fault into a memory's port. Nor is a clock that is turned.
DRAW = "read_ilang {base}; select {modules} t:$mem* %d; mutate -list {count} -seed {seed} -ctrl fault 16 1 -o {faults}"
WITH_FAULTS = "read_ilang {base}\n{faults}\nhierarchy -top {top}\nsplitnets\nwrite_verilog -noattr {made}\n"


def run(command, log):
    with open(log, "w") as out:
        if subprocess.run([str(word) for word in command], stdout=out, stderr=subprocess.STDOUT).returncode != 0:
            sys.exit(f"coverage: {command[0]} failed, see {log}")


def sources():
    """The CRC-32 of the board's sources."""
    told = 0
    for path in sorted(rtl.RTL.glob("**/*.v*"), key=lambda path: path.name):
        told = zlib.crc32(path.read_bytes(), told)
    return told


def key(count, runner):
    """A hash of all that decides what a fault is and who finds it."""
    told = hashlib.sha256(f"{count} {SEED} {SIZES} {sources()}".encode())
    for path in [HERE / "coverage.py", HERE / "coverage.ini", *sorted(SHIM.iterdir()), pathlib.Path(runner)]:
        told.update(path.read_bytes())
    return told.hexdigest()


def board(work):
    """The board's netlist, each instance a module of its own, and the names of those."""
    base = work / "board.il"
    if not base.exists():
        commands = rtl.read(TOP, ["NATURE=2"]) + BOARD.format(top=TOP, base=base.with_suffix(".new"))
        run(["yosys", "-q", "-p", commands], work / "board.log")
        base.with_suffix(".new").rename(base)
    return base, re.findall(r"^module \\(\S+)", base.read_text(), re.MULTILINE)


def chosen(section, modules):
    """The modules of a block."""
    found = []
    for word in section["instances"].split():
        name = f"{TOP}.{word.removesuffix('*')}"
        below = [module for module in modules if module == name or (word.endswith("*") and module.startswith(name + "."))]
        if not below:
            sys.exit(f"coverage: there is no {name} in the board; mend fpga/checks/coverage.ini")
        found += below
    return found


def draw(place, base, modules, count):
    """The commands of yosys that put a block's faults in, one a fault."""
    words = DRAW.format(base=base, modules=" ".join(modules), count=count + count // 4 + 10, seed=SEED, faults=place / "faults.txt")
    run(["yosys", "-q", "-p", words], place / "draw.log")
    drawn = [fault for fault in (place / "faults.txt").read_text().splitlines() if "-port CLK " not in fault][:count]
    return [re.sub(r"fault 16 \d+", f"fault 16 {number}", fault) for number, fault in enumerate(drawn, 1)]


def library(place, base, faults):
    """The board with a block's faults, as a library."""
    made, library = place / "board.v", place / "board.so"
    if library.exists():
        return library
    (place / "faults.ys").write_text(WITH_FAULTS.format(base=base, faults="\n".join(faults), top=TOP, made=made))
    run(["yosys", "-q", "-s", place / "faults.ys"], place / "yosys.log")
    folder = place / "translated"
    shutil.rmtree(folder, ignore_errors=True)
    run(["verilator", "--cc", "-O3", "--x-assign", "fast", "--x-initial", "unique", "-Wno-fatal", "-Wno-lint", "-Wno-UNOPTFLAT",
         "--top-module", TOP, "--prefix", "Faulty", "--Mdir", folder, made], place / "verilator.log")
    root = subprocess.run(["verilator", "--getenv", "VERILATOR_ROOT"], capture_output=True, text=True, check=True).stdout.strip()
    include = pathlib.Path(root) / "include"
    sources = [SHIM / "faulty.h", *sorted(folder.glob("*.cpp"))]
    unit = place / "board.cpp"
    unit.write_text("".join(f'#include "{source.resolve()}"\n' for source in sources) + "DESIGN(faulty, Faulty)\n")
    run(["g++", "-std=c++17", "-O2", "-w", "-shared", "-fPIC", "-fno-semantic-interposition", "-DVL_TIME_CONTEXT", "-DVM_TRACE=0",
         "-DVM_COVERAGE=0", "-DVM_SC=0", f"-I{include}", f"-I{include / 'vltstd'}", f"-I{SHIM}", f"-I{folder}", unit, include / "verilated.cpp",
         include / "verilated_threads.cpp", "-lpthread", "-o", library.with_suffix(".new")], place / "compiler.log")
    library.with_suffix(".new").rename(library)
    return library


def judge(runner, library, numbers, results):
    """Judges faults one after the other, each by a call of RUNNER's, and keeps what it says."""
    lock = threading.Lock()
    left = list(reversed(numbers))

    def some():
        while True:
            with lock:
                if not left:
                    return
                number = str(left.pop())
            said = subprocess.run([runner, library, *SIZES, number, number], capture_output=True, text=True)
            if said.returncode != 0:
                sys.exit(f"coverage: fault {number} of {library}: {said.stderr.strip()}")
            with lock, open(results, "a") as out:
                out.write(said.stdout)

    threads = [threading.Thread(target=some) for _ in range(AT_ONCE)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def judged(runner, place, base, faults):
    """What is known of each fault of a block, by number; 0 is none."""
    results = place / "results"
    def known():
        lines = results.read_text().splitlines() if results.exists() else []
        return {found["fault"]: found for found in map(json.loads, lines)}
    missing = [number for number in range(len(faults) + 1) if number not in known()]
    if missing:
        made = library(place, base, faults)
        if 0 in missing:
            judge(runner, made, [0], results)
            missing.remove(0)
        if known()[0]["verdict"] != "PASS":
            sys.exit(f"coverage: the board without a fault does not pass, see {results}")
        judge(runner, made, missing, results)
    return known()


def finder(found):
    """What a run ended by: PASS, or its verdict and the first check that did not pass."""
    return " ".join([found["verdict"], *found["checks"][:1]])


def main():
    work, runner, count, only = pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), sys.argv[4:]
    sections = configparser.ConfigParser()
    sections.read(HERE / "coverage.ini")
    work.mkdir(parents=True, exist_ok=True)
    mark = work / "key"
    if not mark.exists() or mark.read_text() != key(count, runner):
        shutil.rmtree(work)
        work.mkdir()
        mark.write_text(key(count, runner))
    base, modules = board(work)
    for name in only or sections.sections():
        place = work / name.replace(" ", "_")
        place.mkdir(exist_ok=True)
        faults = draw(place, base, chosen(sections[name], modules), count * sections.getint(name, "share") // 1000)
        found = judged(runner, place, base, faults)
        counts = collections.Counter(finder(found[number]) for number in range(1, len(faults) + 1))
        told = ", ".join(f"{check} {number}" for check, number in counts.most_common())
        print(f"{name}: {len(faults)} faults: {told}", flush=True)


main()
