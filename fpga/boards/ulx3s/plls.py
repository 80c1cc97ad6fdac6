#!/usr/bin/env python3
"""Checks the PLLs of the ULX3S's tops in yosys' netlists before mapping, which nextpnr does not: each frequency within what the vendor
guarantees, the link's clock exact, each PLL held in reset until the one that feeds it has locked. Edits of a netlist must be refused."""

import copy
import fractions
import re
import sys

import flow

# MHz, of the ECP5 family data sheet (FPGA-DS-02012), sysCLOCK PLL timing. Below the detector's least LOCK may stay low for ever.
LIMITS = {"input": (8, 400), "detector": (10, 400), "VCO": (400, 800), "output": (fractions.Fraction("3.125"), 400)}
DIVIDERS = range(1, 129)
LINK_MHZ = 96
OUTPUTS = ("CLKOP", "CLKOS")

# An edit of a PLL in a netlist: parameters, or a port to tie; and what must be said of it.
REFUSED = [
    ("first_pll", {"CLKI_DIV": 5, "CLKFB_DIV": 5}, "its detector runs at 5 MHz"),
    ("first_pll", {"CLKOP_DIV": 15, "CLKOS_DIV": 15}, "its VCO runs at 375 MHz"),
    ("first_pll", {"CLKOP_DIV": 33}, "its VCO runs at 825 MHz"),
    ("first_pll", {"CLKOS_DIV": 90}, "its input runs at 6.66667 MHz"),
    ("first_pll", {"CLKOS_DIV": 24}, "the link's clock runs at 100 MHz"),
    ("second_pll", {"CLKOP_DIV": 129}, "CLKOP_DIV is 129"),
    ("second_pll", {"CLKFB_DIV": 5}, "FREQUENCY_PIN_CLKOP says 96 MHz"),
    ("second_pll", {"PLLRST_ENA": "DISABLED"}, "is not held in reset"),
    ("second_pll", {"RST": "0"}, "is not held in reset"),
    ("second_pll", {"CLKFB": "0"}, "its CLKFB is not its CLKOP"),
]


def oscillators(design):
    """MHz of each pin that the constraints say is a clock."""
    text = "".join(path.read_text() for path in flow.constraints(design))
    return {name: fractions.Fraction(mhz) for name, mhz in re.findall(r'^FREQUENCY PORT "([^"]*)" ([0-9.]+) MHZ;', text, re.MULTILINE)}


