"""halfrow for labgrid: the driver and the strategy of a board that halfrow judges.

labgrid knows both once this module is imported, which `imports: [halfrow_labgrid]` in its environment does.
"""
from .driver import HalfrowDriver
from .report import BoardFailed, HalfrowError, NotJudged, Report, WrongCall
from .strategy import HalfrowStrategy, Status

__all__ = [
    "BoardFailed",
    "HalfrowDriver",
    "HalfrowError",
    "HalfrowStrategy",
    "NotJudged",
    "Report",
    "Status",
    "WrongCall",
]
