"""Frames in files and built-in frames, compared with the program and with other programs' formats."""
import numpy as np
import pytest

import halfrow


def test_a_pgm_is_read_as_its_bytes_say(tmp_path):
    samples = np.array([[0, 1, 300, 4095], [7, 8, 9, 10]], np.uint16)
    (tmp_path / "a.pgm").write_bytes(b"P5 4 2 4095\n" + samples.astype(">u2").tobytes())
    found = halfrow.read_frame(tmp_path / "a.pgm")
    assert found.dtype == np.uint16 and found.flags.c_contiguous and np.array_equal(found, samples)


@pytest.mark.parametrize("name", ["a.pgm", "a.png", "a.tif", "a.dng"])
@pytest.mark.parametrize("bits", [8, 10, 12])
def test_a_frame_comes_back_from_its_file(tmp_path, name, bits):
    frame = np.random.default_rng(bits).integers(0, 2**bits, (6, 8), dtype=np.uint16)
    halfrow.write_frame(tmp_path / name, frame, bits=bits)
    assert np.array_equal(halfrow.read_frame(tmp_path / name, bits=bits), frame)
    with pytest.raises(halfrow.InputError) as raised:
        halfrow.write_frame(tmp_path / name, frame, bits=bits)
    assert raised.value.code == "file-exists"


def test_samples_without_a_header_are_read_in_their_layout(tmp_path):
    frame = np.arange(48, dtype=np.uint16).reshape(6, 8)
    (tmp_path / "a.bin").write_bytes(frame.tobytes())
    found = halfrow.read_frame(tmp_path / "a.bin", raw="u16le", width=8, height=6)
    assert np.array_equal(found, frame)


def test_built_in_frames_are_those_of_the_program(tmp_path, program):
    flags = ["--lens", "equidistant:80", "--width", 128, "--height", 32]
    assert program("frames", *flags, "-o", tmp_path)[0] == 0
    lens = halfrow.Lens("equidistant:80", width=128, height=32)
    for name in halfrow.BUILTIN_FRAMES:
        assert np.array_equal(lens.frame(name), halfrow.read_frame(tmp_path / f"{name}.pgm")), name


def test_a_picture_to_look_at_has_three_colours():
    frame = np.zeros((4, 6), np.uint16)
    frame[0::2, 1::2] = 4095
    picture = halfrow.demosaic(frame)
    assert (picture.shape, picture.dtype) == ((4, 6, 3), np.uint8)
    # In grbg, these are the red samples.
    assert (picture == [255, 0, 0]).all()
    assert (halfrow.demosaic(frame, phase="gbrg") == [0, 0, 255]).all()


def test_frames_of_odd_width_or_too_bright_are_refused(tmp_path):
    for frame, word in [(np.zeros((2, 3), np.uint16), "odd"), (np.full((2, 2), 256, np.uint16), "256")]:
        with pytest.raises(halfrow.InputError, match=word):
            halfrow.write_frame(tmp_path / "a.pgm", frame, bits=8)
    assert not list(tmp_path.iterdir())
