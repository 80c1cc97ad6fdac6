"""What halfrow said of a board, and what is raised when that is no PASS."""
from __future__ import annotations

import json
from typing import Any, Dict, Tuple, Type

import attr


@attr.s(auto_attribs=True, frozen=True)
class Report:
    """The result of `halfrow verify`, as its JSON tells it."""

    verdict: str
    """PASS, FAIL or ERROR."""
    exit_code: int
    """halfrow's exit code; its README lists them."""
    code: str
    """What was found, by a code of halfrow's docs/CODES.md; empty where it has none."""
    headline: str
    """What was found, in one sentence."""
    remedy: str
    """What to do about it; empty where there is nothing to do."""
    suspects: Tuple[str, ...]
    """What may be broken, the most likely first."""
    document: Dict[str, Any] = attr.ib(repr=False)
    """All of it, as `halfrow schema` describes it."""

    def __str__(self) -> str:
        return f"{self.verdict}: {self.headline}" + (f". {self.remedy}" if self.remedy else "")


class HalfrowError(Exception):
    """halfrow came to no PASS; `report` says to what."""

    def __init__(self, report: Report) -> None:
        super().__init__(str(report))
        self.report = report


class BoardFailed(HalfrowError):
    """FAIL: the link was clean, and the board is wrong."""


class NotJudged(HalfrowError):
    """ERROR: the board could not be judged; the link, the station or the time was in the way."""


class WrongCall(HalfrowError):
    """The call or its input was wrong, and the board was not touched."""


RAISED: Dict[int, Type[HalfrowError]] = {1: BoardFailed, 2: WrongCall}


def error(headline: str, remedy: str) -> NotJudged:
    """An ERROR of which halfrow itself could not tell."""
    return NotJudged(Report("ERROR", 3, "", headline, remedy, (), {}))


def wrong_call(headline: str, remedy: str) -> WrongCall:
    """A call that halfrow did not even get."""
    return WrongCall(Report("ERROR", 2, "", headline, remedy, (), {}))


def read(exit_code: int, said: str) -> Report:
    """The report of a halfrow that ended with `exit_code` and printed `said`.

    Raises HalfrowError for all but PASS. What does not read as a PASS is none, whatever the exit code.
    """
    try:
        document = json.loads(said)
        report = of(document)
    except (AttributeError, KeyError, TypeError, ValueError) as unreadable:
        raise error(f"halfrow ended with {exit_code} and printed no result", "Run the same command by hand.") from unreadable
    if report.exit_code != exit_code:
        raise error(f"halfrow ended with {exit_code}, and its result says {report.exit_code}", "Run the same command by hand.")
    if exit_code == 0 and report.verdict == "PASS":
        return report
    raise RAISED.get(exit_code, NotJudged)(report)


def of(document: Dict[str, Any]) -> Report:
    # Without a result there is an error instead, which has a message for a headline.
    told = document["error"] or document.get("finding") or {}
    headline = document.get("headline") or told.get("message") or ""
    remedy = document.get("remedy") or told.get("remedy") or ""
    # A message ends in what to do.
    remedy = "" if document["error"] else remedy
    suspects = tuple(suspect["place"] for suspect in document.get("suspects") or ())
    verdict = document["verdict"] or "ERROR"
    return Report(verdict, document["exit_code"], told.get("code") or "", headline, remedy, suspects, document)
