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
    """What was found, as a code with parameters; docs/CODES.md lists all."""

    code: str
    parameters: Dict[str, Any]


@dataclass(frozen=True)
class Identity:
    """What a board says of itself."""

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
    """Bits of a sample that it takes."""
    taps: int
    """5 or 7."""
    latency: int
    """L: pixel clocks beyond half a row."""
    ring: int
    """M: samples of its line memory."""
    clock_hz: int
    """Its pixel clock; 0 when it stands for no real time."""


@dataclass(frozen=True)
class Board:
    """Which board it was."""

    kind: str
    """mock, sim, replay or hardware."""
    target: str
    identity: Optional[Identity]
    """None when it never answered."""


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
    """Where to look in the design."""
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
    """How a frame compares with what the model makes of it."""

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
    """Of its samples, 16 bits little endian."""
    phase: str
    generation: int
    comparison: Comparison
    rows: int
    """Rows that came back."""
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
    """How far the façades' edges of the built-in street are from straight, in pixels."""

    edges: int
    mean_px: float
    max_px: float


@dataclass(frozen=True)
class Street:
    """The built-in street's edges, as the lens bends them and as the board leaves them."""

    before: EdgeDeviation
    after: EdgeDeviation


@dataclass(frozen=True)
class NotExercised:
    """Something that the frames of a PASS did not put to the test."""

    code: str
    parameters: Dict[str, Any]
    words: str


@dataclass(frozen=True)
class Coverage:
    """What the run finds of the single faults of the Verilog that were measured."""

    found: int
    faults: int
    equivalent: int
    """Faults more that are proven to make no difference."""


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
    """Of the link's clock."""


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
    """Of the wall's clock."""
    host: str
    files: Tuple[File, ...]


@dataclass(frozen=True)
class Report:
    """What a run of verify found."""

    verdict: str
    """PASS: everything was judged, all of it equal. FAIL: the link was clean and the board differs. ERROR: not judged."""
    cause: str
    """Why the verdict is what it is: equal, different, station, busy, refused, nothing-judged or stopped-by-…"""
    headline: str
    """The result in one sentence."""
    remedy: Optional[str]
    """What to do next; None under PASS."""
    technician: Optional[str]
    """What a technician does with a board that is wrong; None under PASS and ERROR."""
    finding: Finding
    """The result as a code."""
    error: Optional[Problem]
    """Why there is no judgement; None under PASS and FAIL."""
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
    """The verdict, every check, who is suspected and what to do: a line each."""
    document: Dict[str, Any] = field(repr=False, compare=False, default_factory=dict)
    """All of it, as `halfrow schema` describes the result of verify."""
    # What the process that made the run has beside it; no field, since it is no data.
    _run: ClassVar[Optional[_halfrow.Run]] = None

    @property
    def passed(self) -> bool:
        """Whether everything was judged, and all of it equal."""
        return self.verdict == "PASS"

    def save(self, folder: Union[str, os.PathLike[str]], *, overwrite: bool = False) -> None:
        """Writes report.json, report.xml (JUnit) and report.html into `folder`, which must not be there unless `overwrite`.

        Only in the process that made the run, which alone has its frames.
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
    """The report of a run that is over."""
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
    if value is None:
        return None
    if get_origin(hint) is Union:
        return _value(get_args(hint)[0], value)
    if get_origin(hint) is tuple:
        return tuple(_value(get_args(hint)[0], item) for item in value)
    return _made(hint, value) if dataclasses.is_dataclass(hint) else value
