#!/usr/bin/env python3
"""Puts faults into the Verilog, one at a time, and reports which check finds which.
    fpga/checks/mutation.py WORK COUNT [MODULE...]
mutation.ini says where the faults are and what tries them. yosys puts all faults of a module into one netlist, in which a number turns one
on, so a check is compiled once per module. Results are kept in WORK; an interrupted run resumes while sources, COUNT and SEED are the same.
Survivors are listed with their place, whether or not they make a difference. The file `table` in WORK is written by a run of all modules alone.
"""
import collections
import concurrent.futures
import configparser
import hashlib
import pathlib
import re
import shutil
import sys

import mutants
import rtl

HERE = pathlib.Path(__file__).resolve().parent
FLOOR = 85                                   # per cent of all that must be found; some survivors are no faults
SEED = 1
SURVIVES = "survives"


def key(count):
    """A hash of everything that decides what a fault is and which check finds it."""
    tools = [mutants.version(tool) for tool in ("yosys", "verilator")]
    told = hashlib.sha256(f"{count} {SEED} {tools}".encode())
    files = [*rtl.RTL.glob("**/*.v*"), *mutants.BENCH.iterdir(), *HERE.glob("mut*"), *HERE.glob("*_bench.cpp"), *HERE.glob("*.hpp"),
             HERE / "rtl.py", HERE.parents[1] / "protocol/check_vectors.py"]
    for path in sorted(path for path in files if path.is_file() and path.suffix != ".md"):
        told.update(path.name.encode() + b"\0" + path.read_bytes())
    return told.hexdigest()


def judge(fault, checks):
    """The first check that refuses a fault."""
    return next((check.name for check in checks if check.refuses(fault)), SURVIVES)


def try_all(module, section, place, count):
    """Number, fault and finder of each fault of a module; known results are read."""
    faults = mutants.draw(place, module, section, count, SEED)
    made = mutants.netlist(place, module, section, faults)
    results = place / "results"
    known = dict(line.split() for line in results.read_text().splitlines()) if results.exists() else {}
    open_numbers = [number for number in range(1, len(faults) + 1) if str(number) not in known]
    if open_numbers:
        checks = [mutants.Check(name, place, made, section) for name in section["checks"].split()]
        with concurrent.futures.ThreadPoolExecutor(2) as pool, open(results, "a", buffering=1) as out:
            tried = {pool.submit(judge, number, checks): number for number in open_numbers}
            for one in concurrent.futures.as_completed(tried):
                if one.exception():
                    pool.shutdown(cancel_futures=True)
                known[str(tried[one])] = one.result()
                out.write(f"{tried[one]} {one.result()}\n")
    return [(number, fault, known[str(number)]) for number, fault in enumerate(faults, 1)]


def described(number, fault):
    """A fault in words: what it does to which cell or wire, and the source line of that."""
    wire = re.search(r"-wire (\S+) -wirebit (\d+)", fault)
    mode, cell, port = (re.search(rf"-{word} (\S+)", fault)[1] for word in ("mode", "cell", "port"))
    source = " ".join(dict.fromkeys(re.findall(r"-src \S*?(halfrow_\w+\.v:\d+)", fault)))
    return f"{number} {mode} {wire[1] + '[' + wire[2] + ']' if wire else cell} {port} {source}"


def inner(fault, module):
    """The module that contains a fault, by its name in fpga/rtl."""
    return re.search(r"-module \S*?(halfrow_\w+)", fault)[1] if re.search(r"-module \S*?halfrow_", fault) else module


def table(found, order):
    """Lines: a module, its faults, and how many of them each check was the first to find."""
    rows = collections.defaultdict(collections.Counter)
    for module, part, finder in found:
        rows[module, part][finder] += 1
    for (module, part), counts in rows.items():
        told = ", ".join(f"{name} {counts[name]}" for name in [*order, SURVIVES] if counts[name])
        yield f"{module.removeprefix('halfrow_')}/{part.removeprefix('halfrow_')}: {counts.total()}: {told}"
    sums = collections.Counter(finder for _, _, finder in found)
    yield f"all: {sums.total()}: " + ", ".join(f"{name} {sums[name]}" for name in [*order, SURVIVES] if sums[name])


def main():
    work, count, chosen = pathlib.Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3:]
    sections = configparser.ConfigParser()
    sections.read(HERE / "mutation.ini")
    if unknown := set(chosen) - set(sections.sections()):
        sys.exit(f"mutation: there is no {', '.join(sorted(unknown))} in mutation.ini, but {', '.join(sections.sections())}")
    work.mkdir(parents=True, exist_ok=True)
    mark = work / "key"
    if not mark.exists() or mark.read_text() != key(count):
        for name in sections.sections():
            shutil.rmtree(work / name, ignore_errors=True)
        (work / "table").unlink(missing_ok=True)
        mark.write_text(key(count))
    found, survivors = [], []
    order = list(dict.fromkeys(name for section in sections.values() for name in section.get("checks", "").split()))
    for module in chosen or sections.sections():
        section, place = sections[module], work / module
        place.mkdir(exist_ok=True)
        for number, fault, finder in try_all(module, section, place, max(1, count * section.getint("share") // 1000)):
            found.append((module, inner(fault, module), finder))
            if finder == SURVIVES:
                survivors.append(f"  survives: {module} {described(number, fault)}")
        print(f"{module}: {sum(1 for one in found if one[0] == module and one[2] != SURVIVES)} of "
              f"{sum(1 for one in found if one[0] == module)} found", flush=True)
    lines = [*survivors, *table(found, order)]
    if not chosen:                           # a table of some modules would stand where one of all is looked for
        (work / "table").write_text("\n".join(lines) + "\n")
    print("\n".join(lines))
    seen = sum(1 for one in found if one[2] != SURVIVES)
    if 100 * seen < FLOOR * len(found):
        sys.exit(f"mutation: {seen} of {len(found)} found, less than {FLOOR} per cent")


if __name__ == "__main__":
    main()
