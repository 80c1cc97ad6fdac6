"""Whether a single fault makes no difference: yosys and yosys-abc prove that the design with it equals the one without.

A fault is tried in the module that it is in, then in each module above it except the whole board. At the module's ports anything may come
at any clock, and the outputs of both designs must be equal at every clock. Assumptions:
    - registers begin at 0, as the FPGA's do;
    - a memory returns the same in both as long as the same goes into it; at its ports, what is not written or read may differ;
    - LEGAL: where a proof says so, only until a row is flagged as short or long. The player makes no such row
      (fpga/formal, player), so only a camera can.
"""
import re
import subprocess
import threading

import aig
import mutants

TOP = "halfrow_bridge"
SECONDS = 5
# Clocks within which a difference is searched for before any proof.
NEAR = 30
# By module, the outputs of the sound design that flag a row that no host can play.
LEGAL = {
    "halfrow_bridge.core.entry": ["row_short", "row_long"],
}
# A module with more registers than this is not tried: attempts there took minutes and hardly ever proved anything.
MOST = 1500
# A row is flagged within this many clocks after the fault's difference is seen.
LATE = 2
MEMORY = re.compile(r"^  cell \$mem_v2 (\S+)\n((?:    .*\n)*?)  end\n", re.MULTILINE)
PORTS = {"RD_ADDR": ("RD_PORTS", "ABITS"), "RD_EN": ("RD_PORTS", None), "RD_ARST": ("RD_PORTS", None), "RD_SRST": ("RD_PORTS", None),
         "RD_DATA": ("RD_PORTS", "WIDTH"), "WR_ADDR": ("WR_PORTS", "ABITS"), "WR_DATA": ("WR_PORTS", "WIDTH"), "WR_EN": ("WR_PORTS", "WIDTH")}
TO_AIGER = """read_ilang {base}
{faults}
hierarchy -top {root}
flatten
opt_clean
expose -evert t:memory_*
setundef -init -zero
async2sync
dffunmap
opt_expr
techmap
simplemap
setundef -undriven -zero
setundef -zero
aigmap
opt_clean
write_aiger -ascii -zinit -symbols {made}
"""


def boxed(board):
    """The board in yosys' text form, with each memory replaced by a module without contents."""
    boxes = []

    def box(found):
        sizes = {name: int(value) for name, value in re.findall(r"parameter \\(\w+) (\d+)$", found[2], re.MULTILINE)}
        ports, wires = [], []
        for place, (port, (count, width)) in enumerate(PORTS.items(), 1):
            bits = sizes[count] * (sizes[width] if width else 1)
            if bits:
                direction = "output" if port == "RD_DATA" else "input"
                ports.append(f"  wire width {bits} {direction} {place} \\{port}\n")
                wires.append(re.search(rf"^    connect \\{port} .*\n", found[2], re.MULTILINE)[0])
        boxes.append(f"attribute \\blackbox 1\nmodule \\memory_{len(boxes)}\n{''.join(ports)}end\n")
        # Only a cell with a public name can be exposed as ports.
        name = found[1] if found[1].startswith("\\") else f"\\unnamed_{len(boxes)}"
        return f"  cell \\memory_{len(boxes) - 1} {name}\n{''.join(wires)}  end\n"

    return MEMORY.sub(box, board) + "".join(boxes)


def module_of(fault):
    return re.search(r"-module (\S+)", fault)[1]


def gate(name, good, graph):
    """When the memory's port of this name is in use; 1 for any other output."""
    memory, _, port = name.rpartition(".")
    port, bit = re.fullmatch(r"(\w+)(\[\d+\])?", port).groups()
    enables = {"WR_DATA": [f"{memory}.WR_EN{bit or ''}"], "RD_ADDR": [key for key in good if key.startswith(f"{memory}.RD_EN")],
               "WR_ADDR": [key for key in good if key.startswith(f"{memory}.WR_EN")]}.get(port) if memory else None
    if not enables or any(key not in good for key in enables):
        return 1
    looked_at = 0
    for key in enables:
        looked_at = graph.either(looked_at, graph.either(*good[key]))
    return looked_at


class Prover:
    """Proves that faults of one board make no difference. `work` is the folder for its files."""

    def __init__(self, work, board, faults):
        self.work, self.faults, self.designs, self.lock = work, faults, {}, threading.Lock()
        work.mkdir(exist_ok=True)
        text = boxed(board.read_text())
        self.base = work / "board.il"
        self.base.write_text(text)
        self.modules = set(re.findall(r"^module \\(\S+)", text, re.MULTILINE))

    def above(self, module):
        """The module and those that contain it, from the inside out, without the board."""
        while module and module != TOP:
            if module in self.modules:
                yield module
            module = module.rpartition(".")[0]

    def design(self, root):
        """The design from `root` down, with the faults in it."""
        with self.lock:
            if root not in self.designs:
                inside = [fault for fault in self.faults.values() if root in self.above(module_of(fault))]
                script, made = self.work / "aiger.ys", self.work / "design.aag"
                script.write_text(TO_AIGER.format(base=self.base, faults="\n".join(inside), root=root, made=made))
                mutants.run(["yosys", "-q", "-s", script], self.work / "yosys.log")
                self.designs[root] = aig.Design(made)
            return self.designs[root]

    def difference(self, graph, root, number, is_legal):
        """When the fault has made a difference; with `is_legal`, only as long as all was legal."""
        outputs = self.design(root).pair(graph, number)
        seen = 0
        for name, (good, bad) in outputs.items():
            if good != bad:
                seen = graph.either(seen, graph.both(graph.differ(good, bad), gate(name, outputs, graph)))
        if is_legal and seen:
            flag = 0
            for name in LEGAL[root]:
                flag = graph.either(flag, outputs[name][0])
            for _ in range(LATE):
                seen = graph.ever(seen)
            seen = graph.both(seen, graph.either(flag, graph.ever(flag)) ^ 1)
        return seen

    def holds(self, root, number, is_legal):
        """Whether the fault is proven to make no difference at the ports of `root`."""
        graph = aig.Graph()
        bad = self.difference(graph, root, number, is_legal)
        if bad == 0:
            return True
        made = self.work / f"{number}.aig"
        graph.write(made, bad)
        if "was asserted" in self.abc(made, f"bmc3 -F {NEAR} -T 3"):
            return False
        said = self.abc(made, f"scorr; pdr -T {SECONDS}")
        return "was asserted" not in said and ("Property proved" in said or "are equivalent" in said)

    def abc(self, made, words):
        """The output of yosys-abc for an AIGER file; empty when it takes too long."""
        command = ["yosys-abc", "-c", f"read_aiger {made}; strash; {words}"]
        try:
            return subprocess.run(command, capture_output=True, text=True, timeout=2 * SECONDS).stdout
        except subprocess.TimeoutExpired:
            return ""

    def proof(self, number):
        """The module in which the fault of this number is proven, followed by ` legal` if that assumption is needed; None if it
        is not proven."""
        for root in self.above(module_of(self.faults[number])):
            if len(self.design(root).latches) > MOST:
                break
            for is_legal in [False, True] if root in LEGAL else [False]:
                if self.holds(root, number, is_legal):
                    return root + (" legal" if is_legal else "")
        return None
