"""Judging a board."""
from __future__ import annotations

import os
import sys
from typing import Callable, Dict, Iterable, Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _report
from ._errors import HalfrowError
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
    frames: Union[Frame, Iterable[Frame], None] = None,
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
    """Judges the board at `board`, as `halfrow verify` does, and returns what was found, whatever the verdict.

    board: a target as on the command line: mock, mock,fault=stuck-data,bit=7, usb, serial:/dev/ttyUSB1, tcp:bench:3001,
        replay:run.rec.
    tables: the tables to judge with; by default the paper's. If frames are not given either, other optical centres and depths are
        tested as well.
    kernel: replaces the tables' own: a Kernel, one of halfrow.KERNELS, or a kernel file.
    frames: what to stream instead of all built-in frames, one or several but not none: "builtin:street", a file, or an array
        of uint16 of shape (height, width), of the tables' size and depth; `phase` is their Bayer phase.
    repeat: how often to stream them, 1 to 1000.
    seed: the seed of noise, gaps, the link test and the frames that the board makes.
    at_speed: for how many seconds of the board's clock it makes frames at its full pixel clock, 0 for none; by default 3 on
        hardware, and three frames on any other board.
    within: judge within this many seconds, by the parts of the run that find the most faults per second.
    fail_fast: end with the first frame that differs.
    timeout: how many seconds the run may take, by this computer's clock or the link's, whichever ends it first.
    reconnect: for how many seconds a board that goes away may stay away; by default its going away ends the run.
    retry_limit: how many packets may be sent again: 16, and this percentage of all sent; by default 5.
    take_over: take the board over from another host that holds it.
    require_hardware: refuse to judge anything but hardware.
    report: a folder for report.json, report.xml (JUnit) and report.html.
    record: a file for every byte of the run with its time, for replay:FILE. If it or `report` cannot be written in the end, that
        raises nothing: a PASS becomes an ERROR, and under any other verdict `lacks` of the returned report says it.
    overwrite: replace what an earlier run has written.
    progress: a function that is called in this thread with ("step", name, 0), ("rows-expected", "", rows), ("frame", name, 0),
        ("rows", "", rows that came back since the last call) and ("done", "", 0); an exception from it ends the run. The names of
        steps are judge, open, link, at-speed, rules, look-again and wait, and more may come.

    Python's lock is released. Ctrl-C, or any signal handler that raises, ends the run, gives the board back, and then raises
    here. A second one raises at once, while the run gives the board back in the background.
    Raises InputError if the call is wrong or does not fit the board, and HalfrowError if no board could be opened: that error has a
    report, too, which is also written into the folder `report`.
    """
    options: Dict[str, object] = {
        "tables": tables,
        "kernel": kernel,
        "frames": _several(frames),
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
        "arguments": [str(word).encode(errors="replace").decode() for word in getattr(sys, "argv", ())],
        "report": report,
        "record": record,
        "overwrite": overwrite,
        "progress": progress,
    }
    defaults = (verify.__kwdefaults__ or {}).items()
    options["given"] = [name for name, default in defaults if _says_else(options[name], default)]
    run, not_begun = _run(board, options)
    found = _report.of(run)
    if not_begun is None:
        return found
    if isinstance(not_begun, HalfrowError):
        not_begun.report = found
    raise not_begun


def _several(frames: object) -> object:
    """The frames as a tuple. What holds no frames stays as it is, and is refused with the other options."""
    if isinstance(frames, (str, bytes, bytearray, os.PathLike)) or isinstance(frames, np.ndarray) and frames.ndim <= 2:
        return (frames,)
    return tuple(frames) if isinstance(frames, Iterable) else frames


def _says_else(value: object, default: object) -> bool:
    if default is None:
        return value is not None
    differs = value != default
    # For an array this is an array, and it is no value that an option takes.
    return bool(differs) if isinstance(differs, (bool, np.bool_)) else True
