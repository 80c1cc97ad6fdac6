"""The exceptions: the library's errors with their codes."""
from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Dict, Optional, Tuple

if TYPE_CHECKING:
    from ._report import Report


@dataclass(frozen=True)
class Problem:
    """Why something could not be done, or what led to it."""

    code: str
    """Its code: stable, for programs. docs/CODES.md lists all."""
    parameters: Dict[str, Any]
    """Its figures and names."""
    message: str
    """What is wrong, in one sentence."""
    remedy: Optional[str]
    """What to do about it, if that is known."""


class HalfrowError(Exception):
    """Something could not be done. Its text is its message, followed by those of its causes."""

    code: str
    """Its code: stable, for programs; the same as on the command line."""
    parameters: Dict[str, Any]
    """Its figures and names."""
    message: str
    """What is wrong, in one sentence, without its causes."""
    remedy: Optional[str]
    """What to do about it, if that is known."""
    causes: Tuple[Problem, ...]
    """What led to it, the most direct cause first."""
    report: Optional[Report]
    """The report of a run that never began, for example because its board could not be opened; of anything else None."""

    def __init__(
        self,
        code: str,
        parameters: Dict[str, Any],
        message: str,
        remedy: Optional[str] = None,
        causes: Tuple[Problem, ...] = (),
    ) -> None:
        super().__init__(code, parameters, message, remedy, causes)
        self.code, self.parameters, self.message = code, parameters, message
        self.remedy, self.causes, self.report = remedy, causes, None

    def __str__(self) -> str:
        return ": ".join([self.message, *(cause.message for cause in self.causes)])

    @classmethod
    def _of_json(cls, told: str) -> HalfrowError:
        problem: Dict[str, Any] = json.loads(told)
        causes = problem.pop("causes")
        return cls(**problem, causes=tuple(_cause(**cause) for cause in causes))


def _cause(causes: object, **problem: Any) -> Problem:
    # Causes are a flat list, and have no causes of their own.
    return Problem(**problem)


class InputError(HalfrowError, ValueError):
    """The call, or a file that it names, is wrong. The command line then ends with exit code 2."""
