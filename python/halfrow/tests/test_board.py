"""The board of docs/board-in-python.md, with hosts that vanish; scripts/handbook judges it."""
import socket
import struct
import subprocess
import sys

import pytest

import halfrow
from conftest import ROOT


@pytest.fixture
def port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port = one.getsockname()[1]
    with subprocess.Popen([sys.executable, ROOT / "docs/examples/board.py", str(port)], stdout=subprocess.PIPE, text=True) as board:
        assert board.stdout.readline().startswith("a board at")
        yield port
        board.kill()


def test_a_host_whose_connection_is_reset_makes_room_for_the_next_one(port, small):
    for said in (b"", b"abc", b"\0" * 100):
        with socket.create_connection(("127.0.0.1", port)) as host:
            host.sendall(said)
            # Close by a reset, as the kernel does when a program is killed with data unread.
            host.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
    report = halfrow.verify(f"tcp:127.0.0.1:{port}", tables=small, frames="builtin:bars", at_speed=0)
    assert report.passed, report.text
