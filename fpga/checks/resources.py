#!/usr/bin/env python3
"""Synthesises the builds of budget.ini with yosys for the Spartan-6 LX25. Prints the share of it that each takes, how much logic lies
between its registers, and the pins that the busiest clock enables and resets of a board's top lead to. Fails where budget.ini is
exceeded. `halfrow paper` reads WORK/report.json.
    resources.py WORK [tops]     WORK: a directory for logs and netlists; tops: the boards' tops as well, which takes two minutes"""

import concurrent.futures
import itertools
import json
import os
import pathlib
import subprocess
import sys

import budget
import depth
import netlist
import rtl
import tops

LX25 = {"luts": 15032, "registers": 30064, "block_rams": 52, "dsps": 38}


def synthesise(work, name, build):
    """The flat netlist of a build, in yosys' JSON."""
    if budget.top_of(build):
        return tops.netlist(budget.top_of(build), "cells")
    stem = work / "".join(c if c.isalnum() else "_" for c in name)
    top = build["top"]
    if top not in rtl.modules():
        sys.exit(f"resources: there is no module {top} in fpga/rtl")
    script = (f"{rtl.read(top, build['parameters'].split())}"
              f"synth_xilinx -family xc6s -flatten -noiopad -noclkbuf -nosrl; rename -top top; write_json {stem}.json")
    done = subprocess.run(["yosys", "-q", "-l", f"{stem}.log", "-p", script], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"resources: yosys failed on {name}, see {stem}.log\n{done.stderr[-2000:]}")
    return json.loads(pathlib.Path(f"{stem}.json").read_text())["modules"]["top"]


def measure(module):
    counts = netlist.resources(module)
    graph = netlist.Graph(module)
    logic = depth.Depth(graph)
    shares = {name: 100 * counts[name] / LX25[name] for name in LX25}
    counts["mean"] = sum(shares.values()) / len(shares)
    counts["arithmetic"] = logic.arithmetic
    counts["carry_bits"] = graph.carry_bits
    counts["lut_levels"] = logic.lut_levels
    return counts, shares, logic


def excesses(build, counts, shares):
    for name in (*LX25, "whole_rams", "mean", "arithmetic", "carry_bits", "lut_levels"):
        if name not in build:
            continue
        limit = build[name]
        value = shares.get(name, counts[name]) if limit.endswith("%") else counts[name]
        # The mean has to stay below its limit; everything else may reach it.
        if value > float(limit.rstrip("%")) or (name == "mean" and value >= float(limit.rstrip("%"))):
            yield f"{name} {value:g}, allowed {limit}"


def described(name, counts, shares):
    """A build in the form of report.json."""
    parts = {part: {"used": counts[part], "percent": shares[part]} for part in LX25}
    return {"name": name, **parts, "mean": counts["mean"]}


def fan_outs(name, graph):
    """The three busiest clock enables and the three busiest resets."""
    for what, pins in (("clock enables", netlist.ENABLE), ("resets", netlist.RESET)):
        busiest = ", ".join(f"{net} x{count}" for count, net in itertools.islice(graph.fan_outs(pins), 3))
        yield f"{name}: pins behind {what}: {busiest}"


def main():
    work = pathlib.Path(sys.argv[1])
    work.mkdir(parents=True, exist_ok=True)
    builds = budget.sections()
    with_tops = sys.argv[2:] == ["tops"]
    names = [name for name in builds if with_tops or not budget.top_of(builds[name])]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        modules = list(pool.map(lambda name: synthesise(work, name, builds[name]), names))
    print("XC6SLX25: 15,032 LUTs, 30,064 registers, 52 block RAMs, 38 DSP48A1. yosys gives no slices.\n")
    print(f"{'':28} {'LUTs':>13} {'registers':>13} {'block RAM':>13} {'no 9K':>6} {'DSP48A1':>11} {'mean':>6}"
          f" {'carry bits':>10} {'LUT levels':>10}")
    exceeded, described_builds, leading = [], [], []
    for name, module in zip(names, modules):
        counts, shares, logic = measure(module)
        cells = " ".join(f"{counts[key]:6g} {shares[key]:4.1f} %" for key in ("luts", "registers", "block_rams"))
        print(f"{name:28} {cells} {counts['whole_rams']:6} {counts['dsps']:4} {shares['dsps']:4.1f} %"
              f" {counts['mean']:4.1f} % {counts['carry_bits']:9} {counts['lut_levels']:10}")
        described_builds.append(described(name, counts, shares))
        exceeded += [f"{name}: {excess}" for excess in excesses(builds[name], counts, shares)]
        exceeded += [f"{name}: {path}" for path in logic.offences(int(builds[name]["arithmetic"]),
                                                                 int(builds[name]["lut_levels"]))]
        leading += fan_outs(name, logic.graph) if budget.top_of(builds[name]) else []
    if leading:
        print("\n" + "\n".join(leading))
    tool = subprocess.run(["yosys", "-V"], check=True, capture_output=True, text=True).stdout.split(" (")[0].strip()
    report = {"tool": tool, "device": "XC6SLX25", "builds": described_builds}
    (work / "report.json").write_text(json.dumps(report, indent=2) + "\n")
    if exceeded:
        sys.exit("\nover the budget:\n  " + "\n  ".join(exceeded))


if __name__ == "__main__":
    main()
