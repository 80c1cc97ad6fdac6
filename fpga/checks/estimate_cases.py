#!/usr/bin/env python3
"""Tests of estimate.py and depth.py on netlists of a few cells, against sums by hand; of resources.py on counts at their limits; and of
budget.py on limits that it must refuse."""

import sys

import budget
import depth
import estimate
import netlist
import resources

CLOCK, OTHER = 2, 3


def cell(kind, parameters=None, outputs=("O", "Q", "CO", "DOA", "DOB", "P", "PCOUT"), **pins):
    return {"type": kind, "parameters": parameters or {}, "connections": {pin: list(bits) for pin, bits in pins.items()},
            "port_directions": {pin: "output" if pin in outputs else "input" for pin in pins}}


def register(d, q, c=CLOCK, kind="FDRE", ce="1"):
    return cell(kind, C=[c], CE=[ce], D=[d], Q=[q], R=["0"])


def module(**cells):
    bits = {bit for one in cells.values() for bits in one["connections"].values() for bit in bits if isinstance(bit, int)}
    names = {f"n{bit}": {"bits": [bit], "attributes": {}} for bit in bits if bit not in (CLOCK, OTHER)}
    names |= {"clk": {"bits": [CLOCK], "attributes": {}}, "other": {"bits": [OTHER], "attributes": {}}}
    return {"cells": cells, "ports": {}, "netnames": names}


def dsp(a, b, p, **registers):
    used = {name: "0" for name in ("A0REG", "A1REG", "B0REG", "B1REG", "CREG", "DREG", "MREG", "PREG")}
    return cell("DSP48A1", used | registers, CLK=[CLOCK], A=[a], B=[b], C=["0"], D=["0"], P=[p],
                OPMODE=["1", "0", "0", "0", "0", "0", "0", "0"])


# 10 leads to one LUT: 0.45 + 0.55 + 0.22 + 0.55 + 0.35.
ONE_LUT = module(a=register(13, 10), l=cell("LUT1", I0=[10], O=[11]), b=register(11, 12))
# 10 leads to four pins, so each wire from it takes 0.22 * 2 more. Entering a chain takes 0.40, going on along it 0.09, from
# there to D 0.55.
CHAIN = module(
    a=register(30, 10), l=cell("LUT2", I0=[10], I1=[10], O=[11]), low=cell("CARRY4", CI=["0"], S=[11, 10, 10, "0"], DI=["0"] * 4,
                                                                         O=[12, 13, 14, 15], CO=[16, 17, 18, 19]),
    high=cell("CARRY4", CI=[19], S=["0"] * 4, DI=["0"] * 4, O=[20, 21, 22, 23], CO=[24, 25, 26, 27]), b=register(23, 28))
# A block RAM's output into a multiplier with a registered product: 2.1 + 0.55 + 3.0 + 0.35.
BLOCK_RAM = module(m=cell("RAMB16BWER", CLKA=[CLOCK], CLKB=["0"], ADDRA=[10], DOA=[11], DOB=[12]),
                   d=dsp(11, "0", 13, MREG="1"))
# 0.45 + 0.55 + 0.35 in half a period.
HALF = module(a=register(12, 10, kind="FDRE_1"), b=register(10, 11))
# The same from one clock to another.
CROSSING = module(a=register(12, 10), b=register(10, 11, c=OTHER))
# Only an asynchronous reset.
ASYNCHRONOUS = module(a=register(12, 10), b=cell("FDPE", C=[CLOCK], CE=["1"], D=["0"], PRE=[10], Q=[11]))

DELAYS = [("one LUT", ONE_LUT, 2.12), ("a chain", CHAIN, 0.45 + 0.99 + 0.22 + 0.55 + 0.40 + 0.09 + 0.55 + 0.35),
          ("a block RAM", BLOCK_RAM, 6.0), ("half a period", HALF, 2.7), ("a crossing", CROSSING, 1.35), ("a reset", ASYNCHRONOUS, None)]
DEPTHS = [("one LUT", ONE_LUT, 0, 1), ("a chain", CHAIN, 1, 1), ("a block RAM", BLOCK_RAM, 1, 2)]
# Netlists with limits, and whether they must be refused: by the rate of one clock, and by a crossing.
LIMITS = [(ONE_LUT, {"mhz": "472", "crossing_ns": "9"}, True), (ONE_LUT, {"mhz": "471", "crossing_ns": "9"}, False),
          (CROSSING, {"mhz": "900", "crossing_ns": "1.3"}, True), (CROSSING, {"mhz": "900", "crossing_ns": "1.4"}, False)]

# A build's limit, its counts and shares, and whether the limit is exceeded.
EXCESSES = [({"luts": "100"}, {"luts": 101}, {}, True), ({"luts": "100"}, {"luts": 100}, {}, False),
            ({"registers": "20%"}, {"registers": 1}, {"registers": 20.1}, True), ({"registers": "20%"}, {"registers": 99}, {"registers": 20.0}, False),
            ({"mean": "9%"}, {"mean": 9.0}, {}, True), ({"mean": "9%"}, {"mean": 8.9}, {}, False),
            ({"lut_levels": "4"}, {"lut_levels": 5}, {}, True), ({"carry_bits": "40"}, {"carry_bits": 41}, {}, True)]

# A line of a build, and what must be said about it, if anything.
BUDGETS = [("luts = 510", None), ("registers = 12.5%", None), ("mean = 9%", None), ("crossing_ns = 10", None), ("lut = 510", "lut is none of"),
           ("mean = 9", "mean is '9', not a share"), ("luts = 510 LUTs", "luts is '510 LUTs', not a number, or a share"), ("dsps =", "dsps is ''"),
           ("mhz = 115%", "mhz is '115%', not a number"), ("whole_rams = 40%", "whole_rams is '40%'"), ("luts = -1", "luts is '-1'")]


def faults():
    for name, cells, wanted in DELAYS:
        paths = estimate.Estimate(cells).paths()
        delay = paths[0].delay if paths else None
        if (delay is None) != (wanted is None) or wanted and abs(delay - wanted) > 1e-9:
            yield f"{name} takes {delay} ns, by hand {wanted}"
    for name, cells, steps, luts in DEPTHS:
        found = depth.Depth(netlist.Graph(cells))
        if (found.arithmetic, found.lut_levels) != (steps, luts):
            yield f"{name} has {found.arithmetic} steps and {found.lut_levels} LUTs, by hand {steps} and {luts}"
    for cells, limits, refused in LIMITS:
        if bool(estimate.judge("", cells, limits, 1)[1]) != refused:
            yield f"with {limits} a netlist is {'not ' if refused else ''}refused"
    for limits, counts, shares, exceeded in EXCESSES:
        if bool(list(resources.excesses(limits, counts, shares))) != exceeded:
            yield f"{counts} {shares} are {'not ' if exceeded else ''}over {limits}"
    for line, wanted in BUDGETS:
        said = list(budget.faults(budget.read(f"[core]\ntop = halfrow_core\n{line}\n")))
        if (wanted is None) != (not said) or wanted and wanted not in said[0]:
            yield f"of the limit `{line}` is said: {said}"


def main():
    wrong = list(faults())
    if wrong:
        sys.exit("estimate_cases: " + "\nestimate_cases: ".join(wrong))
    print(f"PASS {len(DELAYS) + len(DEPTHS)} netlists as by hand, and each of {len(LIMITS) + len(EXCESSES) + len(BUDGETS)} limits is kept")


if __name__ == "__main__":
    main()
