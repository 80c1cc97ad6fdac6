#!/usr/bin/env python3
"""Reports which single faults of the Verilog a run of `halfrow verify` finds, and how.
    fpga/checks/coverage.py WORK RUNNER COUNT [BLOCK...]
coverage.ini says where faults are put. yosys puts them into the netlist of the whole board. For each block this makes a library in which a
number chooses the fault; RUNNER (halfrow-coverage) judges the board with each. Results are kept in WORK, and an interrupted run resumes.
"""
import collections
import concurrent.futures
import configparser
import dataclasses
import hashlib
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys

import mutants
import proofs
import rtl
import table

HERE = pathlib.Path(__file__).resolve().parent
SHIM = HERE.parent / "sim" / "shim"
SEED = 1
TOP = "halfrow_bridge"
# Width, height and radius of the lens, in pixels.
SIZES = ["64", "16", "40"]
# The same for judging faults that are proven to make no difference, and how many of those are judged.
LONG = ["96", "24", "60"]
CHECKED = 100
# This many faults of a block that are found are tried too; they must not be proven.
CONTROLS = 5
# The table in the repository is only written for this many faults.
FAULTS = 2100
CLASSES = {"frames": "samples", "at-speed": "signature", "latency": "latency", "counters": "counters", "read-back": "read-back",
           "tables-after": "read-back", "identity": "read-back", "upload": "read-back", "link": "counters",
           "rules": "rules"}
AT_ONCE = 2
BOARD = "uniquify; prep -top {top}; wreduce; opt -full; opt_clean -purge; write_ilang {base}"
# The contents of memories are not faults of the design, and yosys 0.23 cannot put a fault into a memory's port. A clock is not
# inverted either.
DRAW = "read_ilang {base}; select -set block {modules}; select @block t:$mem* %d; mutate -list {count} -seed {seed} -ctrl fault 16 1 -o {faults}"
# The choice of the fault is not an input of the simulated board: all that depends on an input would be computed again at each
# clock.
CHOICE = 'reg [15:0] fault;\n  initial fault = $c("halfrow_fault");'
WITH_FAULTS = "read_ilang {base}\n{faults}\nhierarchy -top {top}\nsplitnets\nwrite_verilog -noattr {made}\n"


def key(paths, words=""):
    """A hash of these files and words."""
    told = hashlib.sha256(words.encode())
    for path in paths:
        told.update(path.read_bytes())
    return told.hexdigest()


def judging_key(count, runner):
    """A hash of everything that decides what a fault is and which check finds it."""
    own = [HERE / "coverage.py", HERE / "coverage.ini", HERE / "mutants.py", HERE / "rtl.py", table.PARAMETERS, pathlib.Path(runner)]
    tools = [mutants.version(tool) for tool in ("yosys", "verilator")]
    return key([*own, *sorted(SHIM.iterdir()), *sorted(rtl.RTL.glob("**/*.v*"))], f"{count} {SEED} {SIZES} {tools}")


def board(work):
    """The file of the board's netlist, in which each instance is a module of its own, and the names of these modules."""
    base = work / "board.il"
    if not base.exists():
        commands = rtl.read(TOP, table.PARAMETERS.read_text().split()) + BOARD.format(top=TOP, base=base.with_suffix(".new"))
        mutants.run(["yosys", "-q", "-p", commands], work / "board.log")
        base.with_suffix(".new").rename(base)
    return base, re.findall(r"^module \\(\S+)", base.read_text(), re.MULTILINE)


def chosen(section, modules):
    """The modules of a block."""
    found = []
    for word in section["instances"].split():
        name = f"{TOP}.{word.removesuffix('*')}"
        below = [module for module in modules if module == name or (word.endswith("*") and module.startswith(name + "."))]
        if not below:
            sys.exit(f"coverage: there is no {name} in the board; mend fpga/checks/coverage.ini")
        found += below
    return found


