"""A driver that lets halfrow judge the board at a serial port."""
from __future__ import annotations

import contextlib
import re
import subprocess
import time
from typing import Any, Dict, Iterator, List, Mapping

import attr
from labgrid import target_factory
from labgrid.driver import Driver
from labgrid.resource import SerialPort
from labgrid.step import step
from labgrid.util.proxy import proxymanager

from .report import Report, error, info, read, wrong_call

# How long halfrow itself may take beyond the time of a run, in seconds.
GRACE = 30.0
# How long halfrow may take to give a board back, in seconds.
ENDING = 5.0
LOOK = 0.5
# The exit code of a wrong call, which waiting for the board does not help.
CALL_WRONG = 2
OPTION = re.compile(r"[a-z][a-z-]*")
# The options that the driver sets itself.
OWN = {"board", "json", "timeout"}


@target_factory.reg_driver
@attr.s(eq=False)
class HalfrowDriver(Driver):
    """Judges the board at a serial port with the program `halfrow`: that of `tools: {halfrow: PATH}`, or the one the shell finds.

    Args:
        options (dict): options of `halfrow verify` for every call, without the leading `--`, as in
            `{radius: 10.0, frame: [a.pgm, b.pgm]}`
        timeout (float): the longest that a run may take, in seconds
    """

    bindings = {"port": {"SerialPort", "NetworkSerialPort"}}

    options: Dict[str, Any] = attr.ib(factory=dict, validator=attr.validators.instance_of(dict))
    timeout: float = attr.ib(default=600.0, converter=float)

    def __attrs_post_init__(self) -> None:
        super().__attrs_post_init__()
        env = self.target.env
        self.tool: str = env.config.get_tool("halfrow") if env else "halfrow"

    @property
    def board(self) -> str:
        """The board's target for halfrow."""
        if isinstance(self.port, SerialPort):
            return f"serial:{self.port.port},baud={self.port.speed}"
        if self.port.protocol != "raw":
            raise error(
                f"the port is exported by {self.port.protocol}, of which halfrow speaks nothing",
                "Export a NetworkSerialPort with protocol: raw.",
            )
        host, port = proxymanager.get_host_and_port(self.port)
        host = f"[{host}]" if ":" in host else host
        return f"tcp:{host}:{port},baud={self.port.speed}"

    @Driver.check_active
    @step(args=["options"], result=True)
    def verify(self, **options: Any) -> Report:
        """Judges the board. `options` are like the driver's own, which they replace.

        Returns the report of a PASS. Raises BoardFailed for FAIL, NotJudged for ERROR, and WrongCall for a call that halfrow
        refuses, each with its report.
        """
        asked = list(words({**self.options, **replaced(options)}))
        timeout = ["--timeout", str(self.timeout)]
        code, said = self._run(["verify", *timeout, *asked], self.timeout + GRACE)
        return read(code, said)

    @Driver.check_active
    @step()
    def wait(self, patience: float = 30.0) -> Dict[str, Any]:
        """Waits until the board answers, for at most `patience` seconds, and returns what `halfrow info` prints about it.

        Raises NotJudged if it does not answer, and WrongCall at once for a call that halfrow refuses.
        """
        begun = time.monotonic()
        while True:
            code, said = self._run(["info"], GRACE)
            if code == 0:
                return info(said)
            if code == CALL_WRONG or time.monotonic() - begun > patience:
                read(code, said)
            time.sleep(LOOK)

    def _run(self, asked: List[str], patience: float) -> "tuple[int, str]":
        command = [self.tool, *asked, "--json", "--quiet", "--board", self.board]
        self.logger.debug("%s", command)
        try:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        except OSError as missing:
            raise error(f"{self.tool} cannot be started ({missing.strerror})", "Name halfrow under `tools`.") from missing
        with process:
            try:
                said, _ = process.communicate(timeout=patience)
            except subprocess.TimeoutExpired as late:
                end(process)
                raise error(f"halfrow was ended after {patience} s", "Look at the board and its link.") from late
            except BaseException:
                end(process)
                raise
        return process.returncode, said


def end(process: "subprocess.Popen[str]") -> None:
    """Ends a halfrow that is still at work, first by a signal at which it gives the board back if it can."""
    process.terminate()
    try:
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.communicate(timeout=ENDING)
    finally:
        process.kill()


def replaced(options: Mapping[str, Any]) -> Dict[str, Any]:
    """The options under their names on the command line."""
    return {name.replace("_", "-"): value for name, value in options.items()}


def words(options: Mapping[str, Any]) -> Iterator[str]:
    """The words of a command line. A list gives an option several times, true without a value; false or None leaves it out.

    An empty list is refused: most likely the caller looked for something and found nothing.
    """
    for name, value in options.items():
        if not OPTION.fullmatch(name) or name in OWN:
            raise wrong_call(f"`{name}` is no option for the driver", "See `halfrow help verify`; board and timeout are the driver's.")
        if isinstance(value, (list, tuple)) and not value:
            raise wrong_call(f"{name} is an empty list", "Name at least one, or leave it out or None for what halfrow does without.")
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if one is True:
                yield f"--{name}"
            elif one is not False and one is not None:
                # As one word, so that a value may begin with a hyphen.
                yield f"--{name}={one}"
