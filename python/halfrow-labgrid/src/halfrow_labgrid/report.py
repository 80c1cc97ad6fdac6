"""What halfrow reported about a board, and the exceptions for anything but PASS."""
from __future__ import annotations

import json
from typing import Any, Dict, Tuple, Type

import attr


@attr.s(auto_attribs=True, frozen=True)
class Report:
    """The result of `halfrow verify`, from its JSON."""

    verdict: str
    """PASS, FAIL or ERROR."""
    exit_code: int
    """halfrow's exit code; its README lists them."""
    code: str
    """What was found, as a code of halfrow's docs/CODES.md; empty if it has none."""
    headline: str
    """What was found, in one sentence."""
    remedy: str
    """What to do about it; empty if there is nothing to do."""
    suspects: Tuple[str, ...]
    """The parts that may be broken, the most likely first."""
    document: Dict[str, Any] = attr.ib(repr=False)
    """The whole result, as `halfrow schema` describes it."""

    def __str__(self) -> str:
        return f"{self.verdict}: {self.headline}" + (f". {self.remedy}" if self.remedy else "")


class HalfrowError(Exception):
    """The result is not PASS; `report` says what it is."""

    def __init__(self, report: Report) -> None:
        super().__init__(str(report))
        self.report = report


class BoardFailed(HalfrowError):
    """FAIL: the link was clean, and the board is wrong."""


class NotJudged(HalfrowError):
    """ERROR: the board could not be judged, because of the link, the station or the time."""


class WrongCall(HalfrowError):
    """The call or its input was wrong; the board was not touched."""


RAISED: Dict[int, Type[HalfrowError]] = {1: BoardFailed, 2: WrongCall}


def error(headline: str, remedy: str) -> NotJudged:
    """An ERROR that halfrow itself could not report."""
    return NotJudged(Report("ERROR", 3, "", headline, remedy, (), {}))


def wrong_call(headline: str, remedy: str) -> WrongCall:
    """A wrong call that never reached halfrow."""
    return WrongCall(Report("ERROR", 2, "", headline, remedy, (), {}))


def read(exit_code: int, said: str) -> Report:
    """The report of a halfrow that ended with `exit_code` and printed `said`.

    Raises HalfrowError for everything but PASS. Output that does not read as a PASS is none, whatever the exit code.
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
    # Without a result there is an error instead, whose message serves as the headline, with those of its causes.
    told = document["error"] or document.get("finding") or {}
    messages = [told.get("message") or "", *(cause["message"] for cause in told.get("causes") or ())]
    headline = document.get("headline") or ": ".join(messages)
    remedy = document.get("remedy") or told.get("remedy") or ""
    # The message of an error ends in what to do.
    remedy = "" if document["error"] else remedy
    suspects = tuple(suspect["place"] for suspect in document.get("suspects") or ())
    verdict = document["verdict"] or "ERROR"
    return Report(verdict, document["exit_code"], told.get("code") or "", headline, remedy, suspects, document)


def info(said: str) -> Dict[str, Any]:
    """What `halfrow info` printed about a board. Raises NotJudged if that does not read as such."""
    try:
        return dict(json.loads(said).items())
    except (AttributeError, ValueError) as unreadable:
        raise error("halfrow ended with 0 and printed nothing about the board", "Run the same command by hand.") from unreadable
