"""What is refused: with the program's codes, and with the exceptions of Python's own libraries."""
import json
import os
import pathlib
import pickle
import re
import subprocess
import sys
import textwrap

import numpy as np
import pytest

import halfrow


def test_codes_are_those_of_the_program(tmp_path, program, opencv):
    broken = tmp_path / "broken.json"
    broken.write_text('{"datapath": 1, "width": 63}')
    other = tmp_path / "other.json"
    other.write_text('{"datapath": 3}')
    (tmp_path / "there.json").write_text("{}")
    (tmp_path / "there.pgm").write_text("")
    (tmp_path / "link.pgm").symlink_to("there.pgm")
    (tmp_path / "folder.json").mkdir()
    link, folder, nowhere = (str(tmp_path / name) for name in ("link.pgm", "folder.json", "no/x.pgm"))
    capitals = str(tmp_path / "T.MEM")
    halfrow.Tables.from_lens().write(capitals)
    frame = np.zeros((2, 64), np.uint16)
    halfrow.write_frame(tmp_path / "in.pgm", frame)
    there = {name: str(tmp_path / f"there.{name}") for name in ("json", "pgm")}
    other_name = str(tmp_path / "out.xyz")
    correct = ["correct", tmp_path / "in.pgm", "--model", "--width", "64", "--height", "2", "-o"]
    cases = [
        (lambda: halfrow.Tables.from_lens().write(there["json"]), ["tables", "-o", there["json"]], "file-exists"),
        (lambda: halfrow.Tables.from_lens().write(other_name), ["tables", "-o", other_name], "tables-format-unknown"),
        (lambda: halfrow.write_frame(there["pgm"], frame), [*correct, there["pgm"]], "file-exists"),
        (lambda: halfrow.write_frame(link, frame, overwrite=True), [*correct, link, "--overwrite"], "file-is-link"),
        (lambda: halfrow.write_frame(nowhere, frame), [*correct, nowhere], "folder-unusable"),
        (
            lambda: halfrow.Tables.from_lens().write(folder, overwrite=True),
            ["tables", "-o", folder, "--overwrite"],
            "file-is-no-regular-one",
        ),
        (lambda: halfrow.Tables.from_lens().write(capitals), ["tables", "-o", capitals], "file-exists"),
        (lambda: halfrow.Tables.from_lens().write("no.json/"), ["tables", "-o", "no.json/"], "file-is-no-regular-one"),
        (lambda: halfrow.write_frame("no.pgm/", frame), [*correct, "no.pgm/"], "file-is-no-regular-one"),
        (lambda: halfrow.write_frame(other_name, frame), [*correct, other_name], "frame-extension-unknown"),
        (lambda: halfrow.Tables.read(broken), ["verify", "--tables", broken], "table-file-wrong"),
        (lambda: halfrow.Tables.read(other), ["verify", "--tables", other], "table-file-of-other-datapath"),
        (lambda: halfrow.Tables.from_lens("no.yml"), ["verify", "--lens", "no.yml"], "lens-file-unreadable"),
        (lambda: halfrow.Tables.from_lens(kernel="cubic"), ["verify", "--kernel", "cubic"], "kernel-not-found"),
        (lambda: halfrow.Lens(width=63), ["verify", "--width", "63"], "geometry-impossible"),
        (lambda: halfrow.verify("bench"), ["verify", "--board", "bench"], "target-kind-unknown"),
        (lambda: halfrow.verify("mock,faults=1"), ["verify", "--board", "mock,faults=1"], "target-options-wrong"),
        (lambda: halfrow.verify("serial:/dev/none"), ["verify", "--board", "serial:/dev/none"], None),
        (lambda: halfrow.verify("replay:" + str(broken)), ["verify", "--board", f"replay:{broken}"], None),
        (lambda: halfrow.verify(frames=[broken]), ["verify", "--frame", broken], "frame-file-not-understood"),
    ]
    for call, arguments, code in cases:
        refused_as_by_the_program(program, call, arguments, code)