def draw(place, base, modules, count):
    """The yosys commands that put a block's faults in, one a fault."""
    words = DRAW.format(base=base, modules=" ".join(modules), count=mutants.more(count), seed=SEED, faults=place / "faults.txt")
    mutants.run(["yosys", "-q", "-p", words], place / "draw.log")
    return mutants.numbered(place / "faults.txt", count)


def choosing(text):
    """yosys' text of the board with faults, with the port that chooses one replaced by the shim's number."""
    before, top = re.split(rf"(?=^module {TOP}\()", text, maxsplit=1, flags=re.MULTILINE)
    top = re.sub(r",\s*fault\);", ");", top, count=1)
    return before + re.sub(r"input \[15:0\] fault;\s*wire \[15:0\] fault;", lambda _: CHOICE, top, count=1)


def library(place, base, faults):
    """The board with a block's faults, as a shared library."""
    made, library = place / "board.v", place / "board.so"
    if library.exists():
        return library
    (place / "faults.ys").write_text(WITH_FAULTS.format(base=base, faults="\n".join(faults), top=TOP, made=made))
    mutants.run(["yosys", "-q", "-s", place / "faults.ys"], place / "yosys.log")
    made.write_text(choosing(made.read_text()))
    folder = place / "translated"
    shutil.rmtree(folder, ignore_errors=True)
    mutants.run(["verilator", "--cc", "-O3", "--x-assign", "fast", "--x-initial", "unique", "-Wno-fatal", "-Wno-lint", "-Wno-UNOPTFLAT",
         "--top-module", TOP, "--prefix", "Faulty", "--Mdir", folder, made], place / "verilator.log")
    root = subprocess.run(["verilator", "--getenv", "VERILATOR_ROOT"], capture_output=True, text=True, check=True).stdout.strip()
    include = pathlib.Path(root) / "include"
    sources = [SHIM / "faulty.h", *sorted(folder.glob("*.cpp"))]
    unit = place / "board.cpp"
    unit.write_text("".join(f'#include "{source.resolve()}"\n' for source in sources) + "DESIGN(faulty, Faulty)\n")
    mutants.run(["g++", "-std=c++17", "-O2", "-w", "-shared", "-fPIC", "-fno-semantic-interposition", "-DVL_TIME_CONTEXT", "-DVM_TRACE=0",
         "-DVM_COVERAGE=0", "-DVM_SC=0", f"-I{include}", f"-I{include / 'vltstd'}", f"-I{SHIM}", f"-I{folder}", unit,
         *(include / f"{part}.cpp" for part in ("verilated", "verilated_threads", "verilated_vcd_c")),
         "-Wl,-z,defs", "-lpthread", "-o", library.with_suffix(".new")], place / "compiler.log")
    library.with_suffix(".new").rename(library)
    return library


def judge(runner, library, number, sizes=SIZES):
    """What RUNNER reports for the board with this fault."""
    said = subprocess.run([runner, library, *sizes, str(number)], capture_output=True, text=True)
    if said.returncode != 0:
        sys.exit(f"coverage: fault {number} of {library}: {said.stderr.strip()}")
    return json.loads(said.stdout)


def judged(runner, place, base, faults):
    """The result for each fault of a block, by number. 0 is no fault, and must pass before the others are tried."""
    results = place / "results"
    lines = results.read_text().splitlines() if results.exists() else []
    known = {found["fault"]: found for found in map(json.loads, lines)}
    missing = [number for number in range(len(faults) + 1) if number not in known]
    if not missing:
        return known
    made = library(place, base, faults)
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool, open(results, "a", buffering=1) as out:
        for numbers in (missing[:1], missing[1:]):
            tried = [pool.submit(judge, runner, made, number) for number in numbers]
            for one in concurrent.futures.as_completed(tried):
                if one.exception():
                    pool.shutdown(cancel_futures=True)
                found = one.result()
                known[found["fault"]] = found
                out.write(json.dumps(found) + "\n")
            if known[0]["verdict"] != "PASS":
                sys.exit(f"coverage: the board without a fault does not pass, see {results}")
    return known


