"""Judging boards: reports, files, progress, signals."""
import copy
import dataclasses
import hashlib
import inspect
import json
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import typing

import numpy as np
import pytest

import halfrow
from conftest import ROOT, until


def test_a_sound_board_passes(small):
    report = halfrow.verify("mock", tables=small)
    assert report.passed and report.verdict == "PASS" and report.cause == "equal", report.text
    assert report.remedy is None and report.error is None and report.suspects == ()
    assert report.board.kind == "mock" and report.board.identity.taps == 7
    assert {check.outcome for check in report.checks} == {"passed"}
    samples = sum(frame.comparison.samples for frame in report.frames)
    assert samples == len(report.frames) * 128 * 32
    # Half a row, and the clocks that the board reports for its pipeline (DATAPATH.md, "Latency").
    assert report.latency.least == report.latency.most == 64 + report.board.identity.latency
    assert report.text.startswith("PASS (mock board: no hardware was tested)")


def test_a_broken_board_fails_with_its_suspect(small):
    report = halfrow.verify("mock,fault=stuck-data,bit=7", tables=small)
    assert not report.passed and (report.verdict, report.cause) == ("FAIL", "different")
    suspect = report.suspects[0]
    assert suspect.defect.code == "line-memory-data-stuck" and suspect.defect.parameters["bit"] == 7
    assert report.remedy and suspect.designer in report.text and suspect.technician in report.text
    wrong = [frame for frame in report.frames if frame.comparison.differences]
    assert wrong and wrong[0].comparison.first.expected != wrong[0].comparison.first.found


def test_the_result_is_that_of_the_program(program):
    flags = ["--lens", "equidistant:80", "--width", 128, "--height", 32, "--frame", "builtin:street", "--seed", 7]
    exit_code, theirs = program("verify", "--board", "mock,fault=stuck-data", *flags)
    tables = halfrow.Tables.from_lens(halfrow.Lens("equidistant:80", width=128, height=32))
    ours = halfrow.verify("mock,fault=stuck-data", tables=tables, frames=["builtin:street"], seed=7)
    assert exit_code == 1
    # Everything but the arguments, the times, and the bytes on the wire, which depend on what each run draws at random.
    of_run = {"seconds", "bytes_in", "bytes_out"}

    def stable(document):
        document = {key: value for key, value in document.items() if key != "run"}
        return json.loads(json.dumps(document), object_hook=lambda it: {k: v for k, v in it.items() if k not in of_run})

    assert stable(ours.document) == stable(theirs)


# Members of a report that only its `document` has. A new one must become a field, or be listed here as rarely needed by scripts.
IN_THE_DOCUMENT_ALONE = {
    "Report": {"command", "schema", "exit_code", "evidence", "within", "soak"},
    "Identity": {"least_blanking", "table_banks", "row_banks_in", "row_banks_out", "bursts", "entered", "grids"},
    "Suspect": {"account"},
    "Comparison": {"extremes", "bits", "by_row", "by_column"},
    "Frame": {"timing", "variation", "first_rows", "missing", "tables"},
    "Link": {"late", "strays", "line_errors", "retry_limit", "reconnections"},
    "TablesUsed": {"tables_crc32", "kernel_crc32"},
    "Facts": {"operator"},
    "Problem": {"causes"},
}


def test_reports_have_the_members_that_the_schema_has(small):
    schema = json.loads((ROOT / "host/schema/halfrow-1.json").read_text())
    names = {"Report": "verify_result", "Board": "board", "Identity": "identity", "Check": "check", "Suspect": "suspect",
             "Difference": "difference", "Comparison": "comparison", "Frame": "frame", "Latency": "latency", "Street": "street",
             "Coverage": "coverage", "Link": "link", "TablesUsed": "tables", "Facts": "run", "NotExercised": "not_exercised", "Problem": "problem"}
    for ours, theirs in names.items():
        known = set(schema["$defs"][theirs].get("properties") or ["code", "parameters", "words"])
        fields = {field.name for field in dataclasses.fields(getattr(halfrow, ours))} - {"text", "document"}
        assert fields <= known, ours
        assert known - fields == IN_THE_DOCUMENT_ALONE.get(ours, set()), ours
    whole = halfrow.verify(tables=small, frames=["builtin:black"], at_speed=0)
    own = {field.name for field in dataclasses.fields(halfrow.Report)} - {"text", "document"}
    # Left out of a document if there are none.
    assert own <= set(whole.document) | {"lacks"} and set(schema["required"]) <= set(whole.document)
    with pytest.raises(dataclasses.FrozenInstanceError):
        whole.verdict = "FAIL"


