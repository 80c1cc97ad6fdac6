"""halfrow for labgrid: a driver and a strategy for boards that halfrow judges.

labgrid knows both once this module is imported, for example by `imports: [halfrow_labgrid]` in its environment.
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