def known_proofs(place, base, faults, found):
    """For each fault that no check finds, by number: the module in which it is proven to make no difference, or None. Some
    faults that are found serve as controls: they must not be proven."""
    kept = place / f"proofs_{key([HERE / 'proofs.py', HERE / 'aig.py'])[:8]}"
    lines = kept.read_text().splitlines() if kept.exists() else []
    known = {line["fault"]: line["proof"] for line in map(json.loads, lines)}
    left = [number for number in range(1, len(faults) + 1) if found[number]["verdict"] == "PASS"]
    others = [number for number in range(1, len(faults) + 1) if found[number]["verdict"] == "FAIL"]
    controls = random.Random(SEED).sample(others, min(CONTROLS, len(others)))
    missing = [number for number in controls + left if number not in known]
    if missing:
        prover = proofs.Prover(place / "proof", base, {number: faults[number - 1] for number in controls + left})
        with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool, open(kept, "a", buffering=1) as out:
            for number, proof in zip(missing, pool.map(prover.proof, missing)):
                known[number] = proof
                out.write(json.dumps({"fault": number, "proof": proof}) + "\n")
    for number in controls:
        if known[number]:
            sys.exit(f"coverage: fault {number} of {place.name} is found and proven to make no difference; mend fpga/checks/proofs.py")
    return {number: known[number] for number in left}


def check_proofs(work, runner, blocks):
    """Judges some faults that are proven to make no difference once more, in a longer run at another size."""
    proven = [(block.name, number) for block in blocks for number, proof in block.proofs.items() if proof]
    drawn = random.Random(SEED).sample(proven, min(CHECKED, len(proven)))
    kept = work / "checked"
    done = kept.read_text().splitlines() if kept.exists() else []
    with concurrent.futures.ThreadPoolExecutor(AT_ONCE) as pool, open(kept, "a", buffering=1) as out:
        missing = [one for one in drawn if " ".join(map(str, one)) not in done]
        tried = {one: pool.submit(judge, runner, work / one[0] / "board.so", one[1], LONG) for one in missing}
        for (name, number), judging in tried.items():
            if judging.result()["verdict"] != "PASS":
                sys.exit(f"coverage: fault {number} of {name} is proven to make no difference, and is found at {LONG}; mend fpga/checks/proofs.py")
            out.write(f"{name} {number}\n")
    return len(drawn)


def by(found, proof):
    """How a fault is found: a class of table.py."""
    if found["verdict"] == "ERROR":
        return "error"
    return CLASSES[found["checks"][0]] if found["checks"] else "equivalent" if proof else "left"


@dataclasses.dataclass
class Block:
    """A block's faults, and the results for each by its number."""

    name: str
    faults: list
    found: dict
    proofs: dict

    def classes(self):
        """The class of each fault, by number."""
        return {number: by(self.found[number], self.proofs.get(number)) for number in range(1, len(self.faults) + 1)}


def main():
    work, runner, count, only = pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), sys.argv[4:]
    sections = configparser.ConfigParser()
    sections.read(HERE / "coverage.ini")
    work.mkdir(parents=True, exist_ok=True)
    mark, now = work / "key", judging_key(count, runner)
    if not mark.exists() or mark.read_text() != now:
        shutil.rmtree(work)
        work.mkdir()
        mark.write_text(now)
    base, modules = board(work)
    blocks = []
    for name in only or sections.sections():
        place = work / name.replace(" ", "_")
        place.mkdir(exist_ok=True)
        faults = draw(place, base, chosen(sections[name], modules), count * sections.getint(name, "share") // 1000)
        found = judged(runner, place, base, faults)
        blocks.append(Block(place.name, faults, found, known_proofs(place, base, faults, found)))
        counts = collections.Counter(blocks[-1].classes().values())
        print(f"{name}: {len(faults)} faults: " + ", ".join(f"{number} {what}" for what, number in counts.most_common()), flush=True)
    checked = check_proofs(work, runner, blocks)
    print(f"{checked} of the proofs checked by simulation at {' x '.join(LONG[:2])}")
    if not only and count == FAULTS:
        table.write(blocks, checked, sections, SEED, SIZES)


if __name__ == "__main__":
    main()
