"""What a run of verify found, as data."""
from __future__ import annotations

import dataclasses
import functools
import json
import os
from dataclasses import dataclass, field
from typing import Any, ClassVar, Dict, Optional, Tuple, Union, get_args, get_origin, get_type_hints

from . import _halfrow
from ._errors import Problem


@dataclass(frozen=True)
class Finding:
    """What was found, as a code with parameters; docs/CODES.md lists all codes."""

    code: str
    parameters: Dict[str, Any]


@dataclass(frozen=True)
class Identity:
    """What a board reports about itself."""

    name: str
    serial: str
    """16 hexadecimal digits."""
    build: str
    """The commit of its build, 8 hexadecimal digits."""
    protocol: int
    datapath: int
    max_width: int
    max_height: int
    depths: Tuple[int, ...]
    """The bits per sample that it takes."""
    taps: int
    """5 or 7."""
    latency: int
    """L: pixel clocks beyond half a row."""
    ring: int
    """M: samples that its line memory holds."""
    clock_hz: int
    """The frequency of its pixel clock; 0 if it is not known."""


@dataclass(frozen=True)
class Board:
    """The board that was judged."""

    kind: str
    """mock, sim, replay or hardware."""
    target: str
    identity: Optional[Identity]
    """None if it never answered."""


@dataclass(frozen=True)
class Check:
    """One thing that was checked."""

    name: str
    outcome: str
    """passed, failed, error or skipped."""
    detail: str
    """What was seen, in one sentence."""
    finding: Finding
    seconds: float


@dataclass(frozen=True)
class Suspect:
    """A part that the pattern of differences points at."""

    defect: Finding
    explained: float
    """The share of the differing samples or words that it explains, 0 to 1."""
    part: str
    place: str
    evidence: str
    designer: str
    """Where to look in the design of the board."""
    technician: str
    """What to do with the board."""


@dataclass(frozen=True)
class Difference:
    """A sample that differs."""

    row: int
    column: int
    expected: int
    found: int


@dataclass(frozen=True)
class Comparison:
    """How a frame from the board compares with the model's."""

    samples: int
    differences: int
    first: Optional[Difference]
    largest: int


@dataclass(frozen=True)
class Frame:
    """One frame that was streamed."""

    name: str
    """builtin:NAME, the file's path, or frames[N] for an array."""
    number: int
    sha256: str
    """The hash of its samples, as 16-bit little-endian words."""
    phase: str
    generation: int
    comparison: Comparison
    rows: int
    """How many rows came back."""
    seconds: float


@dataclass(frozen=True)
class Latency:
    """How long rows took, in pixel clocks."""

    claimed: int
    limit: int
    least: int
    most: int
    rows: int
    wrong_rows: int


@dataclass(frozen=True)
class EdgeDeviation:
    """How far the edges of the façades in the built-in street deviate from straight lines, in pixels."""

    edges: int
    mean_px: float
    max_px: float


@dataclass(frozen=True)
class Street:
    """The edges of the built-in street, as the lens bends them and as the board leaves them."""

    before: EdgeDeviation
    after: EdgeDeviation


@dataclass(frozen=True)
class NotExercised:
    """Something that the frames of a PASS did not test."""

    code: str
    parameters: Dict[str, Any]
    words: str


@dataclass(frozen=True)
class Coverage:
    """How many of the measured single faults of the Verilog such a run finds."""

    found: int
    faults: int
    equivalent: int
    """How many further faults are proven to make no difference."""


@dataclass(frozen=True)
class Link:
    """What the link carried."""

    name: str
    bytes_out: int
    bytes_in: int
    packets_out: int
    packets_in: int
    damaged_in: int
    damaged_out: int
    retries: int
    round_trip_us: Optional[int]
    seconds: float
    """By the link's clock."""


@dataclass(frozen=True)
class TablesUsed:
    """What was uploaded."""

    source: str
    width: int
    height: int
    bits: int
    centre2: int
    """Twice the column of the optical centre."""
    rows_outside_circle: Optional[int]


