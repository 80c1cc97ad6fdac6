"""Judges boards that straighten fisheye Bayer video, and corrects frames bit for bit as such a board must.

    import halfrow

    tables = halfrow.Tables.from_lens("camera.yml", projection="exact")
    straight = halfrow.correct(halfrow.read_frame("raw.pgm"), tables)
    report = halfrow.verify("mock", tables=tables)
    assert report.passed, report.text

Frames are NumPy arrays of uint16 of shape (height, width), one Bayer sample of 0 to 2^bits − 1 each. Arrays of another
kind are refused, and `correct` copies none.
"""
from ._errors import HalfrowError, InputError, Problem
from ._halfrow import (
    BUILTIN_FRAMES,
    KERNELS,
    MODEL_PATHS,
    VERSION,
    Corrector,
    Kernel,
    Lens,
    Tables,
    __version__,
    correct,
    demosaic,
    read_frame,
    write_frame,
)
from ._report import (
    Board,
    Check,
    Comparison,
    Coverage,
    Difference,
    EdgeDeviation,
    Facts,
    File,
    Finding,
    Frame,
    Identity,
    Latency,
    Link,
    NotExercised,
    Report,
    Street,
    Suspect,
    TablesUsed,
)
from ._verify import verify

__all__ = [
    "BUILTIN_FRAMES",
    "KERNELS",
    "MODEL_PATHS",
    "VERSION",
    "Board",
    "Check",
    "Comparison",
    "Corrector",
    "Coverage",
    "Difference",
    "EdgeDeviation",
    "Facts",
    "File",
    "Finding",
    "Frame",
    "HalfrowError",
    "Identity",
    "InputError",
    "Kernel",
    "Latency",
    "Lens",
    "Link",
    "NotExercised",
    "Problem",
    "Report",
    "Street",
    "Suspect",
    "Tables",
    "TablesUsed",
    "__version__",
    "correct",
    "demosaic",
    "read_frame",
    "verify",
    "write_frame",
]