def test_values_have_the_types_that_they_are_said_to_have(small):
    def check(value, hint, place):
        origin, arguments = typing.get_origin(hint), typing.get_args(hint)
        if origin is typing.Union:
            return value is None or check(value, arguments[0], place)
        if origin is tuple:
            assert isinstance(value, tuple), place
            return [check(item, arguments[0], place) for item in value]
        kind = {dict: dict, float: (int, float)}.get(origin or hint, origin or hint)
        assert isinstance(value, kind), (place, value)
        if dataclasses.is_dataclass(hint):
            hints = typing.get_type_hints(hint)
            for name in (field.name for field in dataclasses.fields(hint)):
                check(getattr(value, name), hints[name], f"{place}.{name}")

    for target in ("mock", "mock,fault=stuck-data", "mock,fault=wrong-datapath"):
        check(halfrow.verify(target, tables=small), halfrow.Report, target)


def test_a_report_names_the_lens_s_file_by_its_hash(tmp_path, opencv):
    hashed = hashlib.sha256(pathlib.Path(opencv).read_bytes()).hexdigest()
    tables = halfrow.Tables.from_lens(halfrow.Lens(opencv, width=128, height=72))
    for taken in (tables, halfrow.Tables.from_lens(tables.lens)):
        report = halfrow.verify(tables=taken, frames=["builtin:bars"], at_speed=0)
        assert [(file.path, file.sha256) for file in report.run.files] == [(str(opencv), hashed)]


def test_a_report_names_the_kernel_s_file_by_its_hash(tmp_path, small):
    own = tmp_path / "own.json"
    halfrow.Kernel("sharp7").write(own)
    hashed = hashlib.sha256(own.read_bytes()).hexdigest()
    for given in (own, halfrow.Kernel(own)):
        report = halfrow.verify(tables=small, kernel=given, frames=["builtin:black"], at_speed=0)
        assert [(file.path, file.sha256) for file in report.run.files] == [(str(own), hashed)]


def test_what_is_hashed_is_what_was_judged(tmp_path, small):
    """Each file is opened only once: if it were replaced in between, the report would have the hash of what was not judged."""
    small.write(tmp_path / "t.json")
    halfrow.write_frame(tmp_path / "own.pgm", small.lens.frame("noise"))
    judged = 'import halfrow; halfrow.verify(tables=halfrow.Tables.read("t.json"), frames=["own.pgm"], at_speed=0)'
    traced = ["strace", "-f", "-qq", "-e", "trace=open,openat", "-o", "opened"]
    subprocess.run([*traced, sys.executable, "-c", judged], cwd=tmp_path, check=True)
    opened = (tmp_path / "opened").read_text()
    assert [opened.count(f'"{name}"') for name in ("t.json", "own.pgm")] == [1, 1]


def test_frames_of_a_call_are_judged(tmp_path, small):
    frame = small.lens.frame("zone-plate")
    halfrow.write_frame(tmp_path / "own.pgm", frame)
    report = halfrow.verify(tables=small, frames=[frame, tmp_path / "own.pgm", "builtin:bars"], at_speed=0)
    names = [frame.name for frame in report.frames]
    assert report.passed and {"frames[0]", str(tmp_path / "own.pgm"), "builtin:bars"} <= set(names)
    by_name = {frame.name: frame.sha256 for frame in report.frames}
    assert by_name["frames[0]"] == by_name[str(tmp_path / "own.pgm")]
    assert [file.path for file in report.run.files] == [str(tmp_path / "own.pgm")]
    with pytest.raises(halfrow.InputError) as raised:
        halfrow.verify(tables=small, frames=[frame, frame[:16]])
    size = {"path": "frames[1]", "width": 128, "height": 16, "columns": 128, "rows": 32}
    assert (raised.value.code, raised.value.parameters) == ("frame-of-other-size", size)
    with pytest.raises(TypeError, match=r"frames\[0\]"):
        halfrow.verify(tables=small, frames=[frame.astype(float)])


def test_without_tables_it_is_the_papers_lens():
    report = halfrow.verify(within=0.5)
    assert report.passed and (report.tables.width, report.tables.height) == (1920, 1080)


def test_a_report_is_written_and_not_overwritten_unasked(tmp_path, small):
    report = halfrow.verify(tables=small, report=tmp_path / "a")
    assert sorted(file.name for file in (tmp_path / "a").iterdir()) == ["report.html", "report.json", "report.xml"]
    assert json.loads((tmp_path / "a/report.json").read_text()) == report.document
    for call in (lambda: report.save(tmp_path / "a"), lambda: halfrow.verify(tables=small, report=tmp_path / "a")):
        with pytest.raises(halfrow.InputError) as raised:
            call()
        assert raised.value.code == "report-exists"
    report.save(tmp_path / "a", overwrite=True)
    report.save(tmp_path / "b")
    again = pickle.loads(pickle.dumps(report))
    assert again == report
    with pytest.raises(ValueError, match="process"):
        again.save(tmp_path / "c")


