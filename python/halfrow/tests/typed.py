"""What mypy --strict must accept, and what it must refuse: an unneeded `ignore` is also an error."""
from pathlib import Path
from typing import Hashable, Optional, Tuple

import halfrow
import numpy as np
from halfrow.pytest_plugin import JudgedBoard
from numpy.typing import NDArray


def straightened(path: str) -> NDArray[np.uint16]:
    tables = halfrow.Tables.from_lens(path, projection="exact", kernel=halfrow.Kernel("keys"))
    shape: Optional[Tuple[int, int]] = tables.grid_shape
    assert shape is not None
    frame = halfrow.read_frame("raw.pgm", bits=tables.bits)
    return halfrow.correct(frame, tables, out=np.empty_like(frame))


def judged(board: JudgedBoard) -> str:
    report = board.verify(frames=["builtin:street"])
    board.verify(tabels=1)  # type: ignore[call-arg]
    halfrow.verify(frames=Path("raw").glob("*.pgm"))
    suspect: halfrow.Suspect = report.suspects[0]
    first = report.frames[0].comparison.first
    first.row  # type: ignore[union-attr]
    report.verdict = "PASS"  # type: ignore[misc]
    return suspect.defect.code if report.error is None else report.error.code


def wrong() -> None:
    tables = halfrow.Tables.from_lens()
    grey: NDArray[np.float64] = np.zeros((2, 2))
    halfrow.correct(grey, tables)  # type: ignore[arg-type]
    halfrow.verify(tables="lens.json")  # type: ignore[arg-type]
    halfrow.Lens(hight=3)  # type: ignore[call-arg]
    halfrow.Tables.from_lens(rows=1)  # type: ignore[arg-type]
    of_tables: Hashable = tables  # type: ignore[assignment]
    of_kernel: Hashable = tables.kernel  # type: ignore[assignment]
    of_lens: Hashable = tables.lens