@dataclass(frozen=True)
class File:
    """A file that was read."""

    path: str
    sha256: str


@dataclass(frozen=True)
class Facts:
    """The run itself: enough to repeat it."""

    version: str
    commit: str
    arguments: Tuple[str, ...]
    seed: int
    started: str
    """RFC 3339, UTC."""
    ended: str
    seconds: float
    """By this computer's clock."""
    host: str
    files: Tuple[File, ...]


@dataclass(frozen=True)
class Report:
    """What a run of verify found."""

    verdict: str
    """PASS: everything was judged and is equal. FAIL: the link was clean and the board differs. ERROR: not judged."""
    cause: str
    """Why the verdict is what it is: equal, different, station, busy, refused, nothing-judged or stopped-by-…"""
    headline: str
    """The result in one sentence."""
    remedy: Optional[str]
    """What to do next; None for PASS."""
    technician: Optional[str]
    """What a technician should do with a wrong board; None for PASS and ERROR."""
    finding: Finding
    """The result as a code."""
    error: Optional[Problem]
    """Why there is no judgement; None for PASS and FAIL."""
    lacks: Tuple[Problem, ...]
    """What was asked for and could not be written, under FAIL and ERROR. A PASS without it is an ERROR, and `error` says it."""
    board: Board
    suspects: Tuple[Suspect, ...]
    """The parts that the pattern of differences points at, the likeliest first."""
    checks: Tuple[Check, ...]
    frames: Tuple[Frame, ...]
    not_exercised: Tuple[NotExercised, ...]
    latency: Optional[Latency]
    street: Optional[Street]
    coverage: Optional[Coverage]
    link: Link
    tables: TablesUsed
    run: Facts
    text: str = field(repr=False, default="")
    """The verdict, every check, the suspects, and what to do: one line each."""
    document: Dict[str, Any] = field(repr=False, compare=False, default_factory=dict)
    """The whole result, as `halfrow schema` describes it for verify."""
    # The run itself, which only the process that made it has. Not a field, since it is not data.
    _run: ClassVar[Optional[_halfrow.Run]] = None

    @property
    def passed(self) -> bool:
        """Whether everything was judged and is equal."""
        return self.verdict == "PASS"

    def save(self, folder: Union[str, os.PathLike[str]], *, overwrite: bool = False) -> None:
        """Writes report.json, report.xml (JUnit) and report.html into `folder`, which must not exist unless `overwrite`.

        Works only in the process that made the run, since no other has its frames. Frames that were equal are not kept unless
        verify was given `report`, so the page has pictures only of others.
        """
        if self._run is None:
            raise ValueError(
                "the frames of this report's run are not with it: it has left the process of its run, or was changed; save "
                "the report that verify returned, in its process"
            )
        self._run.save(folder, overwrite)

    def __str__(self) -> str:
        return self.text


def of(run: _halfrow.Run) -> Report:
    """The report of a finished run."""
    document = json.loads(run.json())
    found: Report = _made(Report, document)
    report = dataclasses.replace(found, text=run.text(), document=document)
    object.__setattr__(report, "_run", run)
    return report


@functools.lru_cache(maxsize=None)
def _hints(kind: Any) -> Dict[str, Any]:
    own = {name for name in kind.__annotations__ if name not in ("text", "document", "_run")}
    return {name: hint for name, hint in get_type_hints(kind).items() if name in own}


def _made(kind: Any, values: Dict[str, Any]) -> Any:
    return kind(**{name: _value(hint, values.get(name)) for name, hint in _hints(kind).items()})


def _value(hint: Any, value: Any) -> Any:
    if get_origin(hint) is tuple:
        # The document leaves out what holds nothing.
        return tuple(_value(get_args(hint)[0], item) for item in value or ())
    if value is None:
        return None
    if get_origin(hint) is Union:
        return _value(get_args(hint)[0], value)
    return _made(hint, value) if dataclasses.is_dataclass(hint) else value
