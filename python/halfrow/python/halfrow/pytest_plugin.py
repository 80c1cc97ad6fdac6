"""The pytest plugin: a board for tests, and what halfrow found attached to those that fail.

    def test_the_board(halfrow_board):
        assert halfrow_board.verify(at_speed=10).passed

`pytest --halfrow-board serial:/dev/ttyUSB1 --halfrow-report reports` judges that board instead of the mock, and keeps the reports of
failing tests.
"""
from __future__ import annotations

import contextlib
import hashlib
import pathlib
import re
from typing import Any, Generator, List, Optional

import pytest

from . import HalfrowError, Report, verify

_REPORTS = pytest.StashKey[List[Report]]()
# The files of a report.
_FILES = ("report.html", "report.json", "report.xml")
# In the folder of --halfrow-report: what was kept there, a name a line.
_LIST = ".halfrow-kept"
# Characters of a test's id that its folder's name has of it. File systems take 255 bytes, and a character may have three.
_LENGTH = 75


class JudgedBoard:
    """The board of a test. Every report is kept until the test is over."""

    def __init__(self, target: str, reports: List[Report]) -> None:
        self.target = target
        """As --halfrow-board names it."""
        self.reports = reports
        """What was found so far, the first first."""

    def verify(self, **options: Any) -> Report:
        """Judges the board; the options are those of halfrow.verify."""
        report = verify(self.target, **options)
        self.reports.append(report)
        return report


class _Folder:
    """Where the reports of failing tests are kept, each test's in a folder of its own."""

    def __init__(self, named: str, beside: pathlib.Path) -> None:
        self.named = pathlib.Path(named)
        # A test may leave the folder that pytest was called in.
        self.place = beside / named

    def begin(self) -> None:
        """Removes what an earlier run has kept."""
        with contextlib.suppress(FileNotFoundError, NotADirectoryError):
            for name in (self.place / _LIST).read_text("utf-8").splitlines():
                self._clear(name)
            (self.place / _LIST).unlink()

    def clear(self, item: pytest.Item) -> None:
        """Removes what an earlier try of the test has kept."""
        self._clear(_folder_name(item.nodeid))

    def keep(self, item: pytest.Item, number: int, report: Report) -> str:
        """Keeps the report, and says where."""
        name = _folder_name(item.nodeid)
        place = self.place / name / str(number)
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            with (self.place / _LIST).open("a", encoding="utf-8") as kept:
                kept.write(f"{name}\n")
            report.save(place, overwrite=True)
        except (HalfrowError, OSError) as error:
            return f"\nThe report is not kept: {error}"
        return f"\nreport: {self.named / name / str(number)}"

    def _clear(self, name: str) -> None:
        # Nothing that somebody else has put there.
        reports = [place for place in (self.place / name).glob("*") if place.name.isdecimal() and place.is_dir()]
        for place in reports:
            for file in _FILES:
                (place / file).unlink(missing_ok=True)
        for place in [*reports, self.place / name]:
            with contextlib.suppress(OSError):
                place.rmdir()


_FOLDER = pytest.StashKey[Optional[_Folder]]()


def _folder_name(test: str) -> str:
    """A name that no other test has: of all that a file system takes of this one's, and a hash."""
    readable = re.sub(r"[^\w.-]+", "-", test).strip("-")[-_LENGTH:]
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
    config.stash[_FOLDER] = None if named is None else _Folder(named, config.invocation_params.dir)


def pytest_sessionstart(session: pytest.Session) -> None:
    folder = session.config.stash[_FOLDER]
    # A worker of pytest-xdist begins when others may have kept something.
    if folder is None or session.config.getoption("collectonly") or hasattr(session.config, "workerinput"):
        return
    try:
        folder.begin()
    except OSError as error:
        raise pytest.UsageError(f"the reports of an earlier run cannot be removed: {error}; name another --halfrow-report") from error


@pytest.fixture
def halfrow_board(request: pytest.FixtureRequest) -> JudgedBoard:
    """The board that --halfrow-board names; what is found is attached to the test if it fails."""
    folder = request.config.stash[_FOLDER]
    if folder is not None:
        folder.clear(request.node)
    # A test that is tried again begins anew.
    reports: List[Report] = []
    request.node.stash[_REPORTS] = reports
    return JudgedBoard(request.config.getoption("--halfrow-board"), reports)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, Any, None]:
    outcome = yield
    told = outcome.get_result()
    if not told.failed:
        return
    folder = item.config.stash[_FOLDER]
    reports: List[Report] = item.stash.get(_REPORTS, [])
    for number, report in enumerate(reports):
        kept = "" if folder is None else folder.keep(item, number, report)
        told.sections.append((f"halfrow: {report.verdict} of {report.board.target}", report.text + kept))
