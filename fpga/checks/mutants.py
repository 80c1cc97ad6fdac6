"""Modules of fpga/rtl as yosys' netlists with many faults in each, one of which +fault=N turns on, and the checks that try
them."""
import json
import pathlib
import re
import subprocess
import sys
import threading

import rtl

HERE = pathlib.Path(__file__).resolve().parent
BENCH = HERE.parent / "bench"
FEW = ["golden", "random", "200", "1", "hostile", "100", "2"]
MANY = ["random", "3000", "3", "hostile", "1500", "4", "frame", "hermite"]
# Compiled checks: the bench's C++ file, the model's prefix, the top, and the arguments of the call.
COMPILED = {
    "core": ("core_bench.cpp", "core", "halfrow_core", FEW),
    "core_long": ("core_bench.cpp", "core", "halfrow_core", MANY),
    "rows_of_board": ("board_bench.cpp", "board", "halfrow_bridge", ["40", "1"]),
}

# The contents of memories are not faults of the design, and yosys 0.23 cannot put a fault into a memory's port. A clock is not
# inverted either.
DRAW = """{read} rename -top {module}; prep; wreduce; opt -full; opt_clean -purge; write_ilang {place}/base.il; select c:* t:$mem* %d{without};
mutate -list {count} -seed {seed} -ctrl mutsel 16 1 -o {place}/faults.txt"""

# What replaces the port that chooses the fault: its number from the command line, and a limit of clocks for a module that never
# finishes.
CHOICE = """reg [15:0] mutsel;
  reg [63:0] clocks, most;
  initial begin
    if (!$value$plusargs("fault=%d", mutsel)) mutsel = 0;
    if (!$value$plusargs("clocks=%d", most)) most = 0;
    clocks = 0;
  end
  always @(posedge {clock}) begin
    clocks <= clocks + 1;
    if (mutsel == 0 && (clocks & (clocks - 1)) == 0) $display("CLOCKS %0d", clocks);
    if (clocks == most && most != 0) begin
      $display("FAIL no end after %0d clocks", most);
      $stop;
    end
  end"""


def run(command, log):
    with open(log, "w") as out:
        if subprocess.run([str(word) for word in command], stdout=out, stderr=subprocess.STDOUT).returncode != 0:
            sys.exit(f"{pathlib.Path(sys.argv[0]).stem}: {command[0]} failed, see {log}")


def version(tool):
    """What a tool of the faults, yosys or verilator, says of itself."""
    said = subprocess.run([tool, "--version"], check=True, capture_output=True, text=True).stdout
    return " ".join(said.split()[:2])


def more(count):
    """How many faults to draw so that `count` remain without those of clocks."""
    return count + count // 4 + 10


def numbered(drawn, count):
    """The first `count` of yosys' commands in the file `drawn`, without those that invert a clock. Each is chosen by its
    number, from 1 on."""
    faults = [fault for fault in drawn.read_text().splitlines() if "-port CLK " not in fault][:count]
    return [re.sub(r"(-ctrl \S+ \d+) \d+", rf"\g<1> {number}", fault) for number, fault in enumerate(faults, 1)]


def header(module):
    """A module's whole text, and the part of it up to the end of its ports."""
    text = rtl.modules()[module].read_text()
    return text, re.search(r"^module .*?^\);$", text, re.MULTILINE | re.DOTALL)[0]


def netlist(place, module, section, faults):
    """Writes the module with all faults in it, as a replacement of the original one."""
    made = place / "netlist.v"
    (place / "faults.ys").write_text(f"read_ilang {place}/base.il\n" + "\n".join(faults) + f"\nwrite_verilog -noattr {made}\n")
    run(["yosys", "-q", "-s", place / "faults.ys"], place / "yosys.log")
    text = made.read_text()
    written, head = header(module)
    start = text.index(f"module {module}(")
    before, own = text[:start], text[start:]
    clock = "clk" if re.search(r"\bclk\b", head) else "in_clk"
    own = re.sub(r"^  input \[15:0\] mutsel;\n", "", own, count=1, flags=re.MULTILINE)
    own = re.sub(r"^  wire \[15:0\] mutsel;", lambda _: "  " + CHOICE.format(clock=clock), own, count=1, flags=re.MULTILINE)
    own = re.sub(r"(, )?\bmutsel\b(, )?", lambda found: ", " if found[1] and found[2] else "", own, count=1)
    names = rtl.parameters(written)
    if section.getboolean("beside", False):
        ports = ", ".join(f".{port}({port})" for port in json_ports(place, module))
        chosen = " && ".join(f"{name} == {value}" for name, value in (word.split("=") for word in section["parameters"].split()))
        own = own.replace(f"module {module}(", f"module {module}_faulty(", 1)
        own += written.replace(f"module {module} ", f"module {module}_as_written ")
        wires = re.sub(r"output reg (.*?\w)( = [^,]*)?(,|$)", r"output wire \1\3", head)
        own += f"\n{wires}\ngenerate if ({chosen}) {module}_faulty faulty ({ports});\n"
        own += f"else {module}_as_written #({', '.join(f'.{name}({name})' for name in names)}) good ({ports}); endgenerate\nendmodule\n"
    elif names:
        own = own.replace(f"module {module}(", f"module {module} #(parameter {' = 0, '.join(names)} = 0) (", 1)
    made.write_text(before + own)
    return made


