"""A frame through the Python package, from array to array, by each path. It is called like halfrow-bench (src/main.rs)."""

import sys
import time
import zlib

import halfrow
import numpy as np

WIDTH, HEIGHT = 1920, 1080


def main():
    places = np.arange(WIDTH * HEIGHT, dtype=np.uint64)
    frame = ((places * 2654435761 % 2**32) >> 20).astype(np.uint16).reshape(HEIGHT, WIDTH)
    tables, out = halfrow.Tables.from_lens("equidistant:1106.697"), np.empty_like(frame)
    correctors = {f"python {path} hermite": halfrow.Corrector(tables, path=path) for path in halfrow.MODEL_PATHS}
    for name, corrector in correctors.items():
        # DATAPATH.md, "Golden values".
        if zlib.crc32(corrector.correct(frame, out).tobytes()) != 0x3ECF6D03:
            sys.exit(f"python.py: the frame of `{name}` is not the golden one")
    print("\n".join(correctors), end="\n\n", flush=True)
    for line in sys.stdin:
        times, name = line.rstrip("\n").split(" ", 1)
        correct = correctors[name].correct
        started = time.perf_counter_ns()
        for _ in range(int(times)):
            correct(frame, out)
        print(time.perf_counter_ns() - started, flush=True)


main()