def refused_as_by_the_program(program, call, arguments, code):
    with pytest.raises(halfrow.HalfrowError) as raised:
        call()
    exit_code, document = program(*arguments)
    error, told = raised.value, document["error"]
    named = dict(told["parameters"])
    for of_option in {"option", "first", "second"} & set(named):
        option = named[of_option].removeprefix("--").replace("-", "_")
        named[of_option] = {"frame": "frames", "output": "path"}.get(option, option)
    assert (error.code, error.parameters) == (told["code"], named), arguments
    assert code in (None, error.code)
    assert isinstance(error, halfrow.InputError) == (exit_code == 2), arguments
    # The program adds the flags for what the library names in words.
    causes = [re.sub(r" \(--[a-z-]+\)", "", cause["message"]) for cause in told["causes"]]
    assert [cause.message for cause in error.causes] == causes


SMALL = ["--radius", 80, "--width", 128, "--height", 32]


def verify(options, board="mock", **named):
    """A call of verify here with `board` and the arguments `named`, and the same call of the program with `options`."""
    tables = halfrow.Tables.from_lens(halfrow.Lens("equidistant:80", width=128, height=32))
    return lambda: halfrow.verify(board, tables=tables, **named), ["verify", *SMALL, *options]


def test_codes_of_runs_are_those_of_the_program(tmp_path, program, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there.rec").write_text("")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "notes").write_text("")
    (tmp_path / "link.rec").symlink_to("there.rec")
    halfrow.write_frame("ok.pgm", np.zeros((32, 128), np.uint16))
    for name, shape in (("big.pgm", (64, 128)), ("narrow.pgm", (32, 4))):
        halfrow.write_frame(name, np.zeros(shape, np.uint16))
    for case, code in [
        (verify(["--record", "there.rec"], record="there.rec"), "file-exists"),
        (verify(["--record", "link.rec", "--overwrite"], record="link.rec", overwrite=True), "file-is-link"),
        (verify(["--record", "folder", "--overwrite"], record="folder", overwrite=True), "file-is-no-regular-one"),
        (verify(["--record", "no/x.rec"], record="no/x.rec"), "folder-unusable"),
        (verify(["--record", "new/"], record="new/"), "file-is-no-regular-one"),
        (verify(["--report", "no/rep"], report="no/rep"), "folder-unusable"),
        (verify(["--report", "folder"], report="folder"), "folder-is-no-report"),
        (verify(["--record", "x", "--report", "x"], record="x", report="x"), "outputs-share-a-file"),
        (verify(["--board", "sim,trace=x", "--record", "x"], board="sim,trace=x", record="x"), "outputs-share-a-file"),
        (verify(["--frame", "ok.pgm", "--frame", "big.pgm"], frames=["ok.pgm", "big.pgm"]), "frame-of-other-size"),
        (verify(["--frame", "narrow.pgm"], frames="narrow.pgm"), "frame-of-other-size"),
        (verify(["--within", 2, "--frame", "ok.pgm"], within=2, frames="ok.pgm"), "option-without-effect"),
        (verify(["--within", 2, "--repeat", 3], within=2, repeat=3), "option-without-effect"),
        (verify(["--within", 2, "--record", "y"], within=2, record="y"), "usage-arguments-conflict"),
        (verify(["--reconnect=5", "--record", "y"], reconnect=5, record="y"), "option-without-effect"),
        (verify(["--at-speed=-1"], at_speed=-1), "option-is-no-time"),
        (verify(["--reconnect=-1"], reconnect=-1), "option-is-no-time"),
        *((verify([f"--timeout={wrong}"], timeout=float(wrong)), "option-is-no-time") for wrong in (0, -1, "nan", "1e300")),
        *((verify([f"--within={wrong}"], within=float(wrong)), "usage-value-wrong") for wrong in (0, -1, "nan", "1e7")),
        (verify(["--repeat=0"], repeat=0), "usage-value-wrong"),
        (verify(["--retry-limit=101"], retry_limit=101), "usage-value-wrong"),
    ]:
        refused_as_by_the_program(program, *case, code)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["big.pgm", "folder", "link.rec", "narrow.pgm", "ok.pgm", "there.rec"]


@pytest.mark.parametrize("call", [lambda path: halfrow.Kernel().write(path), lambda path: halfrow.verify(record=path)])
def test_an_output_without_a_files_name_is_the_calls_fault(call):
    for path in ("", "new/"):
        with pytest.raises(halfrow.InputError) as raised:
            call(path)
        assert raised.value.code == "file-is-no-regular-one"


def test_no_input_of_a_run_is_overwritten(tmp_path, program, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tables = halfrow.Tables.from_lens(halfrow.Lens("equidistant:80", width=128, height=32))
    tables.write("t.json")
    halfrow.Kernel("keys").write("k.json")
    halfrow.write_frame("f.pgm", np.zeros((32, 128), np.uint16))
    os.link("f.pgm", "link.pgm")
    # A file name need not be valid text.
    odd = os.fsdecode(b"odd-\xff.pgm")
    os.link("f.pgm", odd)
    assert halfrow.verify("mock", tables=tables, frames="builtin:black", at_speed=0, record="r.rec").passed
    of_file = halfrow.Tables.read("t.json", kernel="k.json")
    for name, call, arguments in [
        ("f.pgm", dict(tables=tables, frames="f.pgm"), [*SMALL, "--frame", "f.pgm"]),
        ("link.pgm", dict(tables=tables, frames="f.pgm"), [*SMALL, "--frame", "f.pgm"]),
        ("t.json", dict(tables=of_file), ["--tables", "t.json"]),
        ("k.json", dict(tables=of_file), ["--tables", "t.json", "--kernel", "k.json"]),
        ("k.json", dict(tables=tables, kernel="k.json"), [*SMALL, "--kernel", "k.json"]),
        ("k.json", dict(tables=tables, kernel=halfrow.Kernel("k.json")), [*SMALL, "--kernel", "k.json"]),
        ("r.rec", dict(board="replay:r.rec"), ["--board", "replay:r.rec"]),
        (odd, dict(tables=tables, frames=odd), [*SMALL, "--frame", odd]),
    ]:
        before = (tmp_path / name).read_bytes()
        judged = lambda: halfrow.verify(**call, record=name, overwrite=True)  # noqa: B023, E731
        refused_as_by_the_program(
            program, judged, ["verify", *arguments, "--record", name, "--overwrite"], "input-would-be-overwritten"
        )
        assert (tmp_path / name).read_bytes() == before, name


def test_no_file_that_tables_or_a_kernel_came_from_is_overwritten(tmp_path, program, monkeypatch, opencv):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lens.json").write_bytes(opencv.read_bytes())
    halfrow.Kernel("keys").write("k.json")
    made = halfrow.Tables.from_lens("lens.json", kernel="k.json")
    made.write("t.json")
    made.write("t.mem")
    read, images = halfrow.Tables.read("t.json"), halfrow.Tables.read("t.mem")
    tables = ["tables", "--lens", "lens.json", "--kernel", "k.json", "--overwrite", "-o"]
    for name, call, arguments in [
        ("lens.json", made.write, [*tables, "lens.json"]),
        ("k.json", made.write, [*tables, "k.json"]),
        ("k.json", made.kernel.write, None),
        ("t.json", read.write, None),
        ("t.json", read.kernel.write, None),
        ("t.json", halfrow.Tables.from_lens("lens.json", kernel=read.kernel).write, None),
        ("t.steps.mem", images.kernel.write, None),
    ]:
        before = (tmp_path / name).read_bytes()
        written = lambda: call(name, overwrite=True)  # noqa: B023, E731
        if arguments:
            refused_as_by_the_program(program, written, arguments, "input-would-be-overwritten")
        else:
            with pytest.raises(halfrow.InputError) as raised:
                written()
            assert raised.value.code == "input-would-be-overwritten", name
        assert (tmp_path / name).read_bytes() == before, name
    made.write("other.json")
    made.write("other.json", overwrite=True)



def test_an_error_says_what_is_wrong_and_what_to_do(tmp_path):
    with pytest.raises(halfrow.InputError) as raised:
        halfrow.Lens(tmp_path / "no.yml")
    error = raised.value
    assert isinstance(error, ValueError)
    assert error.code == "lens-file-unreadable" and error.parameters == {"path": str(tmp_path / "no.yml")}
    assert [cause.code for cause in error.causes] == ["io-not-found"]
    assert str(tmp_path / "no.yml") in str(error) and error.causes[0].message in str(error)
    assert error.remedy
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), again.causes) == (type(error), str(error), error.causes)


