"""The pytest plugin: a board for tests, with halfrow's reports attached to tests that fail.

    def test_the_board(halfrow_board):
        assert halfrow_board.verify(at_speed=10).passed

`pytest --halfrow-board serial:/dev/ttyUSB1 --halfrow-report reports` judges that board instead of the mock, and keeps the reports
of failing tests.
"""
from __future__ import annotations

import contextlib
import hashlib
import pathlib
import re
from typing import TYPE_CHECKING, Any, Callable, Dict, Generator, List, Optional, Set

import pytest

from . import HalfrowError, Report, verify

# Attributes of tests and of the configuration. Before pytest 7 neither has a stash, and a plugin that cannot be imported would
# end every run, also of those who do not use it.
_REPORTS = "_halfrow_reports"
_PHASES = "_halfrow_phases"
_FOLDER = "_halfrow_folder"
# The files of a report.
_FILES = ("report.html", "report.json", "report.xml")
# A file in the folder of --halfrow-report that lists what was kept there, one name per line.
_LIST = ".halfrow-kept"
# How many bytes of a test's id go into its folder's name. File systems take 255, and a hash comes behind them.
_LENGTH = 240


if TYPE_CHECKING:
    from typing_extensions import Concatenate, ParamSpec

    _Options = ParamSpec("_Options")


def _takes_options_of(
    judge: Callable[Concatenate[str, _Options], Report],
) -> Callable[[Callable[..., Report]], Callable[Concatenate[JudgedBoard, _Options], Report]]:
    """Types a method that hands its options on to `judge`."""
    return lambda method: method


class JudgedBoard:
    """The board of a test. Every report is kept until the test has ended."""

    def __init__(self, target: str, reports: List[Report]) -> None:
        self.target = target
        """The target that --halfrow-board names."""
        self.reports = reports
        """The reports so far, the oldest first."""

    @_takes_options_of(verify)
    def verify(self, **options: Any) -> Report:
        """Judges the board; the options are those of halfrow.verify."""
        try:
            report = verify(self.target, **options)
        except HalfrowError as error:
            if error.report is not None:
                self.reports.append(error.report)
            raise
        self.reports.append(report)
        return report


class _Phase:
    """Which reports a phase of a test has shown. Each of its subtests ends and fails by itself, and the test itself ends last."""

    def __init__(self) -> None:
        self.ended = 0
        self.shown: Set[int] = set()

    def shows(self, failed: bool, count: int) -> List[int]:
        """Which of so many reports the test or subtest shows that has just ended."""
        left = [number for number in range(count) if number not in self.shown]
        own = [number for number in left if number >= self.ended]
        self.ended = count
        if not failed:
            return []
        # A subtest that has judged nothing itself is about what was judged before it.
        numbers = own or left
        self.shown.update(numbers)
        return numbers


class _Folder:
    """The folder in which the reports of failing tests are kept, each test's in a folder of its own."""

    def __init__(self, named: str, beside: pathlib.Path) -> None:
        self.named = pathlib.Path(named)
        # Absolute, since a test may change the working directory.
        self.place = beside / named

    def begin(self) -> None:
        """Removes the reports of an earlier run."""
        with contextlib.suppress(FileNotFoundError, NotADirectoryError):
            for name in (self.place / _LIST).read_text("utf-8").splitlines():
                self._clear(name)
            (self.place / _LIST).unlink()

    def clear(self, item: pytest.Item) -> None:
        """Removes the reports of an earlier try of the test."""
        self._clear(_folder_name(item.nodeid))

    def keep(self, item: pytest.Item, number: int, report: Report) -> str:
        """Keeps the report, and returns a line that says where."""
        name = _folder_name(item.nodeid)
        place = self.place / name / str(number)
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            with (self.place / _LIST).open("a", encoding="utf-8") as kept:
                kept.write(f"{name}\n")
            report.save(place, overwrite=True)
        # A report without its run, such as a test's copy of one, is a ValueError.
        except (HalfrowError, OSError, ValueError) as error:
            return f"\nThe report is not kept: {error}"
        return f"\nreport: {self.named / name / str(number)}"

    def _clear(self, name: str) -> None:
        # Leaves what others have put there.
        reports = [place for place in (self.place / name).glob("*") if place.name.isdecimal() and place.is_dir()]
        for place in reports:
            for file in _FILES:
                (place / file).unlink(missing_ok=True)
        for place in [*reports, self.place / name]:
            with contextlib.suppress(OSError):
                place.rmdir()


