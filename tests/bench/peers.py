"""How long OpenCV and NumPy take for the same frame on one thread. It is called like halfrow-bench (src/main.rs)."""

import sys
import time
import zlib

import cv2
import numpy as np

WIDTH, HEIGHT, RADIUS, BITS = 1920, 1080, 1106.697, 12
ONE = 1 << 24


def golden_frame():
    places = np.arange(WIDTH * HEIGHT, dtype=np.uint64)
    return ((places * 2654435761 % 2**32) >> 20).astype(np.uint16).reshape(HEIGHT, WIDTH)


def steps():
    y = np.arange(HEIGHT) - (HEIGHT - 1) / 2
    return np.floor(ONE * np.sqrt(RADIUS * RADIUS - y * y) / RADIUS + 0.5).astype(np.int64)


def maps(width, shrink):
    """OpenCV's own fixed-point maps, made once: the source of each output, on its own row."""
    columns = np.arange(width) - (width - 1) / 2
    x = ((width - 1) / 2 + columns[None, :] * shrink[:, None]).astype(np.float32)
    y = np.repeat(np.arange(HEIGHT, dtype=np.float32)[:, None], width, 1)
    return cv2.convertMaps(x, y, cv2.CV_16SC2)


def remap(picture, where, out):
    return cv2.remap(picture, *where, cv2.INTER_CUBIC, dst=out, borderMode=cv2.BORDER_REPLICATE)


class Grey:
    """The raw frame treated as a grey picture: wrong for Bayer, but what the speed of remap is usually quoted for."""

    def __init__(self, frame, shrink):
        self.frame, self.maps, self.out = frame, maps(WIDTH, shrink), np.empty_like(frame)

    def __call__(self):
        remap(self.frame, self.maps, self.out)


class Planes:
    """The two colours of each row separately: split, two remaps, merge."""

    def __init__(self, frame, shrink):
        self.frame, self.out = frame, np.empty_like(frame)
        columns = WIDTH // 2
        self.parts = []
        for colour in range(2):
            # Sample c of this colour is column 2c + colour of the row.
            source = (2 * np.arange(columns) + colour - (WIDTH - 1) / 2)[None, :] * shrink[:, None] + (WIDTH - 1) / 2
            x = ((source - colour) / 2).astype(np.float32)
            y = np.repeat(np.arange(HEIGHT, dtype=np.float32)[:, None], columns, 1)
            plane = np.empty((HEIGHT, columns), np.uint16)
            self.parts.append((colour, cv2.convertMaps(x, y, cv2.CV_16SC2), plane, np.empty_like(plane)))

    def __call__(self):
        for colour, where, plane, corrected in self.parts:
            np.copyto(plane, self.frame[:, colour::2])
            self.out[:, colour::2] = remap(plane, where, corrected)


class Demosaicked:
    """The conventional way: demosaic, then one remap of three channels."""

    def __init__(self, frame, shrink):
        self.frame, self.maps = frame, maps(WIDTH, shrink)
        self.picture, self.out = (np.empty((HEIGHT, WIDTH, 3), np.uint16) for _ in range(2))

    def __call__(self):
        cv2.cvtColor(self.frame, cv2.COLOR_BayerGB2BGR, dst=self.picture)
        remap(self.picture, self.maps, self.out)


class Datapath:
    """The integer datapath (DATAPATH.md), vectorised, with sources and weights made once, like remap's maps."""

    def __init__(self, frame, _shrink):
        self.frame = frame
        j, q, c = np.arange(WIDTH)[None, :], steps()[:, None], WIDTH - 1
        rounded = (c * ONE + (2 * j - c) * q + (1 << 11)) >> 12
        n = rounded >> 13
        base = n - ((n ^ j) & 1)
        x = rounded - (base << 13)
        self.taps = [self.place(base + tap) for tap in range(-1, 4)]
        self.weights = [self.weight(weight, x >> 8, x & 255) for weight in self.hermite()]

    @staticmethod
    def place(column):
        inside = np.where(column < 0, column % 2, np.where(column >= WIDTH, WIDTH - 2 + column % 2, column))
        return (inside + WIDTH * np.arange(HEIGHT)[:, None]).astype(np.int32)

    @staticmethod
    def hermite():
        x = np.arange(65) / 32
        weights = (-x**3 / 8 + x**2 / 2 - x / 2, -x**3 / 4 + 3 * x**2 / 4, x**3 / 8 - x**2 / 4)
        return [np.floor(weight * 2**14 + 0.5).astype(np.int32) for weight in weights]

    @staticmethod
    def weight(nodes, i, t):
        return (nodes[i] + (((nodes[i + 1] - nodes[i]) * t + 128) >> 8)).astype(np.int32)

    def __call__(self):
        r1, g2, r3, g4, r5 = (np.take(self.frame, tap).astype(np.int32) for tap in self.taps)
        w1, w4, w5 = self.weights
        acc = (g2 << 14) + w4 * (g4 - g2) + w1 * (r1 - r3) + w5 * (r5 - r3)
        return np.clip((acc + 8192) >> 14, 0, 2**BITS - 1).astype(np.uint16)


def main():
    cv2.setNumThreads(1)
    frame, shrink = golden_frame(), steps() / ONE
    benchmarks = {
        "remap": Grey(frame, shrink),
        "remap of planes": Planes(frame, shrink),
        "demosaic and remap": Demosaicked(frame, shrink),
        "numpy": Datapath(frame, shrink),
    }
    if zlib.crc32(benchmarks["numpy"]().tobytes()) != 0x3ECF6D03:
        sys.exit("peers.py: NumPy's frame is not the golden one")
    print("\n".join(benchmarks), end="\n\n", flush=True)
    for line in sys.stdin:
        times, name = line.rstrip("\n").split(" ", 1)
        started = time.perf_counter_ns()
        for _ in range(int(times)):
            benchmarks[name]()
        print(time.perf_counter_ns() - started, flush=True)


main()
