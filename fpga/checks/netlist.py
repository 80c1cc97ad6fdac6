"""A flat netlist of Spartan-6 cells, in yosys' JSON: the resources that it takes, and the paths of its logic from register to
register."""

import collections
import re

LUT = re.compile(r"LUT([1-6])$")
# LUTs of a distributed RAM or shift register.
MEMORY_LUTS = {"SRL16E": 1, "SRLC16E": 1, "SRLC32E": 1, "RAM32X1S": 1, "RAM64X1S": 1, "RAM16X1D": 2, "RAM32X1D": 2, "RAM64X1D": 2,
               "RAM128X1D": 4, "RAM32M": 4, "RAM64M": 4}
REGISTER = re.compile(r"FD[RSCP]E?(_1)?$")
# Where a path begins or ends at something other than a register of the fabric: pins, clocks and other cells of the vendor.
BOUNDARY = {"BUFG", "BUFGMUX", "IBUF", "IBUFG", "OBUF", "OBUFT", "IOBUF", "PLL_BASE", "ODDR2", "DNA_PORT"}
# Pins of registers, block RAMs and DSP slices.
ENABLE, RESET = re.compile("CE|EN|REGCE"), re.compile("R$|S$|CLR|PRE|RST")
MEMORY_ADDRESS = re.compile(r"A\d|DPRA\d|A$|ADDR")

# An edge of a clock. `falling` says whether its registers sample when it falls.
Clock = collections.namedtuple("Clock", "name falling")
# Where a path begins: 'register', 'memory' (distributed RAM), 'block_ram', 'dsp' or 'pin', which has no clock.
Start = collections.namedtuple("Start", "kind cell clock")
# A combinational path to a bit. Its kind: 'lut', 'carry' (into a chain), 'ripple' (along a chain), 'wide' (MUXF7, MUXF8), 'dsp'
# (a pre-adder, a multiplier or a post-adder) or None (no logic). `routed` says whether the chip's general routing leads to the
# cell.
Arc = collections.namedtuple("Arc", "bit kind cell routed")
End = collections.namedtuple("End", "cell pin clock")


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
    """A parameter in yosys' form: binary digits."""
    return int(text, 2) if isinstance(text, str) else text


def nets(bits):
    """The bits of a pin that are not constants."""
    return [bit for bit in bits if isinstance(bit, int)]


class Names:
    """The names in the source for the bits of a netlist."""

    def __init__(self, module):
        self.known = {}
        for name, net in module["netnames"].items():
            if net.get("hide_name"):
                continue
            for place, bit in enumerate(net["bits"]):
                index = net.get("offset", 0) + place
                full = name if len(net["bits"]) == 1 else f"{name}[{index}]"
                rank = (name in module["ports"], name.count("."), len(name), name)
                if bit not in self.known or rank < self.known[bit][0]:
                    self.known[bit] = (rank, full)

    def of(self, bit):
        return self.known[bit][1] if bit in self.known else f"bit {bit}"


