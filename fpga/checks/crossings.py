#!/usr/bin/env python3
"""The clock crossings of the boards' tops, in yosys' netlists before mapping. Every bit that a register takes from another clock, or
from a pin, must go straight into two registers that are marked ASYNC_REG, and nothing else may read the first; the bits of a word that
crosses must count in Gray code; a reset may begin at any time if its end passes two registers; a memory takes nothing from a clock other
than its port's. Every exception is in crossings.ini with its reason, and every entry there must be found. crossings.txt has faults that
this must refuse.
    crossings.py        the tops with a sensor
    crossings.py long   all tops
"""
import concurrent.futures
import configparser
import fnmatch
import os
import pathlib
import sys
import tempfile

import edits
import tops
from word_netlist import REGISTERS, Netlist

HERE = pathlib.Path(__file__).resolve().parent


class Crossings:
    def __init__(self, netlist):
        self.netlist = netlist
        self.by_bit = {register.bit: register for register in netlist.registers()}

    def foreign(self, register, bit):
        return {leaf for leaf in self.netlist.leaves(bit) if leaf[0] != register.clock}

    def all(self):
        """(register, port, bit, where it comes from) of each bit that comes from elsewhere."""
        inputs = [(register, *taken) for register in self.by_bit.values() for taken in self.netlist.inputs(register)]
        for register, port, bit in [*inputs, *self.netlist.memory_inputs()]:
            others = self.foreign(register, bit)
            if others:
                yield register, port, bit, others

    def second(self, register):
        """The register that is the only reader of this one, in the same clock."""
        readers = self.netlist.readers[register.bit]
        if len(readers) != 1 or readers[0][1] != "D":
            return None
        cell, _, place = readers[0]
        if self.netlist.cells[cell]["type"] not in REGISTERS:
            return None
        after = self.by_bit.get(self.netlist.cells[cell]["connections"]["Q"][place])
        return after if after and after.clock == register.clock else None

    def fault(self, register, port, bit):
        """Why this is not a synchroniser, or None."""
        if register.bit is None:
            return f"reaches the memory's {port}"
        if port == "ARST":
            return self.fault_of_reset(register, bit)
        if port != "D":
            return f"reaches the register's {port}"
        if bit not in self.by_bit and bit not in self.netlist.pins:
            return "has logic in front of the first register"
        after = self.second(register)
        if after is None:
            return "is read behind one register"
        if register.bit not in self.netlist.marked or after.bit not in self.netlist.marked:
            return "ends in registers that are not marked ASYNC_REG"
        return None

    def fault_of_reset(self, register, bit):
        """A reset may begin without the clock. Its end has to pass two registers in a row, both held by it, before it is
        read."""
        chain = [r for r in self.by_bit.values() if r.cell == register.cell]
        first = [r for r in chain if not isinstance(self.netlist.inputs(r)[0][1], int)]
        if len(first) != 1 or any(r.bit not in self.netlist.marked for r in chain):
            return "is a reset that does not end in a marked chain of registers"
        length, last = 1, first[0]
        while (after := self.second(last)) and after.cell == register.cell:
            length, last = length + 1, after
        return None if length == len(chain) >= 2 else "is a reset that is read before two registers"

    def is_gray(self, bits):
        """Whether these bits are one cell's, and each is loaded with n[k] ^ n[k+1] of a count n that goes up by one."""
        data = sorted((self.by_bit[bit].place, self.netlist.inputs(self.by_bit[bit])[0][1]) for bit in bits)
        counts = {}
        for place, bit in data:
            cell, port, position = self.netlist.driver.get(bit, (None, None, None))
            kind = cell and self.netlist.cells[cell]["type"]
            sources = self.netlist.sources_of(cell, port, position) if kind == "$xor" else [bit]
            counts[place] = [source for source in sources if isinstance(source, int)]
        top = data[-1][0]
        adder = lambda bit: self.netlist.driver.get(bit, (None, None, None))
        if len({self.by_bit[bit].cell for bit in bits}) != 1 or [place for place, _ in data] != list(range(top + 1)):
            return False
        for place, sources in counts.items():
            wanted = {place, place + 1} if place < top else {place}
            drivers = [adder(source) for source in sources]
            if {position for _, _, position in drivers} != wanted:
                return False
            if any(not self.counts_up(cell) for cell, _, _ in drivers):
                return False
        return True

    def counts_up(self, cell):
        if cell is None or self.netlist.cells[cell]["type"] != "$add":
            return False
        step = self.netlist.cells[cell]["connections"]["B"]
        return step[0] == "1" and all(bit == "0" for bit in step[1:])


