"""A flat netlist of yosys' word-level cells, before mapping: what drives each bit, what reads it, and where it comes from."""

import collections

BITWISE = {"$not", "$and", "$or", "$xor", "$xnor", "$mux"}
REGISTERS = {"$dff", "$dffe", "$sdff", "$sdffe", "$sdffce", "$adff", "$adffe"}
CONTROLS = ("EN", "SRST", "ARST")
# What a memory samples with each of these clocks; a read port without a clock samples nothing.
MEMORY_INPUTS = {"WR_CLK": ("WR_ADDR", "WR_DATA", "WR_EN"), "RD_CLK": ("RD_ADDR", "RD_EN", "RD_SRST", "RD_ARST")}
Register = collections.namedtuple("Register", "name bit clock cell place")


class Netlist:
    """What drives each bit and what reads it. A bit is a number; constants are left out."""

    def __init__(self, module):
        self.cells = module["cells"]
        self.names = collections.defaultdict(list)
        self.marked = set()                          # bits of registers that are marked ASYNC_REG
        for name, net in module["netnames"].items():
            for bit in net["bits"]:
                if not net.get("hide_name"):
                    self.names[bit].append(name)
                if "ASYNC_REG" in net["attributes"]:
                    self.marked.add(bit)
        self.pins = {bit: name for name, port in module["ports"].items() if port["direction"] != "output"
                     for bit in port["bits"]}
        self.outputs = {name for name, port in module["ports"].items() if port["direction"] == "output"}
        self.driver, self.readers = {}, collections.defaultdict(list)
        for name, cell in self.cells.items():
            for port, bits in cell["connections"].items():
                for place, bit in enumerate(bits):
                    if not isinstance(bit, int):
                        continue
                    if cell["port_directions"][port] == "output":
                        self.driver[bit] = (name, port, place)
                    else:
                        self.readers[bit].append((name, port, place))
        for name, port in module["ports"].items():
            if port["direction"] != "input":
                for bit in port["bits"]:
                    self.readers[bit].append((None, name, 0))
        self.leaves_of = {}

    def name(self, bit):
        return min(self.names.get(bit) or [f"bit {bit}"], key=lambda name: (name in self.outputs, name.count("."), len(name), name))

    def clock(self, cell, port="CLK"):
        bit = self.cells[cell]["connections"][port][0]
        return self.name(bit)

    def registers(self):
        for name, cell in self.cells.items():
            if cell["type"] in REGISTERS:
                for place, bit in enumerate(cell["connections"]["Q"]):
                    yield Register(self.name(bit), bit, self.clock(name), name, place)

    def memory_inputs(self):
        """What memories sample with a clock: the memory as a register without a bit, the port, its bit."""
        for name, cell in self.cells.items():
            if cell["type"] != "$mem_v2":
                continue
            pins, has_clock = cell["connections"], cell["parameters"]["RD_CLK_ENABLE"][::-1]
            for clock, ports in MEMORY_INPUTS.items():
                for place, wire in enumerate(pins[clock]):
                    if clock == "RD_CLK" and has_clock[place] == "0":
                        continue
                    memory = Register(name, None, self.name(wire), name, place)
                    for port in ports:
                        width = len(pins[port]) // len(pins[clock])
                        yield from ((memory, port, bit) for bit in pins[port][place * width:][:width])

    def sources_of(self, cell, port, place):
        """The bits of a cell's inputs that its output depends on combinationally."""
        pins, kind = self.cells[cell]["connections"], self.cells[cell]["type"]
        if kind == "$mux":
            return [pins["A"][place], pins["B"][place], pins["S"][0]]
        if kind in BITWISE:
            return [pins[name][min(place, len(pins[name]) - 1)] for name in ("A", "B") if name in pins]
        return [bit for name, bits in pins.items() if self.cells[cell]["port_directions"][name] == "input" for bit in bits]

    def leaves(self, bit):
        """Where a bit comes from, as pairs of (clock, name). The clock of a pin is `pin`; for a cell of the vendor it is the
        cell's type."""
        if not isinstance(bit, int):
            return frozenset()
        if bit in self.leaves_of:
            return self.leaves_of[bit]
        self.leaves_of[bit] = frozenset()            # for a loop, which the netlist's own check refuses
        found = {("pin", self.pins[bit])} if bit in self.pins else set()
        if bit in self.driver:
            found |= self.driven(*self.driver[bit], bit)
        self.leaves_of[bit] = frozenset(found)
        return self.leaves_of[bit]

    def driven(self, cell, port, place, bit):
        kind = self.cells[cell]["type"]
        if kind in REGISTERS:
            return {(self.clock(cell), self.name(bit))}
        if kind == "$mem_v2":
            found = {(self.name(clock), cell) for clock in self.cells[cell]["connections"]["WR_CLK"]}
            return found.union(*(self.leaves(source) for source in self.cells[cell]["connections"]["RD_ADDR"]))
        if not kind.startswith("$"):
            return {(kind, f"{cell}.{port}")}
        return set().union(*(self.leaves(source) for source in self.sources_of(cell, port, place)))

    def inputs(self, register):
        """The data and the controls of a register's bit: (port, bit)."""
        pins = self.cells[register.cell]["connections"]
        return [("D", pins["D"][register.place])] + [(port, pins[port][0]) for port in CONTROLS if port in pins]
