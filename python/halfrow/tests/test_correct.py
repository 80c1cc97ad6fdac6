"""Corrected frames: the samples compared with the program, the memory with NumPy's own account of it and with the system's."""
import ctypes
import subprocess
import sys
import textwrap
import threading
import tracemalloc

import numpy as np
import pytest

import halfrow
from conftest import until


def noise(tables, seed=1):
    shape = (tables.height, tables.width)
    return np.random.default_rng(seed).integers(0, 2**tables.bits, shape, dtype=np.uint16)


@pytest.mark.parametrize("options", [{}, {"projection": "exact"}])
@pytest.mark.parametrize("kernel", ["hermite", "keys"])
def test_frames_are_corrected_as_by_the_program(tmp_path, program, opencv, options, kernel):
    tables = halfrow.Tables.from_lens(opencv, kernel=kernel, **options)
    frame = noise(tables)
    halfrow.write_frame(tmp_path / "in.pgm", frame)
    tables.write(tmp_path / "tables.json")
    arguments = ["correct", tmp_path / "in.pgm", "--model", "--tables", tmp_path / "tables.json", "-o", tmp_path / "out.pgm"]
    assert program(*arguments)[0] == 0
    theirs = halfrow.read_frame(tmp_path / "out.pgm")
    for path in halfrow.MODEL_PATHS:
        assert np.array_equal(halfrow.correct(frame, tables, path=path), theirs), path
    assert not np.array_equal(frame, theirs)


def test_every_path_and_kernel_gives_the_same_bits(small):
    frame = noise(small)
    for kernel in halfrow.KERNELS:
        first = halfrow.correct(frame, small, kernel=kernel, path="reference")
        for path in halfrow.MODEL_PATHS:
            assert np.array_equal(halfrow.correct(frame, small, kernel=kernel, path=path), first), (kernel, path)


def test_nothing_is_copied(small):
    tables = halfrow.Tables.from_lens()
    corrector, frame, out = halfrow.Corrector(tables), noise(tables), np.zeros((1080, 1920), np.uint16)
    before = out.ctypes.data
    assert corrector.correct(frame, out) is out and out.ctypes.data == before
    # NumPy reports its buffers to tracemalloc: none is made beside `out`, and one without `out`.
    tracemalloc.start()
    try:
        corrector.correct(frame, out)
        assert tracemalloc.get_traced_memory()[1] < frame.nbytes / 100
        tracemalloc.reset_peak()
        made = corrector.correct(frame)
        assert frame.nbytes <= tracemalloc.get_traced_memory()[1] < 1.01 * frame.nbytes
    finally:
        tracemalloc.stop()
    assert np.array_equal(made, out)


def test_nothing_is_copied_in_rust_either():
    """In a process of its own, whose most memory so far tells what each call adds to it."""
    measured = """
        import re, numpy, halfrow

        # Not ru_maxrss, which a process has from the one that started it.
        def most():
            return 1024 * int(re.search(r"VmHWM:\\s+(\\d+) kB", open("/proc/self/status").read())[1])

        def added(call):
            before = most()
            call()
            return most() - before

        tables = halfrow.Tables.from_lens(halfrow.Lens("equidistant:1500", width=2592, height=2048))
        corrector = halfrow.Corrector(tables)
        frame, out = (numpy.full((2048, 2592), value, numpy.uint16) for value in (1000, 0))
        print(frame.nbytes, added(lambda: corrector.correct(frame, out)), added(lambda: halfrow.demosaic(frame)))
    """
    found = subprocess.run([sys.executable, "-c", textwrap.dedent(measured)], check=True, capture_output=True, text=True)
    frame, corrected, demosaicked = map(int, found.stdout.split())
    assert corrected < frame / 2
    # The control: this copies the frame, and makes a picture.
    assert demosaicked > frame


def test_a_part_of_a_larger_memory_is_corrected_where_it_is(small):
    many = np.stack([noise(small, seed) for seed in range(3)])
    outs = np.zeros_like(many)
    halfrow.correct(many[1], small, out=outs[1])
    assert np.array_equal(outs[1], halfrow.correct(many[1].copy(), small))
    assert not outs[0].any() and not outs[2].any()


def refused(call, kind, word):
    with pytest.raises(kind) as raised:
        call()
    assert word in str(raised.value), raised.value


