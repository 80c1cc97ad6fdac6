"""And-inverter graphs: a design as yosys writes it, and where two copies of it differ.

A literal is twice a node's number, odd when it is inverted; 0 is false.
"""
import re


class Graph:
    """A graph under construction. Equal nodes are shared."""

    def __init__(self):
        self.nodes, self.known, self.inputs, self.latches = [None], {}, [], {}

    def _free(self):
        self.nodes.append(None)
        return 2 * len(self.nodes) - 2

    def input(self):
        self.inputs.append(self._free())
        return self.inputs[-1]

    def latch(self):
        """A latch that starts at 0 and stays there until `latches` gives its next value."""
        made = self._free()
        self.latches[made] = 0
        return made

    def both(self, a, b):
        a, b = min(a, b), max(a, b)
        if a == 0 or a ^ 1 == b:
            return 0
        if a == 1 or a == b:
            return b
        if (a, b) not in self.known:
            self.nodes.append((a, b))
            self.known[a, b] = 2 * len(self.nodes) - 2
        return self.known[a, b]

    def either(self, a, b):
        return self.both(a ^ 1, b ^ 1) ^ 1

    def differ(self, a, b):
        return self.either(self.both(a, b ^ 1), self.both(a ^ 1, b))

    def ever(self, a):
        """Whether `a` was true at any earlier clock."""
        made = self.latch()
        self.latches[made] = self.either(made, a)
        return made

    def cone(self, literal):
        """The numbers of all nodes that decide a literal."""
        seen, todo = set(), [literal >> 1]
        while todo:
            node = todo.pop()
            if node in seen:
                continue
            seen.add(node)
            todo += [below >> 1 for below in self.nodes[node] or ()]
            if 2 * node in self.latches:
                todo.append(self.latches[2 * node] >> 1)
        return seen

    def write(self, path, bad):
        """Writes all nodes that decide `bad` in AIGER's binary form."""
        seen = self.cone(bad)
        inputs = [made for made in self.inputs if made >> 1 in seen]
        latches = [made for made in self.latches if made >> 1 in seen]
        ands = [node for node in sorted(seen) if self.nodes[node]]
        number = {0: 0}
        for node in [made >> 1 for made in inputs + latches] + ands:
            number[node] = len(number)

        def name(literal):
            return 2 * number[literal >> 1] | literal & 1

        with open(path, "wb") as out:
            out.write(f"aig {len(number) - 1} {len(inputs)} {len(latches)} 1 {len(ands)}\n".encode())
            out.write("".join(f"{name(self.latches[made])}\n" for made in latches).encode())
            out.write(f"{name(bad)}\n".encode())
            for node in ands:
                low, high = sorted(map(name, self.nodes[node]))
                out.write(packed(2 * number[node] - high) + packed(high - low))


def packed(value):
    """A number in AIGER's form: seven bits a byte, the lowest first."""
    made = bytearray()
    while value > 127:
        made.append(value & 127 | 128)
        value >>= 7
    return bytes(made + bytes([value]))


class Design:
    """A design that yosys wrote with `write_aiger -ascii -symbols`. Its input `fault` chooses a fault."""

    def __init__(self, path):
        with open(path) as text:
            _, inputs, latches, outputs, ands = map(int, next(text).split()[1:6])
            rows = [[int(word) for word in next(text).split()] for _ in range(inputs + latches + outputs + ands)]
            names = dict(line.strip().split(" ", 1) for line in text if re.match(r"[io]\d+ ", line))
        self.inputs = [(literal, names.get(f"i{place}", "")) for place, (literal,) in enumerate(rows[:inputs])]
        self.latches = [row[:2] for row in rows[inputs:inputs + latches]]
        outputs_from = inputs + latches
        self.outputs = {names.get(f"o{place}", f"o{place}"): literal for place, (literal,) in enumerate(rows[outputs_from:outputs_from + outputs])}
        self.ands = sorted(rows[outputs_from + outputs:])

    def copy(self, graph, inputs, latches, fault):
        """Adds the design to `graph`, with these inputs and latches and this fault. Returns the function that gives each
        literal there."""
        value = {0: 0}
        for (literal, name), given in zip(self.inputs, inputs):
            chosen = re.fullmatch(r"fault\[(\d+)\]", name)
            value[literal >> 1] = fault >> int(chosen[1]) & 1 if chosen else given
        value.update((literal >> 1, given) for (literal, _), given in zip(self.latches, latches))
        for made, a, b in self.ands:
            value[made >> 1] = graph.both(value[a >> 1] ^ a & 1, value[b >> 1] ^ b & 1)
        return lambda literal: value[literal >> 1] ^ literal & 1

    def pair(self, graph, fault):
        """The design without a fault and with this one: the pair of each output's literals. Nodes that the fault cannot reach
        are shared by both."""
        inputs = [graph.input() for _ in self.inputs]
        sound = [graph.latch() for _ in self.latches]
        good = self.copy(graph, inputs, sound, 0)
        for made, (_, after) in zip(sound, self.latches):
            graph.latches[made] = good(after)
        reached = list(sound)
        while True:
            bad = self.copy(graph, inputs, reached, fault)
            new = [place for place, (_, after) in enumerate(self.latches) if reached[place] == sound[place] and bad(after) != good(after)]
            if not new:
                break
            for place in new:
                reached[place] = graph.latch()
        for made, own, (_, after) in zip(reached, sound, self.latches):
            if made != own:
                graph.latches[made] = bad(after)
        return {name: (good(literal), bad(literal)) for name, literal in self.outputs.items()}
