"""What is refused: with the codes of the program, and with what Python's own libraries raise."""
import pickle
import re

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
    frame = np.zeros((2, 64), np.uint16)
    halfrow.write_frame(tmp_path / "in.pgm", frame)
    there = {name: str(tmp_path / f"there.{name}") for name in ("json", "pgm")}
    other_name = str(tmp_path / "out.xyz")
    correct = ["correct", tmp_path / "in.pgm", "--model", "--width", "64", "--height", "2", "-o"]
    cases = [
        (lambda: halfrow.Tables.from_lens().write(there["json"]), ["tables", "-o", there["json"]], "file-exists"),
        (lambda: halfrow.Tables.from_lens().write(other_name), ["tables", "-o", other_name], "tables-format-unknown"),
        (lambda: halfrow.write_frame(there["pgm"], frame), [*correct, there["pgm"]], "file-exists"),
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
        with pytest.raises(halfrow.HalfrowError) as raised:
            call()
        exit_code, document = program(*arguments)
        error, told = raised.value, document["error"]
        assert (error.code, error.parameters) == (told["code"], told["parameters"]), arguments
        assert code in (None, error.code)
        assert isinstance(error, halfrow.InputError) == (exit_code == 2), arguments
        # The program names the flags of what the library has in words.
        named = [re.sub(r" \(--[a-z-]+\)", "", cause["message"]) for cause in told["causes"]]
        assert [cause.message for cause in error.causes] == named


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
    "call, code",
    [
        (lambda: halfrow.Lens(bits=9), "usage-value-wrong"),
        (lambda: halfrow.Lens("equidistant:wide"), "usage-value-wrong"),
        (lambda: halfrow.Tables.from_lens(rows="best"), "usage-value-wrong"),
        (lambda: halfrow.Tables.from_lens(projection="flat"), "usage-value-wrong"),
        (lambda: halfrow.Tables.from_lens(projection="exact", rows="fitted"), "usage-arguments-conflict"),
        (lambda: halfrow.Tables.from_lens(entries=100), "usage-arguments-conflict"),
        (lambda: halfrow.Tables.from_lens(halfrow.Lens(), projection="exact", entries=3), "grid-without-room"),
        (lambda: halfrow.verify(timeout=-1), "usage-value-wrong"),
        (lambda: halfrow.verify(at_speed=float("nan")), "usage-value-wrong"),
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
