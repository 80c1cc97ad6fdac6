#!/usr/bin/env python3
"""How fast the boards' tops may run on a Spartan-6 of speed grade -3: the worst paths by the names of their registers, and the MHz of
each clock. Fails below the mhz of budget.ini.
    estimate.py [PATHS]      PATHS: how many paths of each clock to print (5)
It is an estimate, not a vendor's figure: the delays below, in ns, are educated guesses, and no cell has a place. What counts is the
order of the paths, and how a change moves it. Pins, the clocks' own routing and asynchronous resets are left out. A path between a rising
and a falling edge has half a period, so it counts twice. Paths between two clocks are listed separately, since sensor.ucf bounds them in ns."""

import collections
import concurrent.futures
import math
import os
import re
import sys

import budget
import netlist
import tops

# From the clock to the output of a register, a block RAM or a DSP slice. Distributed RAM is a register followed by a LUT.
CLOCK_TO_OUT = {"register": 0.45, "memory": 0.45 + 0.22, "block_ram": 2.1, "dsp": 1.2}
# Through a cell; a ripple is four bits of a carry chain. MUXF7 and MUXF8 count as LUTs.
THROUGH = {"lut": 0.22, "wide": 0.22, "carry": 0.40, "ripple": 0.09, "dsp": 3.0, None: 0.0}
SET_UP = 0.35
ASYNCHRONOUS = {"CLR", "PRE"}

# The slowest way from an edge of `clock` to the pin `end`: its delay in ns, and the last bit before the pin.
Path = collections.namedtuple("Path", "delay bit clock end")


def wire(readers):
    """The delay of a net that leads to this many pins."""
    return 0.55 + 0.22 * math.log2(max(readers, 1))


def without_index(name):
    return re.sub(r"\[\d+\]", "", name)


class Estimate:
    def __init__(self, module):
        self.graph = netlist.Graph(module)
        self.arrival = self.arrivals()

    def arrivals(self):
        """For every bit and clock: the latest time after the clock's edge, and the bit before."""
        latest = collections.defaultdict(dict)
        for bit in self.graph.sorted():
            start = self.graph.starts.get(bit)
            if start and start.clock and latest[bit].get(start.clock, (0,))[0] < CLOCK_TO_OUT[start.kind]:
                latest[bit][start.clock] = (CLOCK_TO_OUT[start.kind], None)
            for clock, (time, _) in latest[bit].items():
                for arc in self.graph.arcs[bit]:
                    then = time + THROUGH[arc.kind] + (self.wire(bit) if arc.routed else 0)
                    if latest[arc.bit].get(clock, (0,))[0] < then:
                        latest[arc.bit][clock] = (then, bit)
        return latest

    def wire(self, bit):
        return wire(self.graph.readers[bit]) if bit >= 0 else 0

    def paths(self):
        """The slowest path to each pin from each clock, the slowest first."""
        found = []
        for bit, ends in self.graph.ends.items():
            for clock, (time, _) in self.arrival[bit].items():
                for end in ends:
                    if end.clock and end.pin not in ASYNCHRONOUS:
                        half = end.clock.name == clock.name and end.clock.falling != clock.falling
                        found.append(Path((time + self.wire(bit) + SET_UP) * (2 if half else 1), bit, clock, end))
        return sorted(found, key=lambda path: (-path.delay, self.start_name(path), self.graph.end_name(path.end)))

    def bits(self, path):
        """The bits along a path, starting at the register."""
        bits, bit = [], path.bit
        while bit is not None:
            bits.append(bit)
            bit = self.arrival[bit][path.clock][1]
        return bits[::-1]

    def start_name(self, path):
        first = self.bits(path)[0]
        start = self.graph.starts[first]
        return start.cell if start.kind in ("block_ram", "dsp") else self.graph.names.of(first)

    def described(self, path):
        """A path from register to register by the named nets along it, each with the number of pins that it leads to."""
        bits = [bit for bit in self.bits(path) if bit >= 0]
        named = [f"{self.graph.names.of(bit)} x{self.graph.readers[bit]}" for bit in bits[1:] if bit in self.graph.names.known]
        first = f"{self.start_name(path)} x{self.graph.readers[bits[0]]}"
        return f"{path.delay:5.2f} ns  " + " -> ".join([first, *named, self.graph.end_name(path.end)])

    def worst(self, paths, count):
        """The slowest path for each pair of a register and a module that it leads to."""
        told = {}
        for path in paths:
            module = self.graph.end_name(path.end).split(" ")[0].rpartition(".")[0]
            told.setdefault((without_index(self.start_name(path)), module), path)
            if len(told) == count:
                break
        return [self.described(path) for path in told.values()]


def judge(name, module, limits, count):
    """The lines to print about a netlist, and those of its paths that are too slow."""
    estimate = Estimate(module)
    by_clocks = collections.defaultdict(list)
    for path in estimate.paths():
        by_clocks[path.clock.name, path.end.clock.name].append(path)
    said, slow = [f"\n{name}"], []
    for (begins, ends), paths in sorted(by_clocks.items()):
        delay = paths[0].delay
        if begins == ends:
            line = f"{begins}: {1000 / delay:.0f} MHz"
            missed = 1000 / delay < float(limits["mhz"]) and f"less than {limits['mhz']} MHz"
        else:
            line = f"from {begins} to {ends}: {delay:.1f} ns"
            missed = delay > float(limits["crossing_ns"]) and f"more than {limits['crossing_ns']} ns"
        said += [f"  {line}", *(f"    {text}" for text in estimate.worst(paths, count))]
        slow += [f"{name}: {line}, {missed}"] if missed else []
    return said, slow


def judge_top(top, limits, count):
    return judge(tops.name_of(top), tops.netlist(top, "cells"), limits, count)


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    builds = budget.tops()
    with concurrent.futures.ProcessPoolExecutor(os.cpu_count()) as pool:
        judged = [pool.submit(judge_top, top, limits, count) for top, limits in builds]
        said, slow = zip(*(one.result() for one in judged))
    print("An estimate, no vendor's figure: Spartan-6, speed grade -3.")
    print("\n".join(line for lines in said for line in lines))
    if any(slow):
        sys.exit("\ntoo slow by fpga/checks/budget.ini:\n  " + "\n  ".join(line for lines in slow for line in lines))


if __name__ == "__main__":
    main()
