"""A flat netlist of Spartan-6 cells, as yosys writes it in JSON: what it takes, and what stands between its registers."""

import collections
import re

LUT = re.compile(r"LUT([1-6])$")
# LUTs that a distributed RAM or shift register takes.
MEMORY_LUTS = {"SRL16E": 1, "SRLC16E": 1, "SRLC32E": 1, "RAM32X1S": 1, "RAM64X1S": 1, "RAM16X1D": 2, "RAM32X1D": 2, "RAM64X1D": 2,
               "RAM128X1D": 4, "RAM32M": 4, "RAM64M": 4}
REGISTER = re.compile(r"FD[RSCP]E?(_1)?$")
# No logic: an inverter goes into the next LUT, a multiplexer MUXF7 or MUXF8 stands beside the LUTs that it joins.
FREE = {"INV", "MUXF7", "MUXF8", "BUFG", "IBUF", "OBUF"}


def resources(module):
    kinds = collections.Counter(cell["type"] for cell in module["cells"].values())
    memory = sum(MEMORY_LUTS.get(kind, 0) * count for kind, count in kinds.items())
    large, small = kinds["RAMB16BWER"], kinds["RAMB8BWER"]
    return {
        "luts": memory + sum(count for kind, count in kinds.items() if LUT.match(kind)),
        "registers": sum(count for kind, count in kinds.items() if REGISTER.match(kind)),
        "block_rams": large + small / 2,
        "whole_rams": large + small,
        "dsps": kinds["DSP48A1"],
    }


def number(text):
    """A parameter as yosys writes it: binary digits."""
    return int(text, 2) if isinstance(text, str) else text


