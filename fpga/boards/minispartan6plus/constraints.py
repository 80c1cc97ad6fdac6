"""Holds the timing constraints of a UCF to what the board needs. ISE says "met" of one that asks too little, too.
The OFFSETs are left to whoever wires a sensor: they are its data sheet's, as sensor.ucf says."""

import pathlib
import re

CLOCKS = pathlib.Path(__file__).resolve().parent / "board_clocks.v"
# MHz of PIXCLK that sensor.ucf is written for, which the link's clock has as well.
PIXCLK_MHZ = 96
# README.md adds up the write cycle of the FT245 from the first; of a read the chip's 14 ns and the second have four clocks.
FT_OUT_NS, FT_IN_NS = 6, 9
# From where the clock's choice is made to the BUFGMUX: within half a clock, which is low.
CHOICE_NS = 4
# What no clock looks at in time: lamps, and a UART's bits, which last 83 ns.
IGNORED = {'NET "led<*>"', 'NET "uart_*"'}
STATEMENT = re.compile(r'^(TIMESPEC\s+"\w+"\s*=|NET\s+"[^"]+"\s+MAXDELAY\s*=)\s*([^;]*);', re.MULTILINE)


def limits(kind, sensor, crossing_ns):
    """Nanoseconds that each constraint may ask for at most."""
    oscillator = float(re.search(r"\.CLKIN_PERIOD\(([0-9.]+)\)", CLOCKS.read_text())[1])
    most = {"TS_clk32": oscillator}
    if kind == "fifo":
        most |= {"TS_ft_out": FT_OUT_NS, "TS_ft_in": FT_IN_NS}
    if sensor:
        most |= {"TS_pixclk": 1000 / PIXCLK_MHZ, "TS_to_link": crossing_ns, "TS_from_link": crossing_ns,
                 "MAXDELAY of board/choose_pixclk": CHOICE_NS}
    return most


def asked(ucf):
    """(name, nanoseconds or None) of each constraint; ISE takes the last of one name."""
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
