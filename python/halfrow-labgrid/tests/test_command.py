"""The program halfrow-labgrid, where its coordinator stops in the middle."""
import json
import signal
import subprocess
import sys

import pytest
from conftest import LABGRID

# The program, whose coordinator (a process) is stopped at a call of a method once it is connected.
PROGRAM = """
import os, signal, sys
from labgrid.remote.client import ClientSession
from halfrow_labgrid import command, place

process, method = int(sys.argv.pop(1)), sys.argv.pop(1)
of = place.Coordinator if hasattr(place.Coordinator, method) else ClientSession
whole, connect = getattr(of, method), place.Coordinator.__init__

def stopped(*given):
    os.kill(process, signal.SIGSTOP)
    place.PATIENCE = 0.5
    return whole(*given)

def connected(*given):
    connect(*given)
    setattr(of, method, stopped)

place.Coordinator.__init__ = connected
command.main()
"""


@pytest.mark.parametrize("method", ["acquire", "sync_with_coordinator", "release"])
def test_a_coordinator_that_stops_while_a_place_is_held_is_told(lab, method):
    of = ["--place", "cam-empty", "--coordinator", lab.coordinator, "--user", "u1"]
    hold = [sys.executable, "-c", PROGRAM, str(lab.process.pid), method, "hold", *of]
    try:
        done = subprocess.run(hold, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    finally:
        lab.process.send_signal(signal.SIGCONT)
    freed = subprocess.run([LABGRID / "halfrow-labgrid", "free", *of], capture_output=True, text=True)
    assert (freed.returncode, freed.stdout) == (0, '"freed"\n'), freed.stderr
    assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
    assert json.loads(done.stdout) == {"refused": {"why": "coordinator-away", "coordinator": lab.coordinator}}
