#!/usr/bin/env python3
"""The netlist of one of the miniSpartan6+'s tops as EDIF, for ISE's ngdbuild in place of XST's, and that it says what yosys has: it is read
back and compared, pin by pin.
    edif.py KIND FOLDER BUILD [sensor]     writes FOLDER/top.edif; BUILD: eight hexadecimal digits
Hierarchical names get ISE's separator, and all nets that the UCF files name must be there."""

import collections
import json
import pathlib
import re
import sys
import tempfile

import tops

BOARD = "minispartan6plus"
TOKEN = re.compile(r'"[^"]*"|[()]|[^\s()"]+')


def parsed(text):
    """Nested lists of an EDIF file's words."""
    stack = [[]]
    for word in TOKEN.findall(text):
        if word == "(":
            stack.append([])
        elif word == ")":
            last = stack.pop()
            stack[-1].append(last)
        else:
            stack[-1].append(word.strip('"'))
    return stack[0][0]


def named(word):
    """(identifier, name) of what may be renamed."""
    return (word[1], word[2]) if isinstance(word, list) else (word, word)


def all_below(tree, kind):
    """The lists of a kind in a tree, but not those inside one."""
    for part in tree:
        if isinstance(part, list) and part:
            if part[0] == kind:
                yield part
            else:
                yield from all_below(part, kind)


class Edif:
    """Cells by name, and what each net joins: (cell, port, place of the bit from the highest) with an empty cell for the top's own ports."""

    def __init__(self, text, module):
        library = next(part for part in parsed(text) if isinstance(part, list) and part[:2] == ["library", "DESIGN"])
        contents = next(all_below(next(cell for cell in all_below(library, "cell") if cell[1] == module), "contents"))
        interface = next(all_below(library, "interface"))
        self.ports = {}
        for port in all_below(interface, "port"):
            array = isinstance(port[1], list)
            identifier, name = named(port[1][1] if array else port[1])
            self.ports[name.partition("<")[0]] = int(port[1][2]) if array else 1
        self.cells, instances = {}, {}
        for instance in all_below(contents, "instance"):
            identifier, name = named(instance[1])
            instances[identifier] = name
            self.cells[name] = next(all_below(instance, "cellRef"))[1]
        self.nets = {}
        for net in all_below(contents, "net"):
            joined = [self.joined(end, instances) for end in all_below(net[2], "portRef")]
            self.nets[named(net[1])[1]] = frozenset(joined)

    @staticmethod
    def joined(end, instances):
        port, place = (end[1][1], int(end[1][2])) if isinstance(end[1], list) else (end[1], 0)
        cell = next((part[1] for part in end if isinstance(part, list) and part[0] == "instanceRef"), None)
        return (instances[cell] if cell else "", port, place)


def ise_name(name):
    """A name with ISE's separator of the hierarchy, unless it is one that yosys made up."""
    return name if name.startswith("$") else name.replace(".", "/")


def joined_by(module):
    """What each bit of a netlist joins, as Edif has it."""
    joined = collections.defaultdict(set)
    ends = [(ise_name(name), cell["connections"]) for name, cell in module["cells"].items()]
    ends.append(("", {name: port["bits"] for name, port in module["ports"].items()}))
    for cell, pins in ends:
        for port, bits in pins.items():
            for place, bit in enumerate(bits):
                if isinstance(bit, int):
                    joined[bit].add((cell, port, len(bits) - 1 - place))
    return {bit: frozenset(net) for bit, net in joined.items()}


def with_kept_names(text, edif, module, ucf):
    """EDIF whose nets have the names that the UCF knows them by. A net has several, of which yosys writes one."""
    joined, written = joined_by(module), {ends: name for name, ends in edif.nets.items()}
    for place, name in enumerate(sorted(set(missing(edif, ucf)))):
        bits = next((net["bits"] for own, net in module["netnames"].items() if ise_name(own) == name), [None])
        if other := written.get(joined.get(bits[0])):
            net = rf'\(net (?:{re.escape(other)}|\(rename \S+ "{re.escape(other)}"\)) '
            text = re.sub(net, f'(net (rename kept{place} "{name}") ', text, count=1)
    return text


def differences(edif, module):
    """What an EDIF file has otherwise than the netlist that it was written from."""
    kinds = collections.Counter(kind for kind in edif.cells.values() if kind not in ("GND", "VCC"))
    wanted = collections.Counter(cell["type"] for cell in module["cells"].values())
    if kinds != wanted:
        yield f"cells: {kinds - wanted} too many, {wanted - kinds} missing"
    ours = {net for net in joined_by(module).values() if len(net) > 1}
    theirs = {net for net in edif.nets.values() if len(net) > 1 and not any(edif.cells.get(cell) in ("GND", "VCC") for cell, _, _ in net)}
    if ours != theirs:
        yield f"nets: {len(theirs - ours)} are joined otherwise, as {sorted(next(iter(theirs ^ ours)))[:4]}"


def missing(edif, ucf):
    """Nets and pins that UCF files name and an EDIF file has not."""
    there = set(edif.nets) | {name if width == 1 else f"{name}<{place}>" for name, width in edif.ports.items() for place in range(width)}
    for name in re.findall(r'^NET\s+"([^"*]+)"', ucf, re.MULTILINE):
        if name not in there:
            yield name


def write(top, folder, build):
    """Writes top.edif, and returns what is wrong with it."""
    board = tops.ROOT / "fpga/boards" / top.board
    ucf = "".join((board / f"{name}.ucf").read_text() for name in ("common", top.kind, *(["sensor"] if top.sensor else [])))
    with tempfile.TemporaryDirectory(dir=folder) as work:
        aside, netlist = pathlib.Path(work) / "top.edif", pathlib.Path(work) / "netlist.json"
        tops.run(top, "cells", tops.ROOT, netlist, build, f"; setundef -zero; write_json {netlist}; write_edif -pvector ang {aside}")
        text = re.sub(r'(\(rename \S+ ")([^"]*)"', lambda found: found[1] + ise_name(found[2]) + '"', aside.read_text())
        module = json.loads(netlist.read_text())["modules"][tops.module_of(top)]
    text = with_kept_names(text, Edif(text, tops.module_of(top)), module, ucf)
    (folder / "top.edif").write_text(text)
    edif = Edif(text, tops.module_of(top))
    return edif, [*differences(edif, module), *(f"there is no {name}, which the UCF names" for name in missing(edif, ucf))]


def main():
    words = sys.argv[1:]
    if len(words) not in (3, 4) or words[0] not in ("fifo", "uart") or words[3:] not in ([], ["sensor"]):
        sys.exit(__doc__)
    if not re.fullmatch("[0-9a-f]{8}", words[2]):
        sys.exit(f"edif: BUILD is eight hexadecimal digits, not `{words[2]}`")
    edif, wrong = write(tops.Top(BOARD, words[0], bool(words[3:])), pathlib.Path(words[1]).resolve(), words[2])
    if wrong:
        sys.exit("edif: " + "\nedif: ".join(wrong))
    print(f"PASS top.edif: {len(edif.cells)} cells and {len(edif.nets)} nets, as yosys has them, and all that the UCF names")


if __name__ == "__main__":
    main()