class Graph:
    """The logic between registers. A bit is a number; bits inside a DSP slice are below 0."""

    def __init__(self, module):
        self.names = Names(module)
        self.arcs = collections.defaultdict(list)     # by the bit that they start from
        self.starts = {}
        self.ends = collections.defaultdict(list)
        self.readers = collections.Counter()          # the number of pins that each bit leads to
        self.outputs = {name: cell["connections"]["Q"][0] for name, cell in module["cells"].items() if REGISTER.match(cell["type"])}
        self.inner = 0
        for name, cell in module["cells"].items():
            self.add(name, cell)
        for name, port in module["ports"].items():
            if port["direction"] != "output":
                self.start(nets(port["bits"]), "pin", name, None)
            if port["direction"] != "input":
                self.finish(nets(port["bits"]), "an output port", name, None)
        self.carry_bits = self.longest_chain(module)

    def add(self, name, cell):
        kind, pins, directions = cell["type"], cell["connections"], cell["port_directions"]
        into = {pin: nets(bits) for pin, bits in pins.items() if directions[pin] != "output"}
        out = {pin: nets(bits) for pin, bits in pins.items() if directions[pin] != "input"}
        for bits in into.values():
            self.readers.update(bits)
        sources = [bit for bits in into.values() for bit in bits]
        results = [bit for bits in out.values() for bit in bits]
        if LUT.match(kind):
            self.join(sources, results, "lut", name)
        elif kind == "INV":
            # It is absorbed by the cell after it.
            self.join(sources, results, None, name, routed=False)
        elif kind.startswith("MUXF"):
            self.join(into["S"], results, "wide", name)
            self.join(into.get("I0", []) + into.get("I1", []), results, "wide", name, routed=False)
        elif kind == "CARRY4":
            self.add_carry(name, pins)
        elif kind in MEMORY_LUTS:
            clock = self.clock(pins["WCLK" if "WCLK" in pins else "CLK"], cell)
            self.finish_pins(into, name, clock)
            self.start(results, "memory", name, clock)
            addresses = [b for pin, bits in into.items() if MEMORY_ADDRESS.match(pin) for b in bits]
            self.join(addresses, results, "lut", name)
        elif REGISTER.match(kind):
            clock = self.clock(pins["C"], cell)
            self.finish_pins(into, name, clock)
            self.start(results, "register", name, clock)
        elif kind.startswith("RAMB"):
            clock = self.clock_of_block_ram(name, pins, cell)
            self.finish_pins(into, name, clock)
            self.start(results, "block_ram", name, clock)
        elif kind == "DSP48A1":
            self.add_dsp(name, cell, into, out)
        elif kind in BOUNDARY:
            self.finish_pins(into, name, None)
            self.start(results, "pin", name, None)
        else:
            raise SystemExit(f"netlist: unknown cell {kind}")

    def clock(self, bits, cell):
        """The clock of a pin. An inverter inside the register selects the other edge."""
        falling = cell["type"].endswith("_1") or number(cell["parameters"].get("IS_C_INVERTED", 0)) == 1
        return Clock(self.names.of(bits[0]), falling)

    def clock_of_block_ram(self, name, pins, cell):
        clocks = {bits[0] for pin, bits in pins.items() if pin.startswith("CLK") and nets(bits)}
        if len(clocks) != 1:
            raise SystemExit(f"netlist: {name} has {len(clocks)} clocks")
        return self.clock(list(clocks), cell)

    def add_carry(self, name, pins):
        entries = nets(pins.get("CYINIT", []))             # everything that a sum depends on except what arrives at CI
        for place in range(4):
            sums, carries, select, data = (nets(pins.get(pin, [])[place:place + 1]) for pin in ("O", "CO", "S", "DI"))
            self.join(nets(pins["CI"]), sums + carries, "ripple", name, routed=False)
            self.join(entries + select, sums, "carry", name)
            entries += select + data
            self.join(entries, carries, "carry", name)

    def add_dsp(self, name, cell, into, out):
        """A DSP slice as its stages, with the registers that it uses."""
        registers = {key: number(value) for key, value in cell["parameters"].items() if key.endswith("REG")}
        mode = cell["connections"]["OPMODE"]
        if any(bit not in ("0", "1") for bit in mode):
            raise SystemExit(f"netlist: {name} has an OPMODE that changes")
        adds_before, multiplies, adds_after = mode[4] == "1", mode[:2] == ["1", "0"], mode[2:4] != ["0", "0"]
        clock = self.clock(cell["connections"]["CLK"], cell)
        self.finish_pins({pin: bits for pin, bits in into.items() if pin not in ("A", "B", "C", "D", "PCIN")}, name, clock)

        def stage(bits, kind, registered, port="register"):
            self.inner -= 1
            self.join(bits, [self.inner], kind, name)
            if registered:
                self.finish([self.inner], name, port, clock)
                self.inner -= 1
                self.start([self.inner], "dsp", name, clock)
            return [self.inner]

        first = stage(into["B"], None, registers["B0REG"], "B")
        if adds_before:
            first = first + stage(into["D"], None, registers["DREG"], "D")
        factor = stage(first, "dsp" if adds_before else None, registers["B1REG"], "pre-adder")
        other = stage(into["A"], None, registers["A0REG"] or registers["A1REG"], "A")
        product = stage(factor + other, "dsp" if multiplies else None, registers["MREG"], "multiplier")
        addend = stage(into["C"], None, registers["CREG"], "C")
        if into.get("PCIN"):
            addend = addend + self.cascaded(into["PCIN"], name)
        inner = stage(product + (addend if adds_after else []), "dsp" if adds_after else None, registers["PREG"], "post-adder")
        self.join(inner, [bit for pin in ("P", "PCOUT") for bit in out.get(pin, [])], None, name)

    def cascaded(self, bits, name):
        """From the DSP slice below, over dedicated wires."""
        self.inner -= 1
        self.join(bits, [self.inner], None, name, routed=False)
        return [self.inner]

    def start(self, bits, kind, cell, clock):
        self.starts.update({bit: Start(kind, cell, clock) for bit in bits})

    def join(self, sources, results, kind, cell, routed=True):
        for source in sources:
            self.arcs[source] += [Arc(result, kind, cell, routed and source >= 0) for result in results]

    def finish_pins(self, into, cell, clock):
        for pin, bits in into.items():
            self.finish(bits, cell, pin, clock)

    def finish(self, bits, cell, pin, clock):
        for bit in bits:
            self.ends[bit].append(End(cell, pin, clock))

    def end_name(self, end):
        """A register is named after its output, any other cell by its own name; the pin is added unless it is the register's
        data."""
        name = self.names.of(self.outputs[end.cell]) if end.cell in self.outputs else end.cell
        return name if end.cell in self.outputs and end.pin == "D" else f"{name} ({end.pin})"

    def fan_outs(self, pins):
        """The nets that lead to pins of these names of clocked cells, with the number of such pins: (pins, name), the most
        first. A net without a name is named after the first pin that it leads to."""
        led_to = {bit: [end for end in ends if end.clock and pins.match(end.pin)] for bit, ends in self.ends.items()}
        for bit, ends in sorted(led_to.items(), key=lambda item: (-len(item[1]), item[0])):
            if ends:
                yield len(ends), self.names.of(bit) if bit in self.names.known else "that of " + min(map(self.end_name, ends))

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

    def sorted(self):
        """All bits, each after those that it depends on. A loop without a register is refused."""
        waiting = collections.Counter(arc.bit for arcs in self.arcs.values() for arc in arcs)
        ready = [bit for bit in set(self.arcs) | set(self.starts) | set(self.ends) if not waiting[bit]]
        order = []
        while ready:
            bit = ready.pop()
            order.append(bit)
            for arc in self.arcs.get(bit, ()):
                waiting[arc.bit] -= 1
                if not waiting[arc.bit]:
                    ready.append(arc.bit)
        if any(waiting.values()):
            raise SystemExit("netlist: logic runs in a loop without a register")
        return order