def json_ports(place, module):
    """The names of a module's ports."""
    run(["yosys", "-q", "-p", f"read_ilang {place}/base.il; write_json {place}/base.json"], place / "json.log")
    return list(json.loads((place / "base.json").read_text())["modules"][module]["ports"])


def draw(place, module, section, count, seed):
    """The yosys commands that put faults in, one a fault."""
    without = "".join(f" *{name}*/* %d" for name in section.get("without", "").split())
    read = rtl.read(module, section.get("parameters", "").split())
    commands = DRAW.format(read=read, module=module, place=place, without=without, count=more(count), seed=seed)
    run(["yosys", "-q", "-p", commands.replace("\n", " ")], place / "draw.log")
    return numbered(place / "faults.txt", count)


def build(place, check, made, section):
    """The command that runs a check with this netlist: the program and its arguments."""
    folder = place / check.removesuffix("_long")
    search = [f"-I{rtl.RTL}", f"-I{BENCH}", *(word for path in sorted({path.parent for path in rtl.modules().values()}) for word in ("-y", path))]
    common = ["verilator", "--cc", "--exe", "--build", "-O3", "-Wno-fatal", "-Wno-lint", "--language", "1364-2005", "--Mdir", folder, "-o", "bench",
              *search]
    if check in COMPILED:
        source, prefix, top, words = COMPILED[check]
        blanking = re.search(r"LEAST_BLANKING=(\d+)", section.get("parameters", ""))
        told = f"-O1 -std=c++17 -DTAPS=7 -DTABLE_BANKS=2 -DLINK_BYTES -DLEAST_BLANKING={blanking[1] if blanking else 0}"
        command = [*common, "--no-timing", "--prefix", f"V{prefix}", "--top-module", top, made, HERE / source, "-CFLAGS", told]
        if top != section.name:
            command.insert(-3, rtl.modules()[top])
    else:
        words = []
        if check in ("receiver", "sender"):
            words = [f"+cases={place}/{check}.cases"]
            run([sys.executable, BENCH / "packets.py", check, f"{place}/{check}.cases"], place / "cases.log")
        command = [*common, "--main", "--timing", "--prefix", "Vbench", "--top-module", f"halfrow_{check}_bench", "-CFLAGS", "-O0", made,
                   BENCH / f"halfrow_{check}_bench.v"]
    if not (folder / "bench").exists():
        run(command, place / f"{check}.build.log")
    return [folder / "bench", *words]


def play(command, fault, clocks):
    """Whether a check passes with a fault, and the last count of clocks that it printed. It is stopped as soon as it reports a
    fault."""
    command = ["stdbuf", "-oL", *map(str, command), f"+fault={fault}", f"+clocks={clocks}"]
    done, told = False, 0
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace") as process:
        for line in process.stdout:
            if line.startswith("FAIL"):
                process.kill()
                return False, told
            told = int(line.split()[1]) if line.startswith("CLOCKS") else told
            done = done or line.startswith("DONE") or " equal" in line
        process.wait()
    return process.returncode == 0 and done, told


class Check:
    """A check that is tried on the faults of one module. It is built when it is first needed."""

    def __init__(self, name, place, made, section):
        self.name, self.place, self.made, self.section = name, place, made, section
        self.lock, self.command, self.clocks = threading.Lock(), None, 0

    def refuses(self, fault):
        """Whether the check refuses the fault. A module that never finishes is stopped after two to four times the clocks of
        the sound one."""
        with self.lock:
            if not self.command:
                command = build(self.place, self.name, self.made, self.section)
                passed, told = play(command, 0, 0)
                if not passed:
                    sys.exit(f"mutation: {self.name} fails without a fault of {self.section.name}")
                self.command, self.clocks = command, 4 * told
        return not play(self.command, fault, self.clocks)[0]
