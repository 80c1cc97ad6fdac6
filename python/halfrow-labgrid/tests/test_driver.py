"""The driver and the strategy, in environments such as labgrid's users write."""
import os
import signal
import subprocess
import threading

import pytest
from conftest import PROGRAMS, served, wait_for
from halfrow_labgrid import BoardFailed, NotJudged, Status, WrongCall
from labgrid import Environment

ENVIRONMENT = """
targets:
  main:
    resources:
      RemotePlace: {{name: {place}}}
    drivers:
      HalfrowDriver:
        options: {{radius: 10.0, width: 64, height: 16, frame: ["builtin:noise"]}}
      ExternalPowerDriver:
        cmd_on: sh -c "echo on >> {power}"
        cmd_off: sh -c "echo off >> {power}"
      HalfrowStrategy: {{patience: 5}}
options:
  coordinator_address: {coordinator}
tools:
  halfrow: {halfrow}
imports:
- halfrow_labgrid
"""

LOCAL = """
targets:
  main:
    resources:
      RawSerialPort: {{port: {port}, speed: 115200}}
    drivers:
      HalfrowDriver:
        options: {{radius: 10.0, width: 64, height: 16, frame: ["builtin:noise"]}}
tools:
  halfrow: {halfrow}
imports:
- halfrow_labgrid
"""


