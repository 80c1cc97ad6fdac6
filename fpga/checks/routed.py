#!/usr/bin/env python3
"""Writes the design that nextpnr-ecp5 made as Verilog that can be simulated with ecp5_routed.v and ecp5_cells.v.
    routed.py ROUTED.json OUT.v [ROUTED.sdf]     ROUTED: the files of nextpnr's --write and --sdf; with the SDF the delays are included
A delay is put in front of the pin that it belongs to: the delay of the wire to it plus the longest one from there through its cell.
Nothing is annotated, since Icarus 11 ignores the INTERCONNECT of an SDF, which is half of the delay."""
import collections
import json
import pathlib
import re
import sys

PARAMETERS = {"TRELLIS_COMB": ("MODE", "INITVAL", "CCU2_INJECT1"), "TRELLIS_FF": ("SD", "REGSET", "SRMODE"),
              "DP16KD": ("DATA_WIDTH_A", "DATA_WIDTH_B", "REGMODE_A", "REGMODE_B", "WRITEMODE_A", "WRITEMODE_B", "CSDECODE_A",
                         "CSDECODE_B", "CLKAMUX", "CLKBMUX")}
PINS = {"TRELLIS_COMB": "A B C D M F1 FXA FXB FCI WD WAD0 WAD1 WAD2 WAD3 WRE WCK F FCO OFX", "TRELLIS_FF": "CLK LSR CE DI M Q",
        "DCCA": "CLKI CLKO"}
OUTPUTS = {"F", "FCO", "OFX", "Q", "CLKO"}
# What an unconnected pin reads when no parameter ties it.
OPEN = {"LSR": "1'b0", "FCI": "1'b0", "WRE": "1'b0", "WCK": "1'b0"}


def literal(value):
    """A parameter as nextpnr writes it: the digits of a number, or a text, which ends in a space if it could be taken for a
    number."""
    return f"{len(value)}'b{value}" if re.fullmatch("[01xz]+", value) else f'"{value.strip()}"'


def tied(cell, pin):
    """The level of an undriven input."""
    mux = cell["parameters"].get(f"{pin}MUX", pin).strip()
    if mux in ("0", "1"):
        return f"1'b{mux}"
    return "1'b0" if mux == "INV" else OPEN.get(pin, "1'b1")


class Delays:
    """Picoseconds by (instance, pin): of the wire that leads there, and from there through the cell."""

    def __init__(self, path):
        self.wires, self.cells = {}, collections.defaultdict(int)
        instance = None
        for line in path.read_text().splitlines() if path else ():
            if found := re.match(r"\s*\(INSTANCE (\S*)\)", line):
                instance = plain(found[1])
            elif found := re.match(r"\s*\(INTERCONNECT \S+ (\S+)/(\S+) \(\d+:\d+:(\d+)\)", line):
                self.wires[plain(found[1]), found[2]] = int(found[3])
            elif found := re.match(r"\s*\(IOPATH (\S+) \S+ \(\d+:\d+:(\d+)\)", line):
                self.cells[instance, found[1]] = max(self.cells[instance, found[1]], int(found[2]))


def plain(name):
    """A name from an SDF without its escapes."""
    return name.replace("\\", "")


def instance(name, cell, delays, bits):
    """The lines of one cell."""
    kind = cell["type"]
    clocks = {pin for pin in cell["connections"] if pin in ("CLK", "CLKA", "CLKB", "WCK")}
    given = [f".{key}({literal(cell['parameters'][key])})" for key in PARAMETERS.get(kind, ()) if key in cell["parameters"]]
    to_q = max((delays.cells[name, pin] for pin in clocks), default=0)
    if to_q:
        given.append(f".TO_Q({to_q})")
    pins, before = [], []
    wanted = PINS[kind].split() if kind in PINS else list(cell["connections"])
    for pin in wanted:
        bit = cell["connections"].get(pin, [])
        if bit:
            source = bits(bit[0])
            late = delays.wires.get((name, pin), 0) + (0 if pin in clocks else delays.cells[name, pin])
            if cell["port_directions"][pin] == "input" and late:
                before.append(f"    wire #{late} \\{name}.{pin} = {source};")
                source = f"\\{name}.{pin} "
            pins.append(f".{pin}({source})")
        elif pin not in OUTPUTS and cell["port_directions"].get(pin) != "output" and (kind != "MULT18X18D" or f"{pin}MUX" in cell["parameters"]):
            pins.append(f".{pin}({tied(cell, pin)})")
    if kind == "TRELLIS_COMB":
        pins.append(f".UPPER(1'b{int(bool(cell['connections'].get('FXA')))})")
    head = f" #({', '.join(given)})" if given else ""
    return [*before, f"    {kind}{head} \\{name} ({', '.join(pins)});"]


def pad(name, cell, bits):
    """A pad: what lies between a port and the fabric."""
    direction, ends = cell["parameters"]["DIR"], cell["connections"]
    if direction not in ("INPUT", "OUTPUT"):
        sys.exit(f"routed: {name} is a pin of the kind {direction}, which is not simulated")
    to, source = ("B", "I") if direction == "OUTPUT" else ("O", "B")
    return [f"    assign {bits(ends[to][0])} = {bits(ends[source][0])};"]


def verilog(module, delays):
    ports = {bit: (f"{name}[{place}]" if len(port["bits"]) > 1 else name)
             for name, port in module["ports"].items() for place, bit in enumerate(port["bits"])}
    bits = lambda bit: ports.get(bit, f"n{bit}") if isinstance(bit, int) else f"1'b{bit}"
    wide = lambda port: f"[{len(port['bits']) - 1}:0] " if len(port["bits"]) > 1 else ""
    declared = [f"    {port['direction']} wire {wide(port)}{name}" for name, port in module["ports"].items()]
    used = sorted({bit for cell in module["cells"].values() for pin in cell["connections"].values() for bit in pin
                   if isinstance(bit, int)} - set(ports))
    lines = ["`timescale 1ps / 1ps", "module top (", ",\n".join(declared), ");"] + [f"    wire n{bit};" for bit in used]
    for name, cell in module["cells"].items():
        lines += pad(name, cell, bits) if cell["type"] == "TRELLIS_IO" else instance(name, cell, delays, bits)
    return "\n".join([*lines, "endmodule", ""])


def main():
    routed, out, *sdf = map(pathlib.Path, sys.argv[1:])
    out.write_text(verilog(json.loads(routed.read_text())["modules"]["top"], Delays(sdf[0] if sdf else None)))


if __name__ == "__main__":
    main()
