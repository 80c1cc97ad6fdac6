"""Tables, lenses and kernels, compared with the program and with arithmetic done here."""
import json
import pickle
import subprocess
import sys
import textwrap

import numpy as np
import pytest

import halfrow


def of_file(path):
    return json.loads(path.read_text())


@pytest.mark.parametrize(
    "options, flags",
    [
        ({}, []),
        ({"rows": "equation-9"}, ["--rows", "equation-9"]),
        ({"projection": "exact"}, ["--projection", "exact"]),
        ({"projection": "exact", "nodes_every": 32}, ["--projection", "exact", "--nodes-every", "32"]),
        ({"projection": "exact", "nodes_every": 64}, ["--projection", "exact", "--nodes-every", "64"]),
        ({"kernel": "keys"}, ["--kernel", "keys"]),
    ],
)
def test_tables_are_those_of_the_program(tmp_path, program, opencv, options, flags):
    written = tmp_path / "theirs.json"
    kernel = [] if "--kernel" in flags else ["--kernel", "hermite"]
    assert program("tables", "--lens", opencv, *flags, *kernel, "-o", written)[0] == 0
    theirs = of_file(written)
    tables = halfrow.Tables.from_lens(opencv, **options)
    assert (tables.width, tables.height, tables.bits, tables.centre_x) == (1280, 720, 12, theirs["centre2"] / 2)
    assert tables.units.tolist() == theirs.get("step", theirs.get("grid"))
    nodes = np.array(theirs["kernel"])
    assert np.array_equal(tables.kernel.weights * 2**14, nodes)
    assert tables.datapath == theirs["datapath"]
    assert tables == halfrow.Tables.read(written)


def test_row_factors_are_those_of_equation_9():
    lens = halfrow.Lens("equidistant:80", width=128, height=32)
    tables = halfrow.Tables.from_lens(lens)
    y = np.arange(32) - 15.5
    expected = np.floor(2**24 * np.sqrt(80**2 - y**2) / 80 + 0.5)
    assert np.array_equal(tables.units, expected)
    assert np.array_equal(tables.row_factors, expected / 2**24)
    # Every sample comes from the column that its factor gives (DATAPATH.md), to within half of 2^-13.
    columns = np.arange(128)
    sources = 63.5 + tables.row_factors[:, None] * (columns - 63.5)
    assert np.abs(tables.sources() - sources).max() <= 2**-14


def test_the_papers_lens_is_the_default():
    lens = halfrow.Lens()
    assert (lens.width, lens.height, lens.bits, lens.field_of_view) == (1920, 1080, 12, 180)
    # f = 1.55 mm, pixels of 2.2 um: R = f · pi/2.
    assert lens.radius == pytest.approx(1.55 / 0.0022 * np.pi / 2)
    assert lens.centre == (959.5, 539.5)
    assert lens.column(45) == pytest.approx(lens.radius / 2)


def test_a_calibrated_lens_images_rays_as_its_polynomial_says(opencv):
    # fx and D from the file; r(theta) is OpenCV's: theta·(1 + k1·theta² + …).
    k = [-0.0125, 0.0031, -0.0042, 0.0007]
    theta = np.radians(60)
    r = theta * (1 + sum(k * theta ** (2 * n) for n, k in enumerate(k, 1)))
    lens = halfrow.Lens(opencv)
    assert lens.column(60) == pytest.approx(552.25 * r)
    assert lens.centre == (641.5, 358.25)
    halved = halfrow.Lens(opencv, width=640, height=360)
    assert halved.column(60) == pytest.approx(552.25 * r / 2)


def test_tables_come_back_from_their_files(tmp_path, small):
    for name in ("tables.json", "tables.mem"):
        small.write(tmp_path / name)
        assert halfrow.Tables.read(tmp_path / name) == small
        with pytest.raises(halfrow.InputError) as raised:
            small.write(tmp_path / name)
        assert raised.value.code == "file-exists"
        small.write(tmp_path / name, overwrite=True)
    other = halfrow.Tables.read(tmp_path / "tables.json", kernel="linear")
    assert other != small and other.kernel == halfrow.Kernel("linear")


def test_a_file_may_be_a_pipe_that_another_thread_fills(tmp_path, small, opencv):
    """In a process of its own, since one that keeps the interpreter's lock would wait forever."""
    read = """
        import os, sys, threading, halfrow

        def through_a_pipe(read, path):
            os.mkfifo("pipe.json")
            filled = threading.Thread(target=lambda: open("pipe.json", "wb").write(open(path, "rb").read()))
            filled.start()
            found = read("pipe.json")
            filled.join()
            os.remove("pipe.json")
            return found

        lens = through_a_pipe(halfrow.Lens, sys.argv[1])
        assert lens.radius == halfrow.Lens(sys.argv[1]).radius
        assert through_a_pipe(halfrow.Kernel, "kernel.json") == halfrow.Kernel("keys")
        assert through_a_pipe(halfrow.Tables.read, "tables.json") == halfrow.Tables.read("tables.json")
    """
    halfrow.Kernel("keys").write(tmp_path / "kernel.json")
    small.write(tmp_path / "tables.json")
    subprocess.run([sys.executable, "-c", textwrap.dedent(read), opencv], check=True, cwd=tmp_path, timeout=100)