def test_other_arrays_are_refused_and_never_copied(small):
    frame = noise(small)
    correct = lambda frame, **options: halfrow.correct(frame, small, **options)  # noqa: E731
    refused(lambda: correct(frame.tolist()), TypeError, "list")
    refused(lambda: correct(frame.astype(np.float32)), TypeError, "float32")
    refused(lambda: correct(frame.astype(np.uint8)), TypeError, "uint8")
    refused(lambda: correct(frame.astype(np.int16)), TypeError, "int16")
    refused(lambda: correct(frame.astype(">u2")), TypeError, ">u2")
    refused(lambda: correct(frame[None]), ValueError, "3 dimensions")
    refused(lambda: correct(np.asfortranarray(frame)), ValueError, "ascontiguousarray")
    refused(lambda: correct(np.repeat(frame, 2, axis=1)[:, ::2]), ValueError, "ascontiguousarray")
    shifted = np.frombuffer(b"\0" + frame.tobytes(), np.uint8)[1:].view(np.uint16).reshape(frame.shape)
    refused(lambda: correct(shifted), ValueError, "aligned")
    read_only = np.zeros_like(frame)
    read_only.flags.writeable = False
    refused(lambda: correct(frame, out=read_only), ValueError, "read-only")
    refused(lambda: correct(frame, out=frame), ValueError, "shares memory")
    refused(lambda: correct(np.ma.masked_equal(frame, 0)), TypeError, "masked")
    # Not a copy of `out`: the result would be in that alone.
    for out in (np.zeros(frame.shape), np.asfortranarray(frame), np.ma.array(frame), frame.tolist()):
        refused(lambda: correct(frame, out=out), (TypeError, ValueError), "give out numpy.empty(frame.shape, numpy.uint16)")  # noqa: B023
    refused(lambda: correct(frame, path="fast"), ValueError, "fast")
    # A read-only input is not refused.
    frame.flags.writeable = False
    correct(frame)


# Arrays over the same memory that NumPy does not recognise as related: each has a base of its own.
VIEWS = {
    "frombuffer": lambda memory: np.frombuffer(memory, np.uint16),
    "memoryview": lambda memory: np.asarray(memoryview(memory).cast("H")),
    "ctypeslib": lambda memory: np.ctypeslib.as_array((ctypes.c_uint16 * (len(memory) // 2)).from_buffer(memory)),
}


@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
def test_an_out_in_the_frames_memory_is_refused_however_it_came_to_be(small, view):
    frame = noise(small)
    for apart in (0, 1, 128, frame.size - 1):
        memory = bytearray(frame.nbytes + 2 * apart)
        pair = [view(memory)[start:][: frame.size].reshape(frame.shape) for start in (0, apart)]
        assert np.shares_memory(*pair)
        for given, out in (pair, reversed(pair)):
            given[:] = frame
            refused(lambda: halfrow.correct(given, small, out=out), ValueError, "shares memory")
            assert np.array_equal(given, frame)


@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
def test_an_out_that_begins_where_the_frame_ends_is_taken(small, view):
    frame = noise(small)
    memory = bytearray(2 * frame.nbytes)
    pair = [view(memory)[start:][: frame.size].reshape(frame.shape) for start in (0, frame.size)]
    for given, out in (pair, reversed(pair)):
        given[:] = frame
        assert np.array_equal(halfrow.correct(given, small, out=out), halfrow.correct(frame, small))
        assert np.array_equal(given, frame)


def test_a_frame_that_does_not_fit_is_refused_by_its_code(small):
    for shape in [(32, 130), (31, 128), (0, 0), (32, 0)]:
        with pytest.raises(halfrow.InputError) as raised:
            halfrow.correct(np.zeros(shape, np.uint16), small)
        assert raised.value.code == "frame-does-not-fit-tables"
    with pytest.raises(halfrow.InputError) as raised:
        halfrow.correct(noise(small), small, out=np.zeros((32, 130), np.uint16))
    assert raised.value.code == "frame-does-not-fit-tables"


@pytest.mark.parametrize("place", [(0, 0), (5, 127), (31, 64)])
def test_a_sample_too_bright_is_named(small, place):
    frame = noise(small)
    frame[31, 127] = frame[place] = 4096
    with pytest.raises(halfrow.InputError) as raised:
        halfrow.correct(frame, small)
    assert raised.value.code == "frame-impossible"
    assert f"row {place[0]}, column {place[1]} is 4096" in str(raised.value)


def test_the_interpreters_lock_is_released(steps_beside):
    tables = halfrow.Tables.from_lens()
    corrector, frame = halfrow.Corrector(tables, path="reference"), noise(tables)
    # A call that keeps the lock can be told from one that releases it.
    assert steps_beside(lambda: sum(range(1_000_000))) == 0
    until(lambda: steps_beside(lambda: corrector.correct(frame)) > 0)


def test_threads_share_a_corrector(small):
    corrector = halfrow.Corrector(small)
    frames = [noise(small, seed) for seed in range(8)]
    expected = [halfrow.correct(frame, small) for frame in frames]
    found = [None] * 8

    def work(place):
        for _ in range(50):
            found[place] = corrector.correct(frames[place])

    threads = [threading.Thread(target=work, args=(place,)) for place in range(8)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert all(map(np.array_equal, found, expected))