@pytest.mark.parametrize(("target", "verdict"), [("mock", "ERROR"), ("mock,fault=stuck-data,bit=7", "FAIL")])
def test_a_report_that_could_not_be_written_is_told_under_every_verdict(tmp_path, small, target, verdict):
    def take(*_):
        (tmp_path / "a").mkdir(exist_ok=True)
        (tmp_path / "a/of somebody else").touch()

    report = halfrow.verify(target, tables=small, report=tmp_path / "a", progress=take)
    assert report.verdict == verdict
    told = [report.error] if verdict == "ERROR" else list(report.lacks)
    assert [problem.code for problem in told] == ["report-lost"] and told[0].remedy
    assert len(report.lacks) == (0 if verdict == "ERROR" else 1)


def test_a_board_that_cannot_be_opened_has_a_report(tmp_path, program, small):
    with pytest.raises(halfrow.HalfrowError) as raised:
        halfrow.verify("serial:/dev/none", tables=small, report=tmp_path / "a")
    program("verify", "--board", "serial:/dev/none", "--report", tmp_path / "b")
    written, of_program = (json.loads((tmp_path / name / "report.json").read_text()) for name in "ab")
    report = pickle.loads(pickle.dumps(raised.value)).report
    assert report.document == written and report.board.identity is None
    same = ("verdict", "finding", "headline")
    assert [written[name] for name in same] == [of_program[name] for name in same]
    assert written["verdict"] == "ERROR"
    with pytest.raises(halfrow.InputError) as wrong:
        halfrow.verify("mock", tables=small, repeat=0)
    assert wrong.value.report is None


def test_a_report_is_data_and_a_copy_is_as_good_as_it_is(tmp_path, small):
    report = halfrow.verify("mock,fault=stuck-data,bit=7", tables=small)
    data = dataclasses.asdict(report)
    assert json.loads(json.dumps(data))["suspects"][0]["defect"]["parameters"]["bit"] == 7
    assert set(data) == {field.name for field in dataclasses.fields(report)}
    assert dataclasses.astuple(report)[0] == "FAIL"
    copies = [copy.copy(report), copy.deepcopy(report)]
    assert copies[1].document is not report.document
    for number, copied in enumerate(copies):
        assert copied == report and copied.document == report.document
        copied.save(tmp_path / str(number))
    with pytest.raises(ValueError, match="was changed"):
        dataclasses.replace(report, verdict="PASS").save(tmp_path / "changed")


def test_a_recording_is_judged_again(tmp_path, small):
    first = halfrow.verify("mock,fault=stuck-data", tables=small, record=tmp_path / "run.rec")
    again = halfrow.verify(f"replay:{tmp_path / 'run.rec'}")
    assert (again.verdict, again.headline) == (first.verdict, first.headline) and first.verdict == "FAIL"
    assert again.board.kind == "replay"
    stand = {"board", "timeout", "require_hardware", "report", "record", "overwrite", "progress"}
    given = {"tables": small, "kernel": "keys", "frames": "builtin:black", "phase": "rggb", "repeat": 2, "seed": 2, "at_speed": 60.0,
             "within": 3.0, "fail_fast": True, "reconnect": 5.0, "retry_limit": 1.0, "take_over": True}
    assert set(inspect.signature(halfrow.verify).parameters) == stand | set(given)
    for vain in ({name: value} for name, value in given.items()):
        with pytest.raises(halfrow.InputError) as raised:
            halfrow.verify(f"replay:{tmp_path / 'run.rec'}", **vain)
        assert (raised.value.code, raised.value.parameters) == ("option-without-effect", {"option": next(iter(vain))})
        assert raised.value.remedy == "Leave it out, or judge a board."


def test_options_that_cannot_be_taken_are_named(small):
    for option, value in (("seed", -1), ("repeat", "twice"), ("timeout", "soon"), ("report", 3)):
        with pytest.raises(halfrow.InputError, match=f"^{option} is not what verify takes: .*; see help") as raised:
            halfrow.verify(tables=small, **{option: value})
        assert raised.value.code == "usage-value-wrong"