class Depth:
    """The longest logic between registers. Every combinational arc has a kind: 'lut', 'carry' (entering a chain),
    'dsp' (a pre-adder, a multiplier or a post-adder) or None (no logic)."""

    def __init__(self, module):
        self.arcs = collections.defaultdict(list)     # from a net's bit: (to a bit, kind, cell)
        self.starts = set()
        self.ends = collections.defaultdict(list)
        self.carry_in = {}                            # a chain's next CARRY4, by its carry's bit
        self.inner = 0
        for name, cell in module["cells"].items():
            self.add(name, cell)
        for port in module["ports"].values():
            if port["direction"] == "input":
                self.starts.update(port["bits"])
            else:
                for bit in port["bits"]:
                    self.ends[bit].append("an output port")
        self.carry_bits = self.longest_chain(module)
        self.walk()

    def add(self, name, cell):
        kind, pins, directions = cell["type"], cell["connections"], cell["port_directions"]
        into = {pin: [b for b in bits if isinstance(b, int)] for pin, bits in pins.items() if directions[pin] == "input"}
        out = {pin: [b for b in bits if isinstance(b, int)] for pin, bits in pins.items() if directions[pin] == "output"}
        sources = [bit for bits in into.values() for bit in bits]
        results = [bit for bits in out.values() for bit in bits]
        if LUT.match(kind) or kind in FREE:
            self.join(sources, results, "lut" if LUT.match(kind) else None, name)
        elif kind == "CARRY4":
            self.join(into["CI"], results, None, name)
            self.join([b for pin in ("S", "DI", "CYINIT") for b in into.get(pin, [])], results, "carry", name)
        elif kind in MEMORY_LUTS:
            self.finish(sources, name)
            self.starts.update(results)
            addresses = [b for pin, bits in into.items() if re.match(r"A\d|DPRA\d|A$|ADDR", pin) for b in bits]
            self.join(addresses, results, "lut", name)
        elif REGISTER.match(kind) or kind.startswith("RAMB"):
            self.finish(sources, name)
            self.starts.update(results)
        elif kind == "DSP48A1":
            self.add_dsp(name, cell["parameters"], pins, into, out)
        else:
            raise SystemExit(f"netlist: unknown cell {kind}")

    def add_dsp(self, name, parameters, pins, into, out):
        """A DSP slice as its stages with the registers that it uses; its nets inside get numbers below 0."""
        registers = {key: number(value) for key, value in parameters.items() if key.endswith("REG")}
        mode = pins["OPMODE"]
        if any(bit not in ("0", "1") for bit in mode):
            raise SystemExit(f"netlist: {name} has an OPMODE that changes")
        adds_before, multiplies, adds_after = mode[4] == "1", mode[:2] == ["1", "0"], mode[2:4] != ["0", "0"]
        for pin, bits in into.items():
            if pin not in ("A", "B", "C", "D", "PCIN"):
                self.finish(bits, name)

        def stage(bits, kind, registered):
            self.inner -= 1
            self.join(bits, [self.inner], kind, name)
            if registered:
                self.finish([self.inner], name)
                self.inner -= 1
                self.starts.add(self.inner)
            return [self.inner]

        first = stage(into["B"], None, registers["B0REG"])
        if adds_before:
            first = first + stage(into["D"], None, registers["DREG"])
        factor = stage(first, "dsp" if adds_before else None, registers["B1REG"])
        other = stage(into["A"], None, registers["A0REG"] or registers["A1REG"])
        product = stage(factor + other, "dsp" if multiplies else None, registers["MREG"])
        addend = stage(into["C"], None, registers["CREG"]) + into.get("PCIN", [])
        inner = stage(product + (addend if adds_after else []), "dsp" if adds_after else None, registers["PREG"])
        self.join(inner, [bit for pin in ("P", "PCOUT") for bit in out.get(pin, [])], None, name)

    def join(self, sources, results, kind, cell):
        for source in sources:
            self.arcs[source] += [(result, kind, cell) for result in results]

    def finish(self, bits, cell):
        for bit in bits:
            self.ends[bit].append(cell)

    def longest_chain(self, module):
        carries = [cell["connections"] for cell in module["cells"].values() if cell["type"] == "CARRY4"]
        follower = {pins["CI"][0]: pins for pins in carries if isinstance(pins["CI"][0], int)}
        longest = 0
        for pins in carries:
            length = 0
            while pins:
                length += 4
                pins = follower.get(pins["CO"][3])
            longest = max(longest, length)
        return longest

    def walk(self):
        """For every bit and number of arithmetic steps on the way to it: the most LUTs, and the bit before."""
        order = self.sorted()
        self.before = collections.defaultdict(dict)
        for bit in order:
            if bit in self.starts:
                self.before[bit].setdefault(0, (0, None, None))
            for steps, (luts, _, _) in list(self.before[bit].items()):
                for result, kind, cell in self.arcs[bit]:
                    key = steps + (kind in ("carry", "dsp"))
                    value = luts + (kind == "lut")
                    if key not in self.before[result] or self.before[result][key][0] < value:
                        self.before[result][key] = (value, (bit, steps), cell)
        reached = [(steps, luts) for bit in self.ends for steps, (luts, _, _) in self.before[bit].items()]
        self.arithmetic = max((steps for steps, _ in reached), default=0)
        self.lut_levels = max((luts for _, luts in reached), default=0)

    def sorted(self):
        """All bits, each behind those that it depends on. A loop without a register is refused."""
        waiting = collections.Counter(result for arcs in self.arcs.values() for result, _, _ in arcs)
        ready = [bit for bit in set(self.arcs) | self.starts | set(self.ends) if not waiting[bit]]
        order = []
        while ready:
            bit = ready.pop()
            order.append(bit)
            for result, _, _ in self.arcs.get(bit, ()):
                waiting[result] -= 1
                if not waiting[result]:
                    ready.append(result)
        if any(waiting.values()):
            raise SystemExit("netlist: logic runs in a loop without a register")
        return order

    def offences(self, arithmetic, lut_levels):
        """Paths that are too long, the worst to each kind of end, from their last cell to their first."""
        worst = {}
        for bit, cells in self.ends.items():
            for steps, (luts, _, _) in self.before[bit].items():
                if steps > arithmetic or luts > lut_levels:
                    worst[(steps, luts)] = (bit, cells[0])
        for (steps, luts), (bit, end) in sorted(worst.items(), reverse=True)[:4]:
            path, place = [end], (bit, steps)
            while place:
                _, earlier, cell = self.before[place[0]][place[1]]
                if cell and path[-1] != cell:
                    path.append(cell)
                place = earlier
            yield f"a path with {steps} arithmetic steps and {luts} LUTs: " + " < ".join(path)
