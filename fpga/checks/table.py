"""The table of faults by what finds them: fpga/checks/coverage.md for readers, host/judge/src/coverage/faults.json for runs."""
import collections
import json
import pathlib
import re
import sys
import zlib

import mutants
import rtl

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "fpga" / "boards"))
import commit  # noqa: E402
# The parameters of every simulated board.
PARAMETERS = ROOT / "fpga" / "sim" / "parameters.txt"
PAGE = ROOT / "fpga" / "checks" / "coverage.md"
FAULTS = ROOT / "host" / "judge" / "src" / "coverage" / "faults.json"
CLASSES = ["samples", "signature", "latency", "counters", "read-back", "rules", "error", "equivalent", "left"]
HEAD = """# What a run finds

Made by `scripts/hardware coverage`, as `coverage.py` and `proofs.py` say; nobody writes it by hand. {count:,} single faults that {yosys} drew with
seed {seed} in the board's Verilog of build `{build}` (the CRC-32 of it and its parameters), each judged by what `halfrow verify --width {width} --height {height} --radius {radius}` of
commit {judge} does.

Found: {found:,} of the {open:,} that are not proven to make no difference, {share:.1f} %. {checked} drawn ones of the {equivalent} proofs were
checked by simulation at another size. How a fault is found says what failed first; an error is never a pass.

| Block | Faults | Samples | Signature | Latency | Counters | Read-back | Rules | Error | Equivalent | Left |
|---|---|---|---|---|---|---|---|---|---|---|
"""
LEFT = """
## Left

What no run finds and no proof settles, by where it is, and what would find it.

"""


def build():
    """The build that the simulated board reports: the CRC-32 of the Verilog and of its parameters (fpga/sim/build.rs)."""
    check = 0
    verilog = sorted(path for path in rtl.RTL.glob("**/*") if path.suffix in (".v", ".vh"))
    for path in [*verilog, PARAMETERS]:
        check = zlib.crc32(path.read_bytes(), check)
    return f"{check:08x}"


def judge():
    """The commit whose `verify` judges."""
    own = (f":!{path.relative_to(ROOT)}" for path in (PAGE, FAULTS))
    changed = commit.git("status", "--porcelain", "--", "fpga", "host", *own) != ""
    return f"`{commit.start()}`" + (" with changes that it does not have" if changed else "")


def line(block, number):
    """A fault in the form that runs read."""
    found = block.found[number]
    frames = [] if found["least"] else found["frames"]
    return {"block": block.name, "frames": frames, "at_speed": found["at_speed"], "corners": found["corners"], "rules": found["rules"],
            "always": found["least"], "whole": found["verdict"] != "PASS"}


def where(fault):
    """A fault's place: file and line, or line 0 of its instance's file where yosys does not give one."""
    source = re.search(r"-src \S*/(\w+\.v):(\d+)", fault)
    if source:
        return source[1], int(source[2])
    return "halfrow_" + re.search(r"-module \S*?([^.\s]+) ", fault)[1] + ".v", 0


def name(fault):
    mode, cell, port = (re.search(rf"-{key} (\S+)", fault)[1] for key in ("mode", "cell", "port"))
    file, at = where(fault)
    bit = re.search(r"-portbit (\d+)", fault)[1]
    kind = cell.split("$")[1] if cell.startswith("$") and not cell.startswith("$auto") else "register" if "ff.cc" in cell else cell.rpartition("/")[2]
    return f"{file}:{at} `{kind}` {port}[{bit}] {mode}"


def remedy(section, fault):
    """What would find the fault, as coverage.ini says by file."""
    words = dict(entry.strip().split(" ", 1) for entry in section["left"].strip().splitlines())
    return words.get(where(fault)[0], "not known")


def left(block, section):
    """The block's faults that are left, with what would find them."""
    groups = collections.defaultdict(list)
    for number, what in block.classes().items():
        if what == "left":
            fault = block.faults[number - 1]
            groups[remedy(section, fault)].append(f"{number} {name(fault)}")
    told = [f"- {words}: {len(names)}. " + "; ".join(names) for words, names in sorted(groups.items())]
    return f"### {block.name.replace('_', ' ')}\n\n" + "\n".join(told) + "\n" if told else ""


def write(blocks, checked, sections, seed, sizes):
    """Writes both files anew."""
    total = collections.Counter()
    rows = []
    for block in blocks:
        counts = collections.Counter(block.classes().values())
        total += counts
        rows.append((block.name.replace("_", " "), counts))
    rows.append(("all", total))
    numbers = {"count": total.total(), "equivalent": total["equivalent"], "open": total.total() - total["equivalent"]}
    numbers["found"] = numbers["open"] - total["left"]
    # Rounded down, so that a run never claims more than was measured.
    numbers["share"] = 1000 * numbers["found"] // numbers["open"] / 10
    width, height, radius = sizes
    page = HEAD.format(seed=seed, yosys=mutants.version("yosys"), judge=judge(), build=build(), width=width, height=height, radius=radius, checked=checked, **numbers)
    page += "".join(f"| {of} | {counts.total():,} | " + " | ".join(f"{counts[one]:,}" for one in CLASSES) + " |\n" for of, counts in rows)
    page += LEFT + "\n".join(filter(None, (left(block, sections[block.name.replace("_", " ")]) for block in blocks)))
    PAGE.write_text(page)
    head = {"seed": seed, "width": int(width), "height": int(height), "radius": float(radius), "build": build(), "equivalent": total["equivalent"]}
    lines = [line(block, number) for block in blocks for number, what in block.classes().items() if what != "equivalent"]
    text = ",\n".join(json.dumps(one) for one in lines)
    FAULTS.write_text(json.dumps(head)[:-1] + ', "faults": [\n' + text + "\n]}\n")
