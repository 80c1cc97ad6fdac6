"""The states of a board that is judged: off, on, judged."""
from __future__ import annotations

import enum
from typing import Optional, Union

import attr
from labgrid import target_factory
from labgrid.step import step
from labgrid.strategy import Strategy, StrategyError

from .report import Report


class Status(enum.Enum):
    """How far a board has come."""

    unknown = 0
    off = 1
    on = 2
    judged = 3


def named(status: Union[Status, str]) -> Status:
    """`status`, which may be given by its name."""
    return Status[status] if isinstance(status, str) else status


@target_factory.reg_driver
@attr.s(eq=False)
class HalfrowStrategy(Strategy):
    """Takes a board from one state to another. With a driver of labgrid's PowerProtocol it also switches the power.

    `off` cuts the power; `on` switches it on and waits until the board answers; `judged` judges the board and keeps the report. A
    judged board is judged again only after it was on or off in between. Anything but PASS is raised, and leaves the board on. A
    transition that fails midway leaves the status `unknown`, from which the next one goes through all states.

    Args:
        patience (float): how long a board may take to answer when it is on, in seconds
    """

    bindings = {"halfrow": "HalfrowDriver", "power": {"PowerProtocol", None}}

    patience: float = attr.ib(default=30.0, converter=float)
    status: Status = attr.ib(default=Status.unknown, converter=named)
    report: Optional[Report] = attr.ib(default=None, init=False)
    """The report of the board, if it is judged."""

    @step(args=["status"])
    def transition(self, status: Union[Status, str], *, step: object = None) -> None:
        """Takes the board to `status`, through all states in between."""
        wanted = named(status)
        if wanted is Status.unknown:
            raise StrategyError("nothing leads to `unknown`; ask for off, on or judged")
        if wanted is self.status:
            return
        self.report = None
        # If a transition fails midway, it is not known how far the board has come, and the next one goes through all states.
        was, self.status = self.status, Status.unknown
        if wanted is Status.off:
            self._off()
        elif was in (Status.unknown, Status.off):
            self._on()
        if wanted is Status.judged:
            self.status = Status.on
            self.report = self.halfrow.verify()
        self.status = wanted

    def force(self, status: Union[Status, str]) -> None:
        """Assumes that the board has `status`, without touching it. There is no report then."""
        forced, self.report = named(status), None
        if forced in (Status.on, Status.judged):
            self.target.activate(self.halfrow)
        self.status = forced

    def _off(self) -> None:
        self.target.deactivate(self.halfrow)
        if self.power:
            self.target.activate(self.power)
            self.power.off()

    def _on(self) -> None:
        if self.power:
            self.target.activate(self.power)
            self.power.on()
        self.target.activate(self.halfrow)
        self.halfrow.wait(self.patience)
