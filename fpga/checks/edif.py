#!/usr/bin/env python3
"""The netlist of one of the miniSpartan6+'s tops as EDIF, for ISE's ngdbuild in place of XST's, and that it says what yosys has: it is read
back and compared, pin by pin.
    edif.py KIND FOLDER BUILD [sensor]     writes FOLDER/top.edif; BUILD: eight hexadecimal digits
    edif.py check                          tries it on all four tops, and that differences would be found
Hierarchical names get ISE's separator, and all nets that the UCF files name must be there."""

import collections
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import tops

BOARD = "minispartan6plus"
TOKEN = re.compile(r'"[^"]*"|[()]|[^\s()"]+')


def parsed(text):
    """An EDIF file as nested lists of words."""
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
    """(identifier, name) of something that may be renamed."""
    return (word[1], word[2]) if isinstance(word, list) else (word, word)


def all_below(tree, kind):
    """The lists of a kind in a tree, without those nested in another of that kind."""
    for part in tree:
        if isinstance(part, list) and part:
            if part[0] == kind:
                yield part
            else:
                yield from all_below(part, kind)


class Edif:
    """The kinds of the cells by name, and the ends that each net joins: (cell, port, place of the bit from the highest). The
    cell is empty for the top's own ports."""

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
    """A name with ISE's separator of the hierarchy, unless yosys made it up."""
    return name if name.startswith("$") else name.replace(".", "/")


def joined_by(module):
    """The ends that each bit of a netlist joins, in the form of Edif. Those of constants are "0" and "1"."""
    joined = collections.defaultdict(set)
    ends = [(ise_name(name), cell["connections"]) for name, cell in module["cells"].items()]
    ends.append(("", {name: port["bits"] for name, port in module["ports"].items()}))
    for cell, pins in ends:
        for port, bits in pins.items():
            for place, bit in enumerate(bits):
                if bit not in ("x", "z"):
                    joined[bit].add((cell, port, len(bits) - 1 - place))
    return {bit: frozenset(net) for bit, net in joined.items()}


def with_kept_names(text, edif, module, ucf):
    """The EDIF with nets renamed to the names that the UCF uses. A net has several names, of which yosys writes one."""
    joined, written = joined_by(module), {ends: name for name, ends in edif.nets.items()}
    for place, name in enumerate(sorted(set(missing(edif, ucf)))):
        bits = next((net["bits"] for own, net in module["netnames"].items() if ise_name(own) == name), [None])
        if other := written.get(joined.get(bits[0])):
            net = rf'\(net (?:{re.escape(other)}|\(rename \S+ "{re.escape(other)}"\)) '
            text = re.sub(net, f'(net (rename kept{place} "{name}") ', text, count=1)
    return text


def differences(edif, module):
    """Where an EDIF file differs from the netlist that it was written from."""
    kinds = collections.Counter(kind for kind in edif.cells.values() if kind not in ("GND", "VCC"))
    wanted = collections.Counter(cell["type"] for cell in module["cells"].values())
    if kinds != wanted:
        yield f"cells: {kinds - wanted} too many, {wanted - kinds} missing"
    of_constants = {"GND": "0", "VCC": "1"}
    ours = {(bit if bit in ("0", "1") else "", net) for bit, net in joined_by(module).items() if len(net) > 1 or bit in ("0", "1")}
    theirs = set()
    for net in edif.nets.values():
        sources = {end for end in net if edif.cells.get(end[0]) in of_constants}
        if len(net) > 1:
            theirs.add(("".join(of_constants[edif.cells[cell]] for cell, _, _ in sources), net - sources))
    if ours != theirs:
        yield f"nets: {len(theirs - ours)} are joined otherwise, as {sorted(next(iter(theirs ^ ours))[1])[:4]}"


def missing(edif, ucf):
    """Nets and pins that the UCF names and the EDIF file lacks."""
    there = set(edif.nets) | {name if width == 1 else f"{name}<{place}>" for name, width in edif.ports.items() for place in range(width)}
    for name in re.findall(r'^NET\s+"([^"*]+)"', ucf, re.MULTILINE):
        if name not in there:
            yield name


def ucf_of(top):
    """The constraints of a top, put together as `build` does it."""
    board = tops.ROOT / "fpga/boards" / top.board
    return "".join((board / f"{name}.ucf").read_text() for name in ("common", top.kind, *(["sensor"] if top.sensor else [])))


def written(top, netlist):
    """The EDIF of a netlist in JSON, and the module that it was written from. Unknown bits become 0."""
    with tempfile.TemporaryDirectory() as work:
        aside, settled = pathlib.Path(work) / "top.edif", pathlib.Path(work) / "top.json"
        script = f"read_json {netlist}; setundef -zero; write_json {settled}; write_edif -pvector ang {aside}"
        done = subprocess.run(["yosys", "-q", "-p", script], capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"edif: yosys writes no EDIF of {tops.name_of(top)}:\n{done.stderr[-1500:]}")
        text = re.sub(r'(\(rename \S+ ")([^"]*)"', lambda found: found[1] + ise_name(found[2]) + '"', aside.read_text())
        module = json.loads(settled.read_text())["modules"][tops.module_of(top)]
    return with_kept_names(text, Edif(text, tops.module_of(top)), module, ucf_of(top)), module


def faults(top, text, module):
    edif = Edif(text, tops.module_of(top))
    return [*differences(edif, module), *(f"there is no {name}, which the UCF names" for name in missing(edif, ucf_of(top)))]


def told(top, text):
    edif = Edif(text, tops.module_of(top))
    return f"PASS EDIF of {tops.name_of(top)}: {len(edif.cells)} cells and {len(edif.nets)} nets, as yosys has them, and all that the UCF names"


# Edits of an EDIF file that must be found: another cell, a pin on another net, bits in another order, another constant, a lost
# name.
SPOILT = [("cellRef FDRE", "cellRef FDSE"), ("(portRef D ", "(portRef CE "), ("(member DOA 1)", "(member DOA 2)"),
          ("cellRef GND", "cellRef VCC"), ("clk32", "clock")]


def check():
    """Checks every top and, for the first, that each edit is found."""
    for top in tops.all_of(BOARD):
        text, module = written(top, tops.made(top, "cells"))
        wrong = faults(top, text, module)
        contents = text.index("(contents")
        for before, after in SPOILT if top == tops.all_of(BOARD)[0] else []:
            place = text.index(before, contents)
            spoilt = text[:place] + text[place:].replace(before, after, 1) if before != "clk32" else text.replace(before, after)
            if not faults(top, spoilt, module):
                wrong.append(f"`{after}` in place of `{before}` is not refused")
        if wrong:
            sys.exit("edif: " + "\nedif: ".join(wrong))
        print(told(top, text))


def main():
    words = sys.argv[1:]
    if words == ["check"]:
        return check()
    if len(words) not in (3, 4) or words[0] not in ("fifo", "uart") or words[3:] not in ([], ["sensor"]):
        sys.exit(__doc__)
    kind, folder, build = words[0], pathlib.Path(words[1]).resolve(), words[2]
    if not re.fullmatch("[0-9a-f]{8}", build):
        sys.exit(f"edif: BUILD is eight hexadecimal digits, not `{build}`")
    top = tops.Top(BOARD, kind, bool(words[3:]))
    tops.run(top, "cells", tops.ROOT, folder / "netlist.json", build)
    text, module = written(top, folder / "netlist.json")
    if wrong := faults(top, text, module):
        sys.exit("edif: " + "\nedif: ".join(wrong))
    (folder / "top.edif").write_text(text)
    print(told(top, text))


if __name__ == "__main__":
    main()