def test_a_board_is_judged_whatever_the_program_was_called_with(small, monkeypatch):
    monkeypatch.setattr(sys, "argv", [pathlib.PurePosixPath("program"), "\udcff"])
    assert halfrow.verify(tables=small, frames="builtin:black").passed
    monkeypatch.delattr(sys, "argv")
    assert halfrow.verify(tables=small, frames=np.zeros((32, 128), np.uint16)).passed


def test_what_does_not_fit_the_board_is_the_calls_fault():
    tables = halfrow.Tables.from_lens(halfrow.Lens("equidistant:2000", width=2592, height=64))
    with pytest.raises(halfrow.InputError) as raised:
        halfrow.verify("mock,max-width=1024", tables=tables)
    assert raised.value.remedy


def test_hardware_can_be_required(small):
    report = halfrow.verify(tables=small, require_hardware=True)
    assert (report.verdict, report.cause) == ("ERROR", "nothing-judged")
    assert report.error.code == report.finding.code and report.error.remedy


def test_progress_is_told_in_the_callers_thread(small):
    told = []
    report = halfrow.verify(tables=small, progress=lambda *event: told.append((threading.get_ident(), *event)))
    assert {event[0] for event in told} == {threading.get_ident()}
    kinds = [event[1] for event in told]
    assert kinds[-1] == "done" and {"step", "rows-expected", "frame", "rows"} < set(kinds)
    assert {frame.name for frame in report.frames} <= {event[2] for event in told if event[1] == "frame"}
    assert [event[2] for event in told if event[1] == "step"] == ["judge", "open", "link", "at-speed", "rules"]
    rows = sum(event[3] for event in told if event[1] == "rows")
    assert rows >= sum(frame.rows for frame in report.frames) > 0


def test_what_progress_raises_ends_the_run(small):
    class Enough(Exception):
        pass

    def stop(*_):
        raise Enough

    with pytest.raises(Enough):
        halfrow.verify(tables=small, repeat=1000, progress=stop)


def test_other_threads_run_on_meanwhile(small, steps_beside):
    until(lambda: steps_beside(lambda: halfrow.verify(tables=small)) > 0)


def test_several_boards_are_judged_at_once(small):
    verdicts = {}

    def judge(name, target):
        verdicts[name] = halfrow.verify(target, tables=small).verdict

    boards = {"left": "mock", "right": "mock,fault=stuck-data"}
    threads = [threading.Thread(target=judge, args=item) for item in boards.items()]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert verdicts == {"left": "PASS", "right": "FAIL"}


PROGRAM = textwrap.dedent(
    """
    import signal, sys, halfrow
    # Shells have what they start in the background ignore it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    tables = halfrow.Tables.from_lens(halfrow.Lens("equidistant:80", width=128, height=32))
    def told(kind, words, rows):
        if words:
            print(kind, words, flush=True)
    try:
        halfrow.verify(sys.argv[1], tables=tables, repeat=1000, reconnect=1e6, progress=told)
    except KeyboardInterrupt:
        print("interrupted", flush=True)
        # Whoever comes next finds the board free, without taking it over.
        print(halfrow.verify(sys.argv[1], tables=tables, frames=["builtin:bars"], at_speed=0).verdict, flush=True)
    """
)


@pytest.fixture
def served():
    """A board behind TCP, and its target. If it is not given back, the next host finds it held."""
    program = os.path.join(os.environ["HALFROW_PROGRAMS"], "halfrow")
    served = subprocess.Popen([program, "serve", "--tcp", "0"], stdout=subprocess.PIPE, text=True)
    yield served, next(word for word in served.stdout.readline().split() if word.startswith("tcp:"))
    served.kill()
    served.wait()


@pytest.fixture
def judging(served):
    """A program that judges that board for longer than the test waits."""
    with subprocess.Popen([sys.executable, "-c", PROGRAM, served[1]], stdout=subprocess.PIPE, text=True) as child:
        yield child
        child.kill()


def lines_until(child, wanted):
    """Reads the output of `child` up to a line that begins with `wanted`. A program that ignores the signal never prints it."""
    for line in child.stdout:
        if line.startswith(wanted):
            return
    pytest.fail(f"it ended without `{wanted}`")


def test_ctrl_c_ends_a_run_and_gives_the_board_back(judging):
    lines_until(judging, "frame")
    judging.send_signal(signal.SIGINT)
    lines_until(judging, "interrupted")
    assert judging.stdout.read() == "PASS\n" and judging.wait() == 0


def test_ctrl_c_ends_a_run_that_waits_for_a_board_to_come_back(judging, served):
    lines_until(judging, "frame")
    served[0].kill()
    lines_until(judging, "step wait")
    judging.send_signal(signal.SIGINT)
    lines_until(judging, "interrupted")
