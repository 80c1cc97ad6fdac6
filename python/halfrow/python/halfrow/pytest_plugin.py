"""The pytest plugin: a board for tests, and what halfrow found attached to those that fail.

    def test_the_board(halfrow_board):
        assert halfrow_board.verify(at_speed=10).passed

`pytest --halfrow-board serial:/dev/ttyUSB1 --halfrow-report reports` judges that board instead of the mock, and keeps the reports of
failing tests.
"""
from __future__ import annotations

import pathlib
import re
from typing import Any, Generator, List

import pytest

from . import HalfrowError, Report, verify

_REPORTS = pytest.StashKey[List[Report]]()


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


@pytest.fixture
def halfrow_board(request: pytest.FixtureRequest) -> JudgedBoard:
    """The board that --halfrow-board names; what is found is attached to the test if it fails."""
    reports = request.node.stash.setdefault(_REPORTS, [])
    return JudgedBoard(request.config.getoption("--halfrow-board"), reports)


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, Any, None]:
    outcome = yield
    told = outcome.get_result()
    if not told.failed:
        return
    reports: List[Report] = item.stash.get(_REPORTS, [])
    for number, report in enumerate(reports):
        text = report.text + _kept(item, number, report)
        told.sections.append((f"halfrow: {report.verdict} of {report.board.target}", text))


def _kept(item: pytest.Item, number: int, report: Report) -> str:
    """Keeps the report in a folder if that is asked for, and says where."""
    folder = item.config.getoption("--halfrow-report")
    if folder is None:
        return ""
    place = pathlib.Path(folder) / re.sub(r"[^\w.-]+", "-", item.nodeid).strip("-") / str(number)
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        report.save(place, overwrite=True)
    except (HalfrowError, OSError) as error:
        return f"\nThe report is not kept: {error}"
    return f"\nreport: {place}"
