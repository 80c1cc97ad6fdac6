"""Where the modules of fpga/rtl are, and the yosys commands that read them."""

import pathlib
import re

RTL = pathlib.Path(__file__).resolve().parent.parent / "rtl"
# A parameter in a module's head, of any type. form.py refuses every other form, so none is missed.
PARAMETER = re.compile(r"^    parameter (?:(?:signed|integer|real|realtime|time) )?(?:\[[^]]+\] )?(\w+) = ", re.MULTILINE)


def modules(rtl=RTL):
    """The files of all modules, by name."""
    return {path.stem: path for path in sorted(rtl.glob("*/*.v"))}


def parameters(text):
    """The parameters that a module's text declares, in order."""
    head = re.search(r"^module \w+ #\((.*?)^\) \(", text, re.MULTILINE | re.DOTALL)
    return PARAMETER.findall(head[1]) if head else []


def includes(rtl=RTL):
    """Lets every later read_verilog find the include files."""
    return f"verilog_defaults -add -I{rtl}; "


def libraries(rtl=RTL):
    """For yosys' `hierarchy`: the folders with the modules."""
    return " ".join(f"-libdir {folder}" for folder in sorted({path.parent for path in modules(rtl).values()}))


def read(module, parameters=(), rtl=RTL):
    """yosys commands that read a module with these NAME=VALUE parameters, and everything below it."""
    chosen = "".join(f" -chparam {name} {value}" for name, value in (word.split("=", 1) for word in parameters))
    return (f"{includes(rtl)}read_verilog {modules(rtl)[module]}; "
            f"hierarchy -check {libraries(rtl)} -top {module}{chosen}; ")
