"""The longest logic between the registers of a netlist, counted in cells."""

import collections

# How much longer a block RAM and a DSP slice take than a register until their output is valid, in LUTs.
STARTS_AS_LUTS = {"block_ram": 2, "dsp": 1}


class Depth:
    """Arithmetic steps are entries into a carry chain, pre-adders, multipliers and post-adders. The LUTs of the same path are
    counted separately."""

    def __init__(self, graph):
        self.graph = graph
        # For every bit and number of arithmetic steps on the way to it: the most LUTs, the bit before, and the cell.
        self.before = collections.defaultdict(dict)
        for bit in graph.sorted():
            self.go_on_from(bit)
        reached = [(steps, luts) for bit in graph.ends for steps, (luts, _, _) in self.before[bit].items()]
        self.arithmetic = max((steps for steps, _ in reached), default=0)
        self.lut_levels = max((luts for _, luts in reached), default=0)

    def go_on_from(self, bit):
        start = self.graph.starts.get(bit)
        if start:
            self.before[bit].setdefault(0, (STARTS_AS_LUTS.get(start.kind, 0), None, start.cell))
        for steps, (luts, _, _) in list(self.before[bit].items()):
            for arc in self.graph.arcs[bit]:
                key = steps + (arc.kind in ("carry", "dsp"))
                value = luts + (arc.kind == "lut")
                if key not in self.before[arc.bit] or self.before[arc.bit][key][0] < value:
                    self.before[arc.bit][key] = (value, (bit, steps), arc.cell)

    def offences(self, arithmetic, lut_levels):
        """Paths that are too long, the worst of each length, from their last cell to their first."""
        worst = {}
        for bit, ends in self.graph.ends.items():
            for steps, (luts, _, _) in self.before[bit].items():
                if steps > arithmetic or luts > lut_levels:
                    worst[(steps, luts)] = (bit, ends[0].cell)
        for (steps, luts), (bit, end) in sorted(worst.items(), reverse=True)[:4]:
            path, place = [end], (bit, steps)
            while place:
                bit, (_, earlier, cell) = place[0], self.before[place[0]][place[1]]
                known = self.graph.names.known.get(bit)
                if cell and path[-1] != cell:
                    path.append(f"{cell} = {known[1]}" if known else cell)
                place = earlier
            yield f"a path with {steps} arithmetic steps and {luts} LUTs: " + " < ".join(path)
