"""A lab on this computer: labgrid's coordinator and exporter, and mock boards behind TCP.

HALFROW_PROGRAMS is the folder of the programs halfrow and halfrow-station.
"""
import concurrent.futures
import contextlib
import os
import pathlib
import socket
import subprocess
import sys
import time

import pytest

PROGRAMS = pathlib.Path(os.environ["HALFROW_PROGRAMS"])
LABGRID = pathlib.Path(sys.executable).parent
# How long to wait for something that must come. This only ends hangs.
HANG = 120.0

BOARDS = {"good": "mock", "bad": "mock,fault=stuck-data", "first": "mock", "second": "mock"}
# The exporter's groups, each with what it exports. The ports of the boards are filled in by name.
EXPORTED = """
good:
  NetworkSerialPort: {{host: 127.0.0.1, port: {good}, protocol: raw}}
bad:
  NetworkSerialPort: {{host: 127.0.0.1, port: {bad}, speed: 12000000, protocol: raw}}
spare:
  NetworkSerialPort: {{host: 127.0.0.1, port: {good}, protocol: raw}}
first:
  NetworkSerialPort: {{host: 127.0.0.1, port: {first}, protocol: raw}}
second:
  NetworkSerialPort: {{host: 127.0.0.1, port: {second}, protocol: raw}}
telnet:
  NetworkSerialPort: {{host: 127.0.0.1, port: {good}, protocol: rfc2217}}
nobody:
  NetworkSerialPort: {{host: 127.0.0.1, port: {nobody}, protocol: raw}}
"""
# The places, and what is in them.
PLACES = {
    "cam-good": ["bench/good/NetworkSerialPort"],
    "cam-bad": ["bench/bad/NetworkSerialPort"],
    # Boards whose hosts are killed: their sessions hold them for ten seconds after that.
    "cam-first": ["bench/first/NetworkSerialPort"],
    "cam-second": ["bench/second/NetworkSerialPort"],
    "cam-telnet": ["bench/telnet/NetworkSerialPort"],
    "cam-nobody": ["bench/nobody/NetworkSerialPort"],
    "cam-two": ["bench/bad/NetworkSerialPort", "bench/spare/NetworkSerialPort"],
    "cam-empty": [],
}


def wait_for(what, look):
    """What `look` returns, as soon as that is true."""
    begun = time.monotonic()
    while not (seen := look()):
        assert time.monotonic() - begun < HANG, f"no {what}"
        time.sleep(0.02)
    return seen


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@contextlib.contextmanager
def running(*command, **more):
    process = subprocess.Popen([str(word) for word in command], **more)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


@contextlib.contextmanager
def served(board, *where):
    """The target of a mock board, behind a pseudo-terminal or as `where` says."""
    with running(PROGRAMS / "halfrow", "serve", "--board", board, *where, stdout=subprocess.PIPE, text=True) as process:
        yield process.stdout.readline().split()[-1]


class Lab:
    """labgrid at work."""

    def __init__(self, coordinator, process):
        self.coordinator = coordinator
        self.process = process

    def client(self, *words, user="alice", check=True):
        """The output of labgrid's own client."""
        env = dict(os.environ, LG_COORDINATOR=self.coordinator, LG_HOSTNAME="bench", LG_USERNAME=user)
        done = subprocess.run([LABGRID / "labgrid-client", *words], env=env, capture_output=True, text=True, timeout=HANG)
        assert not check or done.returncode == 0, done
        return done.stdout

    def clients(self, calls):
        """Runs several calls of labgrid's client at once."""
        with concurrent.futures.ThreadPoolExecutor() as pool:
            list(pool.map(lambda words: self.client(*words), calls))

    def holder(self, place):
        """Who has the place, as `user`."""
        return next((line.split()[0] for line in self.client("who").splitlines() if line.split()[2] == place), None)

    @contextlib.contextmanager
    def acquired(self, place, user="alice"):
        self.client("-p", place, "acquire", user=user)
        try:
            yield
        finally:
            self.client("-p", place, "release", user=user)


@pytest.fixture(scope="session")
def lab(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lab")
    address = f"127.0.0.1:{free_port()}"
    with contextlib.ExitStack() as stack:
        targets = {name: stack.enter_context(served(board, "--tcp", "0")) for name, board in BOARDS.items()}
        ports = {name: target.rsplit(":")[-1] for name, target in targets.items()}
        (folder / "exported.yaml").write_text(EXPORTED.format(nobody=free_port(), **ports))
        quiet = {"cwd": folder, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        lab = Lab(address, stack.enter_context(running(LABGRID / "labgrid-coordinator", "-l", address, **quiet)))
        wait_for("coordinator", lambda: "User" in lab.client("who", check=False))
        stack.enter_context(running(LABGRID / "labgrid-exporter", "-c", address, "-n", "bench", "exported.yaml", **quiet))
        wait_for("exporter", lambda: "bench/nobody" in lab.client("resources"))
        lab.clients(["-p", place, "create"] for place in PLACES)
        lab.clients(["-p", place, "add-match", *matches] for place, matches in PLACES.items() if matches)
        yield lab