@pytest.mark.parametrize(
    "call, name, shown",
    [
        (lambda tables, frame: halfrow.correct(frame, tables, kernel=3), "kernel", "3"),
        (lambda tables, _: halfrow.Corrector(tables, kernel=3), "kernel", "3"),
        (lambda tables, _: halfrow.verify(tables=tables, kernel=3), "kernel", "3"),
        (lambda *_: halfrow.Tables.from_lens(kernel=b"".join), "kernel", "of type builtin"),
        (lambda *_: halfrow.Tables.read("t.json", kernel=np.zeros((65, 5))), "kernel", "of type ndarray"),
        (lambda _, frame: halfrow.correct(frame, "t.json"), "tables", "'t.json'"),
        (lambda *_: halfrow.Corrector("t.json"), "tables", "'t.json'"),
        (lambda *_: halfrow.Tables.from_lens(3), "lens", "3"),
        (lambda *_: halfrow.Lens(3), "lens", "3"),
        (lambda *_: halfrow.Lens(b"x"), "lens", "b'x'"),
        (lambda *_: halfrow.Kernel(3), "name", "3"),
        (lambda *_: halfrow.Lens().column("x"), "degrees", "'x'"),
        (lambda tables, _: halfrow.verify(tables=tables, progress=3), "progress", "3"),
        (lambda *_: halfrow.Tables.from_lens(projection="exact", entries=-1), "entries", "-1"),
        (lambda *_: halfrow.Lens(width=-2), "width", "-2"),
        (lambda *_: halfrow.Lens(height=2.5), "height", "2.5"),
        (lambda *_: halfrow.Lens(bits="12"), "bits", "'12'"),
        (lambda *_: halfrow.Lens(centre_x="middle"), "centre_x", "'middle'"),
        (lambda *_: halfrow.Lens(centre_y="middle"), "centre_y", "'middle'"),
        (lambda *_: halfrow.Lens(field_of_view=None), "field_of_view", "None"),
        (lambda *_: halfrow.Lens().frame("noise", seed=-1), "seed", "-1"),
        (lambda *_: halfrow.read_frame("x.raw", raw="u8", width=-1, height=1), "width", "-1"),
        (lambda *_: halfrow.write_frame("x.pgm", np.zeros((2, 64), np.uint16), bits=-1), "bits", "-1"),
        (lambda *_: halfrow.Kernel.from_weights(np.zeros((65, 5), np.float32)), "weights", "of type ndarray"),
        (lambda *_: halfrow.read_frame(b"x.pgm"), "path", "b'x.pgm'; give a path as str or os.PathLike"),
        (lambda *_: halfrow.write_frame(b"x.pgm", np.zeros((2, 64), np.uint16)), "path", "b'x.pgm'"),
        (lambda *_: halfrow.Tables.read(b"t.json"), "path", "b't.json'"),
        (lambda *_: halfrow.Tables.from_lens().write(b"t.json"), "path", "b't.json'"),
        (lambda *_: halfrow.Kernel().write(b"k.json"), "path", "b'k.json'"),
        (lambda *_: halfrow.verify(frames=b"x.pgm"), "frames[0]", "b'x.pgm'; give a path as str or os.PathLike"),
        (lambda *_: halfrow.verify(frames=["builtin:bars", b"x.pgm"]), "frames[1]", "b'x.pgm'"),
        (lambda *_: halfrow.verify(None), "board", "None"),
        (lambda *_: halfrow.verify(pathlib.PurePosixPath("x")), "board", "PurePosixPath('x')"),
        (lambda *_: halfrow.verify("serial:/dev/\udcff"), "board", r"'serial:/dev/\udcff'"),
    ],
)
def test_an_argument_of_another_kind_is_named_with_what_it_takes(small, call, name, shown):
    with pytest.raises(halfrow.InputError) as raised:
        call(small, np.zeros((small.height, small.width), np.uint16))
    assert raised.value.code == "usage-value-wrong"
    assert raised.value.message.startswith(f"{name} is {shown}") and raised.value.remedy
    assert "\n" not in str(raised.value)