@pytest.mark.parametrize("name", halfrow.KERNELS)
def test_a_kernel_is_its_weights(tmp_path, name):
    kernel = halfrow.Kernel(name)
    assert kernel.weights.shape == (65, 5)
    assert halfrow.Kernel.from_weights(kernel.weights) == kernel
    assert kernel.taps == (7 if kernel.weights[:, [0, 4]].any() else 5)
    kernel.write(tmp_path / "kernel.json")
    assert halfrow.Kernel(tmp_path / "kernel.json") == kernel


def test_weights_that_would_be_read_wrongly_are_refused():
    weights = halfrow.Kernel("keys").weights
    # Nodes 44 bytes apart, and nodes that begin at an odd address.
    field = np.zeros(65, [("weights", "f8", (5,)), ("node", "i4")])["weights"]
    odd = np.zeros(weights.nbytes + 1, np.uint8)[1:].view(np.float64).reshape(weights.shape)
    for array in (field, odd):
        array[:] = weights
        with pytest.raises(halfrow.InputError, match="not aligned") as raised:
            halfrow.Kernel.from_weights(array)
        assert raised.value.code == "usage-value-wrong"
        assert halfrow.Kernel.from_weights(np.array(array)) == halfrow.Kernel("keys")
    with pytest.raises(halfrow.InputError, match="masked"):
        halfrow.Kernel.from_weights(np.ma.array(weights, mask=weights > 1))
    for array in (np.asfortranarray(weights), weights[::-1].copy()[::-1], np.stack([weights, weights], 2)[..., 1]):
        assert halfrow.Kernel.from_weights(array) == halfrow.Kernel("keys")


def test_ctrl_c_ends_the_search_for_a_grid():
    """The process ends while the search goes on, for many seconds, in a thread of its own."""
    made = """
        import os, signal, threading, time, halfrow

        def name(task):
            try:
                return open(f"/proc/self/task/{task}/comm").read()
            # It ended after it was listed.
            except OSError:
                return None

        def searches():
            return any(name(task) == "run\\n" for task in os.listdir("/proc/self/task"))

        def interrupt(thread):
            while not searches():
                time.sleep(0.01)
            signal.pthread_kill(thread, signal.SIGINT)

        # The shell has commands in the background ignore it.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        threading.Thread(target=interrupt, args=[threading.get_ident()], daemon=True).start()
        try:
            halfrow.Tables.from_lens(halfrow.Lens(width=640, height=480), projection="exact", entries=8192)
        except KeyboardInterrupt:
            print("interrupted", searches())
    """
    ended = subprocess.run([sys.executable, "-c", textwrap.dedent(made)], capture_output=True, text=True, timeout=100)
    assert ended.stdout == "interrupted True\n", ended.stderr


def test_notes_stay_with_what_they_are_about(tmp_path, small):
    about = {"who": "unit 7", "when": [2026, None, 0.1]}

    def noted(name):
        path = tmp_path / name
        path.write_text(json.dumps({**of_file(path), "about": about}))
        return path

    def notes(written, name):
        written.write(tmp_path / name)
        return of_file(tmp_path / name).get("about")

    small.write(tmp_path / "tables.json")
    halfrow.Kernel("keys").write(tmp_path / "kernel.json")
    tables, kernel = noted("tables.json"), noted("kernel.json")
    assert notes(halfrow.Tables.read(tables), "again.json") == about
    assert notes(halfrow.Kernel(kernel), "kernel_again.json") == about
    assert notes(halfrow.Tables.from_lens(kernel=kernel).kernel, "kernel_of_tables.json") == about
    # The notes may describe the kernel that was replaced.
    assert notes(halfrow.Tables.read(tables, kernel=kernel), "other.json") is None
    assert notes(halfrow.Tables.read(tables).kernel, "its_kernel.json") is None
    assert halfrow.Tables.read(tables) == small


@pytest.mark.parametrize("kind", [halfrow.Lens, halfrow.Kernel, halfrow.Tables.from_lens])
def test_what_is_no_data_stays_in_its_process(kind):
    with pytest.raises(TypeError, match="cannot pickle"):
        pickle.dumps(kind())


def test_linear_weights_are_straight_lines():
    x = np.arange(65) / 32
    expected = np.zeros((65, 5))
    expected[:, 2] = x / 2
    assert np.array_equal(halfrow.Kernel("linear").weights, expected)
