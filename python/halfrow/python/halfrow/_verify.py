"""A board judged."""
from __future__ import annotations

import os
import sys
from typing import Callable, Dict, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _report
from ._halfrow import Kernel, Tables
from ._halfrow import verify as _run

Name = Union[str, "os.PathLike[str]"]
Frame = Union[Name, NDArray[np.uint16]]
Progress = Callable[[str, str, int], object]


def verify(
    board: str = "mock",
    *,
    tables: Optional[Tables] = None,
    kernel: Union[Kernel, Name, None] = None,
    frames: Union[Frame, Sequence[Frame], None] = None,
    phase: str = "grbg",
    repeat: int = 1,
    seed: int = 1,
    at_speed: Optional[float] = None,
    within: Optional[float] = None,
    fail_fast: bool = False,
    timeout: Optional[float] = None,
    reconnect: Optional[float] = None,
    retry_limit: Optional[float] = None,
    take_over: bool = False,
    require_hardware: bool = False,
    report: Optional[Name] = None,
    record: Optional[Name] = None,
    overwrite: bool = False,
    progress: Optional[Progress] = None,
) -> _report.Report:
    """Judges the board behind `board`, as `halfrow verify` does, and returns what was found, whatever it is.

    board: a target as the command line has it: mock, mock,fault=stuck-data,bit=7, usb, serial:/dev/ttyUSB1, tcp:bench:3001,
        replay:run.rec.
    tables: what to judge with; the paper's when not given, and then other centres and depths as well.
    kernel: takes the place of the tables': a Kernel, one of halfrow.KERNELS, or a kernel file.
    frames: what to stream instead of all built-in frames, one or several, never none: "builtin:street", a file, or an array of uint16
        of shape (height, width) of the tables' size and depth; `phase` is their Bayer phase.
    repeat: how often, 1 to 1000.
    seed: of noise, gaps, link test and what the board makes on its own.
    at_speed: seconds of the board's clock for which it makes frames at its full pixel clock, 0 for none; 3 on hardware and
        three frames on any other board when not given.
    within: judge within this many seconds, by the parts of the run that find the most faults per second.
    fail_fast: end with the first frame that differs.
    timeout: seconds that the run may take, of this computer's clock or the link's, whichever is over first.
    reconnect: seconds that a board which goes away may stay away; without it that ends the run.
    retry_limit: how many packets may be sent again: 16, and this percentage of all sent; 5 when not given.
    take_over: take the board from another host that holds it.
    require_hardware: refuse to judge anything else.
    report: a folder for report.json, report.xml (JUnit) and report.html.
    record: a file for every byte of the run with its time, for replay:FILE.
    overwrite: replace what an earlier run has written.
    progress: is called in this thread with ("step", words, 0), ("rows-expected", "", rows), ("frame", name, 0),
        ("rows", "", rows that came back since) and ("done", "", 0); what it raises ends the run.

    Python's lock is released. Ctrl-C, or any signal handler that raises, ends the run, gives the board back, and raises here; a
    second one raises at once, and leaves the run to give the board back behind it.
    Raises InputError where the call is wrong or does not fit the board, HalfrowError where no board could be opened.
    """
    if isinstance(frames, (str, os.PathLike)) or isinstance(frames, np.ndarray) and frames.ndim == 2:
        frames = (frames,)
    options: Dict[str, object] = {
        "tables": tables,
        "kernel": kernel,
        "frames": None if frames is None else tuple(frames),
        "phase": phase,
        "repeat": repeat,
        "seed": seed,
        "at_speed": at_speed,
        "within": within,
        "fail_fast": fail_fast,
        "timeout": timeout,
        "reconnect": reconnect,
        "retry_limit": retry_limit,
        "take_over": take_over,
        "require_hardware": require_hardware,
        "arguments": [word.encode(errors="replace").decode() for word in getattr(sys, "argv", ())],
        "report": report,
        "record": record,
        "overwrite": overwrite,
        "progress": progress,
    }
    defaults = (verify.__kwdefaults__ or {}).items()
    options["given"] = [name for name, default in defaults if _says_else(options[name], default)]
    return _report.of(_run(board, options))


def _says_else(value: object, default: object) -> bool:
    return value is not None if default is None else value != default
