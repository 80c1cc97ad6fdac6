#!/usr/bin/env python3
"""Synthesises tops for an ECP5 with the yosys on the path, prints the share of an LFE5U-25F that they take, and fails beyond
budget.ini. This is what can be known about a bitstream without placing it."""
import collections
import concurrent.futures
import configparser
import sys

import flow

LFE5U_25F = {"luts": 24288, "registers": 24288, "block_rams": 56, "multipliers": 28}
# yosys' cells, and which resource each takes, how many times.
TAKES = {"LUT4": ("luts", 1), "CCU2C": ("luts", 2), "TRELLIS_DPR16X4": ("luts", 4), "TRELLIS_FF": ("registers", 1),
         "DP16KD": ("block_rams", 1), "MULT18X18D": ("multipliers", 1)}
# Multiplexers that belong to the LUTs that they join, and cells outside of the fabric, of which there are one or two.
FREE = {"PFUMX", "L6MUX21", "EHXPLLL", "$_TBUF_"}


def synthesised(kind):
    """The number of cells of each kind."""
    module = flow.tops.netlist(flow.tops.Top("ulx3s", kind, False), "cells")
    return collections.Counter(cell["type"] for cell in module["cells"].values())


def counted(cells):
    counts = dict.fromkeys(LFE5U_25F, 0)
    for kind, number in cells.items():
        if kind in TAKES:
            counts[TAKES[kind][0]] += TAKES[kind][1] * number
        elif kind not in FREE:
            sys.exit(f"resources: unknown cell {kind}")
    return counts


def main():
    budget = configparser.ConfigParser()
    budget.read(flow.BOARD / "budget.ini")
    kinds = budget.sections()
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        found = {kind: counted(cells) for kind, cells in zip(kinds, pool.map(synthesised, kinds))}
    exceeded = []
    for kind, counts in found.items():
        shares = ", ".join(f"{counts[part]:,} {part} ({100 * counts[part] / of:.1f} %)" for part, of in LFE5U_25F.items())
        print(f"PASS ulx3s_{kind} on an LFE5U-25F: {shares}".replace("_rams", " RAMs"))
        exceeded += [f"{kind}: {counts[part]} {part}, allowed {limit}" for part, limit in budget[kind].items()
                     if counts[part] > int(limit)]
    if exceeded:
        sys.exit("resources: over the budget:\n  " + "\n  ".join(exceeded))


if __name__ == "__main__":
    main()