@pytest.fixture(scope="module")
def alice(lab):
    """The user who has every place: labgrid's session in this process knows only the places that she had when it began."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("LG_HOSTNAME", "bench")
        patch.setenv("LG_USERNAME", "alice")
        places = ["cam-good", "cam-bad", "cam-nobody", "cam-telnet"]
        lab.clients(["-p", place, "acquire"] for place in places)
        yield
        lab.clients(["-p", place, "release"] for place in places)


@pytest.fixture
def environment(lab, alice, tmp_path):
    def of(place, halfrow=PROGRAMS / "halfrow"):
        path = tmp_path / f"{place}.yaml"
        path.write_text(ENVIRONMENT.format(place=place, power=tmp_path / "power", coordinator=lab.coordinator, halfrow=halfrow))
        return Environment(str(path)).get_target()

    return of


def test_a_good_board_passes_and_its_report_has_what_halfrow_says(environment):
    driver = environment("cam-good").get_driver("HalfrowDriver")
    report = driver.verify()
    assert (report.verdict, report.exit_code, report.suspects) == ("PASS", 0, ())
    assert "equal to the reference" in report.headline
    assert [frame["name"] for frame in report.document["frames"]][0] == "builtin:noise"
    assert report.document["tables"]["height"] == 16
    assert driver.verify(height=32, fail_fast=True).document["tables"]["height"] == 32


def test_a_bad_board_fails_with_its_suspect(environment):
    driver = environment("cam-bad").get_driver("HalfrowDriver")
    assert driver.board.endswith(",baud=12000000")
    with pytest.raises(BoardFailed, match="data bit 5 stuck at 1") as raised:
        driver.verify()
    report = raised.value.report
    assert (report.verdict, report.exit_code, report.code) == ("FAIL", 1, "samples-differ")
    assert report.suspects[0] == "line memory, data bit 5 stuck at 1"


def test_a_port_of_this_computer_is_opened_as_it_is(tmp_path):
    with served("mock") as target:
        path = tmp_path / "local.yaml"
        port = target.removeprefix("serial:").split(",")[0]
        path.write_text(LOCAL.format(port=port, halfrow=PROGRAMS / "halfrow"))
        driver = Environment(str(path)).get_target().get_driver("HalfrowDriver")
        assert driver.board == f"serial:{port},baud=115200"
        assert driver.verify().verdict == "PASS"


def test_what_cannot_be_judged_is_told_apart_from_what_is_called_wrongly(environment, tmp_path):
    nobody = environment("cam-nobody").get_driver("HalfrowDriver")
    with pytest.raises(NotJudged, match="start ser2net") as raised:
        nobody.verify()
    assert (raised.value.report.exit_code, raised.value.report.code) == (3, "tcp-refused")
    with pytest.raises(NotJudged, match="refuses connections"):
        nobody.wait(patience=0.0)
    with pytest.raises(WrongCall, match="unexpected argument") as raised:
        nobody.verify(bogus=True)
    assert raised.value.report.exit_code == 2
    with pytest.raises(WrongCall, match="frame is an empty list"):
        nobody.verify(frame=[])
    for own in ({"board": "mock"}, {"timeout": 1}, {"Width": 1}):
        with pytest.raises(WrongCall, match="is no option for the driver"):
            nobody.verify(**own)
    with pytest.raises(NotJudged, match="exported by rfc2217"):
        environment("cam-telnet").get_driver("HalfrowDriver").verify()
    missing = environment("cam-good", halfrow=tmp_path / "nothing").get_driver("HalfrowDriver")
    with pytest.raises(NotJudged, match="cannot be started"):
        missing.verify()


def test_a_run_that_is_interrupted_gives_the_board_back(environment, tmp_path):
    driver = environment("cam-good").get_driver("HalfrowDriver")
    kept = tmp_path / "kept"
    kept.mkdir()

    def interrupts():
        # The board is in use once something of its run is recorded.
        wait_for("recording", lambda: any(path.stat().st_size for path in kept.iterdir()))
        os.kill(os.getpid(), signal.SIGINT)

    interrupter = threading.Thread(target=interrupts)
    interrupter.start()
    with pytest.raises(KeyboardInterrupt):
        driver.verify(radius=400.0, width=640, height=480, repeat=1000, record=kept / "run.rec")
    interrupter.join()
    assert driver.verify().verdict == "PASS"


def test_a_wait_that_no_board_can_end_is_not_tried_again(environment, tmp_path, monkeypatch):
    tool, calls, settings = tmp_path / "tool", tmp_path / "calls", tmp_path / "halfrow.toml"
    tool.write_text(f'#!/bin/sh\necho >> {calls}\nexec {PROGRAMS / "halfrow"} "$@"\n')
    tool.chmod(0o755)
    settings.write_text("bogus = 1\n")
    monkeypatch.setenv("HALFROW_SETTINGS", str(settings))
    driver = environment("cam-good", halfrow=tool).get_driver("HalfrowDriver")
    with pytest.raises(WrongCall, match="bogus"):
        driver.wait(patience=2.0)
    assert calls.read_text() == "\n"


def test_a_strategy_takes_a_board_from_off_to_judged(environment, tmp_path):
    strategy = environment("cam-good").get_driver("HalfrowStrategy")
    strategy.transition("off")
    strategy.transition("judged")
    assert (strategy.status, strategy.report.verdict) == (Status.judged, "PASS")
    judged = strategy.report
    strategy.transition(Status.judged)
    assert strategy.report is judged, "not judged again"
    strategy.transition("off")
    assert (strategy.status, strategy.report) == (Status.off, None)
    strategy.transition("on")
    assert (tmp_path / "power").read_text().split() == ["off", "on", "off", "on"]


def test_a_status_that_is_forced_has_no_report_of_an_earlier_board(environment):
    strategy = environment("cam-good").get_driver("HalfrowStrategy")
    strategy.transition("judged")
    strategy.force("judged")
    assert (strategy.status, strategy.report) == (Status.judged, None)


def test_a_strategy_whose_power_fails_believes_nothing_and_goes_the_whole_way_next(environment, tmp_path):
    power = tmp_path / "power"
    strategy = environment("cam-good").get_driver("HalfrowStrategy")
    strategy.transition("judged")

    def fails(status):
        power.unlink()
        power.mkdir()
        with pytest.raises(subprocess.CalledProcessError):
            strategy.transition(status)
        power.rmdir()
        assert (strategy.status, strategy.report) == (Status.unknown, None)

    fails("off")
    strategy.transition("judged")
    assert (strategy.status, strategy.report.verdict, power.read_text()) == (Status.judged, "PASS", "on\n")
    strategy.transition("off")
    fails("on")
    strategy.transition("off")
    assert (strategy.status, power.read_text()) == (Status.off, "off\n")


def test_a_strategy_whose_board_fails_leaves_it_on(environment):
    strategy = environment("cam-bad").get_driver("HalfrowStrategy")
    with pytest.raises(BoardFailed):
        strategy.transition("judged")
    assert (strategy.status, strategy.report) == (Status.on, None)
