"""Holds the timing constraints of a UCF to what the board needs, since ISE also reports constraints as met that ask too little.
The OFFSETs are left to whoever wires a sensor: they come from its data sheet, as sensor.ucf says."""

import pathlib
import re

CLOCKS = pathlib.Path(__file__).resolve().parent / "board_clocks.v"
# The PIXCLK in MHz that sensor.ucf is written for; the link's clock has the same rate.
PIXCLK_MHZ = 96
# README.md adds up the write cycle of the FT245 with the first. For a read, the chip's 14 ns and the second fit into four
# clocks.
FT_OUT_NS, FT_IN_NS = 6, 9
# From the choice of the clock to the BUFGMUX: within half a clock, in which the clock is low.
CHOICE_NS = 4
# Pins that no clock samples at a certain time: lamps, and a UART's bits, which last 83 ns.
IGNORED = {'NET "led<*>"', 'NET "uart_*"'}
STATEMENT = re.compile(r'^(TIMESPEC\s+"\w+"\s*=|NET\s+"[^"]+"\s+MAXDELAY\s*=)\s*([^;]*);', re.MULTILINE)


def limits(kind, sensor, crossing_ns):
    """The most nanoseconds that each constraint may ask for."""
    oscillator = float(re.search(r"\.CLKIN_PERIOD\(([0-9.]+)\)", CLOCKS.read_text())[1])
    most = {"TS_clk32": oscillator}
    if kind == "fifo":
        most |= {"TS_ft_out": FT_OUT_NS, "TS_ft_in": FT_IN_NS}
    if sensor:
        most |= {"TS_pixclk": 1000 / PIXCLK_MHZ, "TS_to_link": crossing_ns, "TS_from_link": crossing_ns,
                 "MAXDELAY of board/choose_pixclk": CHOICE_NS}
    return most


def asked(ucf):
    """(name, nanoseconds or None) of each constraint; of constraints with the same name ISE takes the last."""
    for head, words in STATEMENT.findall(ucf):
        name = re.search(r'"([^"]+)"', head)[1]
        told = re.fullmatch(r"(?:PERIOD\s+\S+\s+|FROM\s+\S+\s+TO\s+\S+\s+)?([0-9.]+) ns(?: HIGH 50%| DATAPATHONLY)?", words)
        yield name if head.startswith("TIMESPEC") else f"MAXDELAY of {name}", float(told[1]) if told else None


def faults(ucf, kind, sensor, crossing_ns):
    lines = re.sub(r"^\s*#.*$", "", ucf, flags=re.MULTILINE)
    found = list(asked(lines))
    for name, most in limits(kind, sensor, crossing_ns).items():
        values = [value for of, value in found if of == name]
        if not values:
            yield f"top.ucf: the constraint {name} is missing"
        for value in values:
            if value is None:
                yield f"top.ucf: {name} does not say its time in ns"
            elif value > most:
                yield f"top.ucf: {name} asks for {value:g} ns, and {most:g} ns are needed"
    for what in re.findall(r"^(.*\S)\s+TIG\b", lines, re.MULTILINE):
        if what not in IGNORED:
            yield f"top.ucf: the timing of {what} is ignored"
