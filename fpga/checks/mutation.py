#!/usr/bin/env python3
"""Puts faults into the core (five taps, one bank) and counts how many core_bench sees.
    fpga/checks/mutation.py WORK COUNT
yosys draws COUNT faults and puts GROUP of them into a model, where a number chooses which is on. What survives is listed
with its place, whether or not it makes a difference.
"""
import concurrent.futures
import pathlib
import re
import subprocess
import sys

import rtl

HERE = pathlib.Path(__file__).resolve().parent
WORK, COUNT = pathlib.Path(sys.argv[1]), int(sys.argv[2])
GROUP = 50
FLOOR = 90                                   # per cent; some of what survives is no fault
CASES = ["golden", "random", "200", "1", "hostile", "100", "2"]
MORE_CASES = ["random", "3000", "3", "hostile", "1500", "4", "frame", "hermite"]   # for what survives those

# Contents of memories are no fault of the design, and yosys 0.23 cannot put a fault into a memory's port.
BASE = f"""{rtl.read("halfrow_core", ["TAPS=5", "TABLE_BANKS=1"])}
prep -flatten; simplemap t:$dff t:$dffe t:$sdff t:$sdffe t:$sdffce t:$mux t:$pmux t:$and t:$or t:$not t:$xor; opt -full; wreduce;
opt -full; rename -top top; opt_clean -purge; write_ilang {WORK}/base.il;
select c:* t:$mem* %d; mutate -list {COUNT} -seed 1 -ctrl mutsel 16 1 -o {WORK}/faults.txt"""


def run(command, log, seconds=None):
    with open(log, "w") as out:
        try:
            return subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, timeout=seconds).returncode
        except subprocess.TimeoutExpired:
            return None


def must(command, log):
    if run(command, log) != 0:
        sys.exit(f"mutation: {command[0]} failed, see {log}")


def build(first, faults):
    """A model of these faults, and the bench around it. The number is registered, or every evaluation would follow it."""
    place = WORK / f"group_{first}"
    place.mkdir(parents=True, exist_ok=True)
    (place / "script.ys").write_text(f"read_ilang {WORK}/base.il\n" + "\n".join(faults) + f"\nwrite_verilog -noattr {place}/top.v\n")
    must(["yosys", "-q", "-s", str(place / "script.ys")], place / "yosys.log")
    must(["verilator", "--cc", "--exe", "--build", "-O3", "--prefix", "Vcore", "--top-module", "top", "-Wno-fatal", "--Mdir", str(place),
          "-o", "bench", str(place / "top.v"), "-CFLAGS", "-O1 -std=c++17 -DTAPS=5 -DTABLE_BANKS=1 -DFAULTS", str(HERE / "core_bench.cpp")],
         place / "build.log")
    return place / "bench"


def survives(bench, number, cases):
    return run([str(bench), "fault", str(number), *cases], bench.parent / f"fault_{number}.log", 300) == 0


def group(first, faults):
    bench = build(first, faults)
    if not survives(bench, 0, CASES + MORE_CASES):
        sys.exit("mutation: the core without a fault fails")
    return [k for k in range(first, first + len(faults)) if survives(bench, k, CASES) and survives(bench, k, MORE_CASES)]


def main():
    WORK.mkdir(parents=True, exist_ok=True)
    must(["yosys", "-q", "-p", BASE.replace("\n", " ")], WORK / "base.log")
    faults = (WORK / "faults.txt").read_text().splitlines()
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        groups = [pool.submit(group, k + 1, faults[k:k + GROUP]) for k in range(0, len(faults), GROUP)]
        alive = [number for done in groups for number in done.result()]
    for number in alive:
        fault = faults[number - 1]
        wire = re.search(r"-wire (\S+) -wirebit (\d+)", fault)
        mode, cell, port = (re.search(rf"-{word} (\S+)", fault)[1] for word in ("mode", "cell", "port"))
        source = " ".join(re.findall(r"-src \S*?(halfrow_\w+\.v:\d+)", fault))
        print(f"  survives: {number} {mode} {wire[1] + '[' + wire[2] + ']' if wire else cell} {port} {source}")
    killed = len(faults) - len(alive)
    print(f"{killed} of {len(faults)} killed")
    if 100 * killed < FLOOR * len(faults):
        sys.exit(f"mutation: less than {FLOOR} per cent")


main()