def test_a_radius_that_is_none_is_refused_with_what_to_write():
    with pytest.raises(halfrow.InputError) as raised:
        halfrow.Lens("equidistant:wide")
    assert raised.value.message.startswith("`wide` is no radius; ")
    assert raised.value.remedy == "Give equidistant:RADIUS, that of the image of 180 degrees in pixels."


def test_a_run_that_gets_no_thread_is_an_error():
    judged = textwrap.dedent(
        """
        import halfrow
        try:
            halfrow.verify(frames=["builtin:bars"], at_speed=0)
        except halfrow.HalfrowError as error:
            print(error.code, error.remedy)
        """
    )
    # NumPy would not get a thread either; with this variable it does not ask for one.
    alone = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    refused = ["strace", "-f", "-qq", "-o", os.devnull, "-e", "inject=clone,clone3:error=EAGAIN"]
    ended = subprocess.run([*refused, sys.executable, "-c", judged], env=alone, capture_output=True, text=True)
    remedy = "End other programs, or allow this user more processes, then run again."
    assert ended.stdout == f"run-thread-missing {remedy}\n", ended.stderr


@pytest.mark.parametrize("error, code", [("ENOSPC", 3), ("EIO", 3), ("EACCES", 2)])
def test_a_full_disk_is_no_fault_of_the_call(tmp_path, error, code):
    """An InputError where the program ends with 2."""
    refused = ["strace", "-f", "-qq", "-o", os.devnull, "-e", f"inject=mkdir:error={error}"]
    program = pathlib.Path(os.environ["HALFROW_PROGRAMS"]).resolve() / "halfrow"
    by_program = [*refused, program, "verify", "--width", "64", "--height", "2", "--report", "report", "--json"]
    ended = subprocess.run(by_program, cwd=tmp_path, capture_output=True, text=True)
    assert ended.returncode == code, ended.stderr
    judged = textwrap.dedent(
        """
        import halfrow
        try:
            halfrow.verify(tables=halfrow.Tables.from_lens(halfrow.Lens(width=64, height=2)), report="report")
        except halfrow.HalfrowError as error:
            print(type(error).__name__, error.code, error.remedy)
        """
    )
    by_package = subprocess.run([*refused, sys.executable, "-c", judged], cwd=tmp_path, capture_output=True, text=True)
    told = json.loads(ended.stdout)["error"]
    expected = ["InputError" if code == 2 else "HalfrowError", told["code"], *told["remedy"].split()]
    assert by_package.stdout.split() == expected, by_package.stderr