class Plls:
    """The PLLs of a flat module, and what runs at which frequency."""

    def __init__(self, module, pins):
        self.netlist = module
        self.cells = {name: cell for name, cell in module["cells"].items() if cell["type"] == "EHXPLLL"}
        self.mhz = {module["ports"][name]["bits"][0]: mhz for name, mhz in pins.items() if name in module["ports"]}
        self.faults = []
        waiting = dict(self.cells)
        while ready := [name for name in waiting if self.bit(name, "CLKI") in self.mhz]:
            for name in ready:
                self.judge(name, waiting.pop(name))
        self.faults += [f"{name}: nobody knows its input's frequency" for name in waiting]

    def bit(self, name, port):
        return self.cells[name]["connections"].get(port, ["x"])[0]

    def number(self, name, parameter):
        given = self.cells[name]["parameters"].get(parameter, "1")
        return given if isinstance(given, int) else int(given, 2)

    def within(self, name, what, mhz):
        least, most = LIMITS[what]
        if not least <= mhz <= most:
            self.faults.append(f"{name}: its {what} runs at {float(mhz):g} MHz, where {float(least):g} to {most} are allowed")

    def judge(self, name, cell):
        path = cell["parameters"].get("FEEDBK_PATH", "CLKOP").strip()
        used = [output for output in OUTPUTS if cell["parameters"].get(f"{output}_ENABLE", "").strip() == "ENABLED"]
        for divider in ("CLKI_DIV", "CLKFB_DIV", *(f"{output}_DIV" for output in used)):
            if self.number(name, divider) not in DIVIDERS:
                self.faults.append(f"{name}: {divider} is {self.number(name, divider)}, where 1 to 128 are allowed")
        if path not in used or self.bit(name, "CLKFB") != self.bit(name, path):
            self.faults.append(f"{name}: its CLKFB is not its {path}")
            return
        given = self.mhz[self.bit(name, "CLKI")]
        detector = given / self.number(name, "CLKI_DIV")
        vco = detector * self.number(name, "CLKFB_DIV") * self.number(name, f"{path}_DIV")
        rates = {"CLKI": given, **{output: vco / self.number(name, f"{output}_DIV") for output in used}}
        for what, mhz in [("input", given), ("detector", detector), ("VCO", vco), *(("output", rates[output]) for output in used)]:
            self.within(name, what, mhz)
        for port, mhz in rates.items():
            said = cell["attributes"].get(f"FREQUENCY_PIN_{port}", "").strip()
            if said and fractions.Fraction(said) != mhz:
                self.faults.append(f"{name}: FREQUENCY_PIN_{port} says {said} MHz, and it is {float(mhz):g}")
            self.mhz[self.bit(name, port)] = mhz
        self.judge_reset(name, cell)

    def judge_reset(self, name, cell):
        """A PLL that another one feeds must be in reset while that one is not locked, or its own lock would say nothing."""
        feeding = [other for other in self.cells if self.bit(name, "CLKI") in (self.bit(other, output) for output in OUTPUTS)]
        inverted = {one["connections"]["Y"][0]: one["connections"]["A"][0] for one in self.netlist["cells"].values()
                    if one["type"] in ("$not", "$logic_not")}
        looked_at = cell["parameters"].get("PLLRST_ENA", "DISABLED").strip() == "ENABLED"
        if feeding and not (looked_at and inverted.get(self.bit(name, "RST")) == self.bit(feeding[0], "LOCK")):
            self.faults.append(f"{name} is not held in reset until {feeding[0]} has locked")

    def judge_link(self):
        """Of the link's clock: its rate, and that `locked` is its PLL's."""
        bit = lambda name: self.netlist["netnames"][name]["bits"][0]
        made = [name for name in self.cells if bit("link_clk") in (self.bit(name, output) for output in OUTPUTS)]
        if self.mhz.get(bit("link_clk")) != LINK_MHZ:
            self.faults.append(f"the link's clock runs at {float(self.mhz.get(bit('link_clk'), 0)):g} MHz, not at {LINK_MHZ}")
        if not made or self.bit(made[0], "LOCK") != bit("board.locked"):
            self.faults.append("board.locked is not the lock of the PLL that makes the link's clock")
        return self.faults


def faults(module, pins):
    return Plls(module, pins).judge_link()


def edited(module, pll, edit):
    module = copy.deepcopy(module)
    cell = next(cell for name, cell in module["cells"].items() if name.endswith(f".{pll}"))
    for key, value in edit.items():
        if key in cell["connections"]:
            cell["connections"][key] = [value]
        else:
            cell["parameters"][key] = value
    return module


def main():
    wrong = []
    for top in flow.tops.all_of("ulx3s"):
        if not top.sensor:
            continue
        module, pins = flow.tops.netlist(top, "words"), oscillators(flow.Design(top.kind, "sensor"))
        wrong += [f"{flow.tops.name_of(top)}: {fault}" for fault in faults(module, pins)]
        for pll, edit, due in REFUSED:
            said = faults(edited(module, pll, edit), pins)
            if not any(due in fault for fault in said):
                wrong.append(f"{flow.tops.name_of(top)}: {edit} of {pll} is not refused by '{due}', but by {said}")
    if wrong:
        sys.exit("plls: " + "\nplls: ".join(wrong))
    print(f"PASS the PLLs of the ULX3S are within their limits, and {len(REFUSED)} edits are refused")


if __name__ == "__main__":
    main()
