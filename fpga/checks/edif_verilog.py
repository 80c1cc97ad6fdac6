#!/usr/bin/env python3
"""Verilog of the netlist that an EDIF file holds, for a simulator with models of the cells: what ISE is given, not what it was made from.
    edif_verilog.py FILE MODULE OUT
Contents that a block RAM starts with and values of its resets are left out where they are 0, since no model has them, and refused where
they are not."""

import pathlib
import re
import sys

import edif

SIZED = re.compile(r"(\d+)'h[0-9a-f]+$")
# Parameters that the models of block RAMs do not have: contents, and resets, which nothing uses.
CONTENTS, RESETS = re.compile(r"(INITP?_\w\w?|SRVAL_[AB])$"), re.compile(r"(EN_RSTRAM_[AB]|RSTTYPE|RST_PRIORITY_[AB])$")


CONSTANTS = {"GND": "1'b0", "VCC": "1'b1"}


class Netlist(edif.Edif):
    def __init__(self, text, module):
        super().__init__(text, module)
        tree = edif.parsed(text)
        self.module = module
        library = next(part for part in tree if isinstance(part, list) and part[:2] == ["external", "LIB"])
        self.cell_ports = {cell[1]: dict(self.interface(cell)) for cell in edif.all_below(library, "cell")}
        design = next(part for part in tree if isinstance(part, list) and part[:2] == ["library", "DESIGN"])
        self.own_ports = dict(self.interface(next(cell for cell in edif.all_below(design, "cell") if cell[1] == module)))
        self.parameters = {edif.named(instance[1])[1]: dict(self.parameters_of(instance)) for instance in edif.all_below(design, "instance")}

    @staticmethod
    def interface(cell):
        """(port, (width, direction)) of each port."""
        for port in edif.all_below(next(edif.all_below(cell, "interface")), "port"):
            array = isinstance(port[1], list) and port[1][0] == "array"
            _, name = edif.named(port[1][1] if array else port[1])
            yield name.partition("<")[0], (int(port[1][2]) if array else 1, next(edif.all_below(port, "direction"))[1])

    @staticmethod
    def parameters_of(instance):
        for _, name, (kind, value) in edif.all_below(instance, "property"):
            yield name, value if kind == "integer" or SIZED.match(value) else f'"{value}"'


def kept(netlist, cell):
    """The parameters that the cell's model has."""
    for name, value in netlist.parameters[cell].items():
        ram = netlist.cells[cell].startswith("RAMB")
        if ram and CONTENTS.match(name) and not re.match(r"\d+'h0+$", value):
            sys.exit(f"edif_verilog: {cell} starts with {name} = {value}, which the model of a block RAM cannot: give block_ram.v contents")
        if not (ram and (CONTENTS.match(name) or RESETS.match(name))):
            yield f".{name}({value})"


def connections(netlist, cell, joined, spare):
    """A cell's pins. An unconnected output gets a net of its own. An undriven input gets the level that would do the most harm,
    so that no result depends on what the chip makes of it: a clock enable is low, everything else is high."""
    for port, (width, direction) in netlist.cell_ports[netlist.cells[cell]].items():
        bits = [joined.get((cell, port, place)) for place in range(width)]
        if direction == "OUTPUT" and not any(bits):
            continue
        for place, bit in enumerate(bits):
            if bit is None and direction == "OUTPUT":
                spare.append(f"s{len(spare)}")
                bits[place] = spare[-1]
            elif bit is None:
                bits[place] = "1'b0" if port.startswith("CE") else "1'b1"
        yield f".{port}({{{', '.join(bits)}}})" if width > 1 else f".{port}({bits[0]})"


def verilog(netlist):
    joined, wires, passed, spare = {}, [], [], []
    directions = {"INPUT": "input wire", "OUTPUT": "output wire", "INOUT": "inout wire"}
    for number, ends in enumerate(netlist.nets.values()):
        # A net is named after the first of the top's ports that it joins, unless it is a constant.
        own = sorted(ends_of_top(netlist, ends))
        constant = {CONSTANTS.get(netlist.cells.get(cell)) for cell, _, _ in ends} - {None}
        name = min(constant) if constant else own.pop(0)[1] if own else f"n{number}"
        wires += [name] if name == f"n{number}" else []
        passed += [f"    assign {other} = {name};" for _, other in own]
        joined.update({end: name for end in ends})
    cells = []
    for number, (cell, kind) in enumerate(netlist.cells.items()):
        if kind in CONSTANTS:
            continue
        parameters, pins = ", ".join(kept(netlist, cell)), ", ".join(connections(netlist, cell, joined, spare))
        cells.append(f"    {kind} {f'#({parameters}) ' if parameters else ''}c{number} ({pins});")
    ports = ",\n".join(f"    {directions[direction]} {f'[{width - 1}:0] ' if width > 1 else ''}{name}"
                       for name, (width, direction) in netlist.own_ports.items())
    declared = "".join(f"    wire {name};\n" for name in wires + spare)
    return f"module {netlist.module} (\n{ports}\n);\n{declared}" + "\n".join(passed + cells) + "\nendmodule\n"


def ends_of_top(netlist, ends):
    """(whether it is an output, its name) of each of the top's own port bits among a net's ends."""
    for cell, port, place in ends:
        if cell == "":
            width, direction = netlist.own_ports[port]
            yield direction == "OUTPUT", f"{port}[{width - 1 - place}]" if width > 1 else port


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    file, module, out = sys.argv[1:]
    pathlib.Path(out).write_text(verilog(Netlist(pathlib.Path(file).read_text(), module)))


if __name__ == "__main__":
    main()
