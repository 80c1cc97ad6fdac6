"""Lanes of a station whose boards labgrid lends."""
import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import threading

import pytest
from conftest import HANG, LABGRID, PROGRAMS, wait_for

# From the project's own scripts.
sys.path.insert(0, str(pathlib.Path(__file__).parents[3] / "scripts"))
from lanes import PLAN  # noqa: E402


class Station:
    """A station with a lane for each of these places, called 1, 2, and so on."""

    def __init__(self, lab, folder, places):
        (folder / "plan.toml").write_text(PLAN)
        text = f"""schema = 1
[station]
name = "12"
data = "data"
[labgrid]
coordinator = "{lab.coordinator}"
program = "{LABGRID / 'halfrow-labgrid'}"
"""
        for number, place in enumerate(places, 1):
            text += f'[[lane]]\nname = "{number}"\nboard = "labgrid:{place}"\nplans = ["plan.toml"]\n'
        self.settings = folder / "station.toml"
        self.settings.write_text(text)

    @contextlib.contextmanager
    def at_work(self):
        command = [PROGRAMS / "halfrow-station", "lanes", "--any-disk", "--settings", self.settings]
        env = dict(os.environ, LG_HOSTNAME="bench")
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=env) as process:
            # If the station hangs, this ends the wait for its output.
            watchdog = threading.Timer(HANG, process.kill)
            watchdog.start()
            try:
                yield Running(process)
            finally:
                watchdog.cancel()
                process.kill()


class Running:
    def __init__(self, process):
        self.process = process

    def judge(self, lane, serial):
        self.process.stdin.write(f"HR:LANE:{lane}\n{serial}\n")
        self.process.stdin.flush()

    def wait(self, is_wanted):
        heard = (json.loads(line) for line in self.process.stdout)
        found = next((news for news in heard if is_wanted(news)), None)
        assert found, "the station ended before"
        return found

    def verdict(self, lane, serial):
        self.judge(lane, serial)
        return self.wait(lambda news: news.get("lane") == lane and (news.get("shown") or {}).get("serial") == serial)["shown"]


@pytest.fixture
def station(lab, tmp_path):
    return lambda *places: Station(lab, tmp_path, places)


def test_boards_that_are_lent_are_judged_and_given_back(lab, station):
    with station("cam-good", "cam-bad").at_work() as running:
        for serial in ("CAT00001", "CAT00002"):
            assert running.verdict("1", serial)["verdict"] == "PASS"
        failed = running.verdict("2", "CAT00003")
        assert (failed["verdict"], "stuck at 1" in failed["headline"]) == ("FAIL", True)
        wait_for("release", lambda: not lab.holder("cam-good") and not lab.holder("cam-bad"))


def test_a_place_that_somebody_else_has_is_an_error_with_their_name(lab, station):
    with station("cam-good").at_work() as running:
        with lab.acquired("cam-good"):
            refused = running.verdict("1", "CAT00001")
            assert (refused["verdict"], refused["finding"]["code"]) == ("ERROR", "labgrid-place-held")
            assert refused["headline"].startswith("bench/alice has labgrid's place cam-good")
            assert lab.holder("cam-good") == "alice"
        assert running.verdict("1", "CAT00002")["verdict"] == "PASS"


@pytest.mark.parametrize(
    "place, code",
    [
        ("cam-go", "labgrid-place-unknown"),
        ("cam-empty", "labgrid-place-without-port"),
        ("cam-two", "labgrid-place-with-several-ports"),
        ("cam-telnet", "labgrid-port-not-raw"),
        ("cam-nobody", "tcp-refused"),
    ],
)
def test_a_place_without_such_a_port_is_an_error(lab, station, place, code):
    with station(place).at_work() as running:
        refused = running.verdict("1", "CAT00001")
        assert (refused["verdict"], refused["finding"]["code"]) == ("ERROR", code)
    wait_for("release", lambda: not lab.holder(place))


def test_of_several_ports_the_one_called_halfrow_is_taken(lab, station):
    lab.client("-p", "cam-two", "del-match", "bench/spare/NetworkSerialPort")
    lab.client("-p", "cam-two", "add-named-match", "bench/spare/NetworkSerialPort/NetworkSerialPort", "halfrow")
    with station("cam-two").at_work() as running:
        assert running.verdict("1", "CAT00001")["verdict"] == "PASS"


def test_a_coordinator_that_is_away_is_an_error(lab, station):
    away = station("cam-good")
    away.settings.write_text(away.settings.read_text().replace(lab.coordinator, "127.0.0.1:1"))
    with away.at_work() as running:
        assert running.verdict("1", "CAT00001")["finding"]["code"] == "labgrid-coordinator-away"


def holders_of(process):
    """The processes that hold places for `process`."""
    children = pathlib.Path(f"/proc/{process.pid}/task").glob("*/children")
    ids = [int(word) for child in children for word in child.read_text().split()]
    return [one for one in ids if b"halfrow-labgrid" in pathlib.Path(f"/proc/{one}/cmdline").read_bytes()]


@pytest.fixture
def hung(lab, station, request):
    """A station in the middle of a long run, on the board of a place."""
    slow = station(request.param)
    longer = [("width = 64", "width = 640"), ("height = 8", "height = 480"), ("radius = 10.0", "radius = 400.0")]
    plan = PLAN.replace('frames = ["builtin:noise"]', 'frames = ["builtin:noise"]\nrepeat = 1000')
    for short, long in longer:
        plan = plan.replace(short, long)
    (slow.settings.parent / "plan.toml").write_text(plan)
    with slow.at_work() as running:
        running.judge("1", "CAT00001")
        running.wait(lambda news: news["news"] == "doing" and news["rows"])
        assert lab.holder(request.param) == "halfrow-12.1"
        yield slow, running


@pytest.mark.parametrize("hung", ["cam-first"], indirect=True)
def test_a_station_that_is_killed_gives_its_place_back(lab, hung):
    _, running = hung
    running.process.send_signal(signal.SIGKILL)
    wait_for("release", lambda: not lab.holder("cam-first"))


@pytest.mark.parametrize("hung", ["cam-second"], indirect=True)
def test_a_place_that_even_its_holder_could_not_give_back_is_free_when_the_station_starts(lab, hung):
    slow, running = hung
    (holder,) = holders_of(running.process)
    os.kill(holder, signal.SIGKILL)
    running.process.send_signal(signal.SIGKILL)
    running.process.wait()
    assert lab.holder("cam-second") == "halfrow-12.1", "nobody else can"
    with slow.at_work() as again:
        again.wait(lambda news: news["news"] == "lane" and news["state"] == "READY")
        assert not lab.holder("cam-second")


def test_a_holder_that_is_killed_spoils_no_run_and_its_place_is_taken_again(lab, station):
    with station("cam-good").at_work() as running:
        running.judge("1", "CAT00001")
        running.wait(lambda news: news["news"] == "doing" and news["what"] == "verify")
        (holder,) = holders_of(running.process)
        os.kill(holder, signal.SIGKILL)
        shown = running.wait(lambda news: news["news"] == "lane" and news["shown"])["shown"]
        assert shown["verdict"] == "PASS"
        assert running.verdict("1", "CAT00002")["verdict"] == "PASS"
        wait_for("release", lambda: not lab.holder("cam-good"))