def judge(crossings, listed):
    """Faults, the entries of the list that were found, and the number of sound bits."""
    faults, met, sound, crossed = set(), set(), 0, []
    for register, port, bit, others in crossings.all():
        why = crossings.fault(register, port, bit)
        if why is None:
            sound += port == "D"
            if port == "D" and bit in crossings.by_bit:
                crossed.append((register, bit))
            continue
        for clock, source in others:
            entry = next((key for key in listed if matches(key, source, register.name)), None)
            if entry:
                met.add(entry)
            else:
                faults.add(f"{source} ({clock}) -> {register.name} ({register.clock}) {why}")
    # Bits of one word that cross into the same clock may arrive at different times, even if each has a synchroniser of its own.
    for word in words(crossings, crossed):
        if len(word) > 1 and not crossings.is_gray(word):
            name = min(crossings.by_bit[bit].name for bit in word)
            faults.add(f"{name} crosses as a bus of {len(word)} bits that do not count in Gray code")
    return faults, met, sound


def words(crossings, crossed):
    """Groups the bits that cross, (first register, bit) each, into the words of the source: bits of one clock that share a
    vector where they are written, or where their synchronisers are read. yosys' cells do not show this: a vector whose bits are
    written separately becomes several cells."""
    found = []
    for register, bit in crossed:
        read = crossings.second(register)
        keys = {(register.clock, name) for end in (bit, read.bit) for name in crossings.netlist.names[end]}
        bits = {bit}
        for word in [word for word in found if word[0] & keys]:
            found.remove(word)
            keys, bits = keys | word[0], bits | word[1]
        found.append((keys, bits))
    return [bits for _, bits in found]


def matches(key, source, register):
    left, right = (side.strip() for side in key.split("->"))
    return fnmatch.fnmatchcase(source, left) and fnmatch.fnmatchcase(register, right)


def faults_of(top, tree=edits.ROOT):
    """The faults of a top, and a line for the case that it has none."""
    name = tops.name_of(top)
    config = configparser.ConfigParser(delimiters=(":",), interpolation=None)
    config.optionxform = str
    config.read(HERE / "crossings.ini")
    listed = [key for section in config.sections() if fnmatch.fnmatchcase(name, section) for key in config[section]]
    faults, met, sound = judge(Crossings(Netlist(tops.netlist(top, "words", tree))), listed)
    faults |= {f"crossings.ini: {key} is not in {name}" for key in listed if key not in met}
    return faults, f"PASS {name}: {sound} bits cross through two registers, {len(met)} crossings are listed with their reasons"


def missed(top, mutants):
    """Puts all these faults into one copy of the sources; returns those that are not refused with the name of what they
    spoil."""
    with tempfile.TemporaryDirectory() as scratch:
        tree = pathlib.Path(scratch)
        edits.spoil(tree, mutants)
        faults, _ = faults_of(top, tree)
        return [(path, edit) for path, edit, spoilt in mutants if not any(spoilt in fault for fault in faults)]


def main():
    is_long = sys.argv[1:] == ["long"]
    every = [top for board in tops.CELLS for top in tops.all_of(board) if is_long or top.sensor]
    spoilable = [top for top in tops.all_of("minispartan6plus") if top.sensor]
    mutants = edits.by_kind(HERE / "crossings.txt", [top.kind for top in spoilable])
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        judged = [pool.submit(faults_of, top) for top in every]
        spoilt = [pool.submit(missed, top, mutants[top.kind]) for top in spoilable]
        wrong = sorted({fault for top in judged for fault in top.result()[0]})
        wrong += [f"this fault is not refused: {path}: {edit}" for top in spoilt for path, edit in top.result()]
    if wrong:
        sys.exit("crossings: " + "\ncrossings: ".join(wrong))
    print("\n".join(top.result()[1] for top in judged))
    print(f"PASS {sum(map(len, mutants.values()))} faults put into crossings are refused")


if __name__ == "__main__":
    main()