@pytest.mark.parametrize(
    "call, code",
    [
        (lambda: halfrow.Lens(bits=9), "usage-value-wrong"),
        (lambda: halfrow.Lens("equidistant:wide"), "usage-value-wrong"),
        (lambda: halfrow.Tables.from_lens(rows="best"), "usage-value-wrong"),
        (lambda: halfrow.Tables.from_lens(projection="flat"), "usage-value-wrong"),
        (lambda: halfrow.Tables.from_lens(projection="exact", rows="fitted"), "usage-arguments-conflict"),
        (lambda: halfrow.Tables.from_lens(entries=100), "usage-arguments-conflict"),
        (lambda: halfrow.Tables.from_lens(nodes_every=32), "usage-arguments-conflict"),
        (lambda: halfrow.Tables.from_lens(projection="exact", nodes_every=33), "usage-value-wrong"),
        (lambda: halfrow.Tables.from_lens(halfrow.Lens(), projection="exact", entries=3), "grid-without-room"),
        (lambda: halfrow.verify(timeout=-1), "option-is-no-time"),
        (lambda: halfrow.verify(at_speed=float("nan")), "option-is-no-time"),
        (lambda: halfrow.verify(frames=[]), "usage-value-wrong"),
        (lambda: halfrow.verify(frames=(), within=3), "usage-value-wrong"),
        (lambda: halfrow.verify(frames=3), "usage-value-wrong"),
        (lambda: halfrow.verify(repeat=np.array([1, 2])), "usage-value-wrong"),
        (lambda: halfrow.verify(repeat=0), "usage-value-wrong"),
        (lambda: halfrow.verify(retry_limit=101), "usage-value-wrong"),
        (lambda: halfrow.Corrector(halfrow.Tables.from_lens(), path="fast"), "model-path-unknown"),
        (lambda: halfrow.verify(phase="rgb"), "bayer-phase-unknown"),
        (lambda: halfrow.verify(frames=["builtin:nothing"]), "builtin-frame-unknown"),
        (lambda: halfrow.read_frame("x.raw", raw="u8"), "usage-arguments-conflict"),
        (lambda: halfrow.read_frame("x.raw", raw="u7", width=2, height=2), "raw-layout-unknown"),
    ],
)
def test_a_wrong_value_is_named(call, code):
    with pytest.raises(halfrow.InputError) as raised:
        call()
    assert raised.value.code == code
    assert raised.value.remedy or code in ("bayer-phase-unknown", "builtin-frame-unknown", "raw-layout-unknown")
