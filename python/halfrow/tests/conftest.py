"""What the tests share: small tables, a lens file from OpenCV, and the program, whose answers must be the same."""
import json
import os
import pathlib
import subprocess
import sys
import threading
import time

import pytest

import halfrow

pytest_plugins = ["pytester"]

ROOT = pathlib.Path(__file__).resolve().parents[3]
LENSES = ROOT / "host/judge/tests/lenses/files"


@pytest.fixture
def opencv():
    """A file that OpenCV 4.10 wrote for a fisheye camera of 1280 x 720."""
    return LENSES / "opencv-4.10.yml"


@pytest.fixture(scope="session")
def small():
    """Tables for frames of 128 x 32, with which a board is judged quickly."""
    return halfrow.Tables.from_lens(halfrow.Lens("equidistant:80", width=128, height=32))


@pytest.fixture(scope="session")
def program():
    """Runs the program, with which this package is compared, and returns its exit code and its JSON."""
    halfrow_program = pathlib.Path(os.environ["HALFROW_PROGRAMS"]) / "halfrow"

    def run(*arguments):
        done = subprocess.run([halfrow_program, "--json", "--quiet", *map(str, arguments)], capture_output=True, text=True)
        return done.returncode, json.loads(done.stdout) if done.stdout else None

    return run


@pytest.fixture
def steps_beside():
    """How many steps another thread takes while a call runs. The interpreter takes its lock from no thread meanwhile."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)
    steps, done = [0], threading.Event()

    def count():
        while not done.is_set():
            steps[0] += 1
            # Lets another thread have the lock.
            time.sleep(0)

    def beside(call):
        before = steps[0]
        call()
        return steps[0] - before

    thread = threading.Thread(target=count)
    thread.start()
    yield beside
    done.set()
    thread.join()
    sys.setswitchinterval(interval)


def until(seen, patience=100):
    """Waits for `seen` to be true. The time limit only ends hangs."""
    ends = time.monotonic() + patience
    while not seen():
        assert time.monotonic() < ends, "waited in vain"