def _folder_name(test: str) -> str:
    """A folder name that no other test has: as much of the test's id as a file system takes, and a hash."""
    readable = re.sub(r"[^\w.-]+", "-", test).strip("-").encode()[-_LENGTH:].decode(errors="ignore")
    return f"{readable}-{hashlib.sha256(test.encode(errors='surrogatepass')).hexdigest()[:8]}"


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("halfrow", "boards that halfrow judges")
    group.addoption(
        "--halfrow-board",
        metavar="TARGET",
        default="mock",
        help="the board of the fixture halfrow_board, as `halfrow verify --board` has it [default: mock]",
    )
    group.addoption(
        "--halfrow-report",
        metavar="FOLDER",
        help="keep the reports (JSON, JUnit, HTML) of failing tests in FOLDER, in place of those of an earlier run",
    )


def pytest_configure(config: pytest.Config) -> None:
    named = config.getoption("--halfrow-report")
    # Fixtures may be set up without a test that runs; --setup-plan also sets this option.
    runs_none = config.getoption("collectonly") or config.getoption("setuponly", False)
    setattr(config, _FOLDER, None if named is None or runs_none else _Folder(named, config.invocation_params.dir))


def _folder_of(config: pytest.Config) -> Optional[_Folder]:
    return getattr(config, _FOLDER, None)


# Not when the session starts: one that shows fixtures, say, runs no tests.
@pytest.hookimpl(tryfirst=True)
def pytest_runtestloop(session: pytest.Session) -> None:
    config = session.config
    folder = _folder_of(config)
    # When a worker of pytest-xdist begins, others may already have kept reports.
    if folder is None or hasattr(config, "workerinput"):
        return
    # No test is run then.
    if session.testsfailed and not config.getoption("continue_on_collection_errors", False):
        return
    # The session of pytest-xdist which hands tests out has collected none itself, and before pytest 7 has no list of them.
    if not config.pluginmanager.hasplugin("dsession") and not session.items:
        return
    try:
        folder.begin()
    except OSError as error:
        raise pytest.UsageError(f"the reports of an earlier run cannot be removed: {error}; name another --halfrow-report") from error


@pytest.fixture
def halfrow_board(request: pytest.FixtureRequest) -> JudgedBoard:
    """The board that --halfrow-board names. Its reports are attached to the test if that fails."""
    folder = _folder_of(request.config)
    if folder is not None:
        folder.clear(request.node)
    # A test that is tried again begins without reports.
    reports: List[Report] = []
    setattr(request.node, _REPORTS, reports)
    setattr(request.node, _PHASES, {})
    return JudgedBoard(request.config.getoption("--halfrow-board"), reports)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, None, None]:
    yield
    # The test itself ends next, and what its subtests have not shown is its own.
    phases: Dict[str, _Phase] = getattr(item, _PHASES, {})
    phases.setdefault("call", _Phase()).ended = 0


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, Any, None]:
    outcome = yield
    told = outcome.get_result()
    reports: List[Report] = getattr(item, _REPORTS, [])
    phases: Dict[str, _Phase] = getattr(item, _PHASES, {})
    numbers = phases.setdefault(told.when, _Phase()).shows(told.failed, len(reports))
    folder = _folder_of(item.config)
    for number in numbers:
        report = reports[number]
        kept = "" if folder is None else folder.keep(item, number, report)
        told.sections.append((f"halfrow: {report.verdict} of {report.board.target}", report.text + kept))
