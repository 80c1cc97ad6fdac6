"""The program halfrow-labgrid, with a coordinator that stops in the middle."""
import json
import signal
import subprocess
import sys

import pytest
from conftest import LABGRID
from halfrow_labgrid import NotJudged
from halfrow_labgrid.report import info

# The program, with its coordinator process stopped when it calls a given method after it has connected, and continued when it
# calls another one.
PROGRAM = """
import os, signal, sys
from labgrid.remote.client import ClientSession
from halfrow_labgrid import command, place

process, stops, goes_on = int(sys.argv.pop(1)), sys.argv.pop(1), sys.argv.pop(1)
connect, patience = place.Coordinator.__init__, place.PATIENCE

def signals(method, number, patience):
    of = place.Coordinator if hasattr(place.Coordinator, method) else ClientSession
    whole = getattr(of, method)

    def signalled(*given):
        os.kill(process, number)
        place.PATIENCE = patience
        # Once alone.
        setattr(of, method, whole)
        return whole(*given)

    setattr(of, method, signalled)

def connected(*given):
    connect(*given)
    signals(stops, signal.SIGSTOP, 0.5)
    if goes_on:
        signals(goes_on, signal.SIGCONT, patience)

place.Coordinator.__init__ = connected
command.main()
"""


class Hold:
    """A hold of a place by the program, and what frees the place afterwards."""

    def __init__(self, lab, place):
        self.lab = lab
        self.of = ["--place", place, "--coordinator", lab.coordinator, "--user", "u1"]

    def told(self, stops, goes_on=""):
        """The program's last line when the coordinator stops and continues at calls of these methods."""
        hold = [sys.executable, "-c", PROGRAM, str(self.lab.process.pid), stops, goes_on, "hold", *self.of]
        try:
            done = subprocess.run(hold, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        finally:
            self.lab.process.send_signal(signal.SIGCONT)
        assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
        return json.loads(done.stdout.splitlines()[-1])

    def free(self):
        freed = subprocess.run([LABGRID / "halfrow-labgrid", "free", *self.of], capture_output=True, text=True)
        assert (freed.returncode, freed.stdout) == (0, '"freed"\n'), freed.stderr


@pytest.mark.parametrize("method", ["acquire", "sync_with_coordinator", "release"])
def test_a_coordinator_that_stops_while_a_place_is_held_is_told(lab, method):
    hold = Hold(lab, "cam-good")
    told = hold.told(method)
    hold.free()
    assert told == {"refused": {"why": "coordinator-away", "coordinator": lab.coordinator}}


def test_of_two_errors_the_first_is_told(lab):
    hold = Hold(lab, "cam-empty")
    told = hold.told("release")
    hold.free()
    assert told == {"refused": {"why": "no-port"}}


def test_a_place_is_released_where_what_fails_is_behind_its_acquiring(lab):
    told = Hold(lab, "cam-empty").told("sync_with_coordinator", goes_on="release")
    assert told == {"refused": {"why": "coordinator-away", "coordinator": lab.coordinator}}
    assert lab.holder("cam-empty") is None


# The program, which gets a signal when it calls a given method.
SIGNALLED = """
import os, signal, sys
from halfrow_labgrid import command, place

number, method = int(sys.argv.pop(1)), sys.argv.pop(1)
whole = getattr(place.Coordinator, method)

def signalled(*given):
    # Once alone.
    setattr(place.Coordinator, method, whole)
    os.kill(os.getpid(), number)
    return whole(*given)

setattr(place.Coordinator, method, signalled)
command.main()
"""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("method", ["acquire", "_port"])
def test_a_signal_while_a_place_is_acquired_releases_it(lab, method, number):
    hold = [sys.executable, "-c", SIGNALLED, str(int(number)), method, "hold", *Hold(lab, "cam-good").of]
    done = subprocess.run(hold, stdin=subprocess.PIPE, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (128 + number, ""), done.stderr
    assert "Traceback" not in done.stderr, done.stderr
    assert lab.holder("cam-good") is None


@pytest.mark.parametrize("said", ["", "no JSON", "[]"])
def test_what_does_not_read_as_a_board_is_none(said):
    with pytest.raises(NotJudged):
        info(said)
