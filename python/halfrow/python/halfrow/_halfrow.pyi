import os
from typing import Any, ClassVar, Dict, List, Optional, Tuple, Type, Union, final

import numpy as np
from numpy.typing import NDArray

_Name = Union[str, os.PathLike[str]]
_Frame = NDArray[np.uint16]

__all__ = [
    "BUILTIN_FRAMES",
    "Corrector",
    "KERNELS",
    "Kernel",
    "Lens",
    "MODEL_PATHS",
    "Run",
    "Tables",
    "VERSION",
    "__version__",
    "correct",
    "demosaic",
    "read_frame",
    "verify",
    "write_frame",
]

__version__: str
VERSION: str
"""The version, with the commit in brackets."""
KERNELS: List[str]
"""The names of all named kernels."""
BUILTIN_FRAMES: List[str]
"""The names of all built-in frames."""
MODEL_PATHS: List[str]
"""The paths of the model that this processor supports, the slowest first; all give the same bits."""

@final
class Kernel:
    def __new__(cls, name: _Name = ...) -> Kernel: ...
    @staticmethod
    def from_weights(weights: NDArray[np.float64], *, name: str = "own") -> Kernel: ...
    @property
    def name(self) -> str: ...
    @property
    def taps(self) -> int: ...
    @property
    def weights(self) -> NDArray[np.float64]: ...
    def write(self, path: _Name, *, overwrite: bool = False) -> None: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

@final
class Lens:
    def __new__(
        cls,
        lens: Optional[_Name] = None,
        *,
        width: Optional[int] = None,
        height: Optional[int] = None,
        bits: int = 12,
        centre_x: Optional[float] = None,
        centre_y: Optional[float] = None,
        field_of_view: float = ...,
    ) -> Lens: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def bits(self) -> int: ...
    @property
    def centre(self) -> Tuple[float, float]: ...
    @property
    def radius(self) -> float: ...
    @property
    def field_of_view(self) -> float: ...
    @property
    def rows_outside_circle(self) -> int: ...
    def column(self, degrees: float) -> Optional[float]: ...
    def frame(self, name: str, *, phase: str = "grbg", seed: int = 1) -> _Frame: ...

@final
class Tables:
    @staticmethod
    def from_lens(
        lens: Union[Lens, _Name, None] = None,
        *,
        projection: str = "rows",
        rows: Optional[str] = None,
        entries: Optional[int] = None,
        nodes_every: Optional[int] = None,
        kernel: Union[Kernel, _Name, None] = None,
    ) -> Tables: ...
    @staticmethod
    def read(path: _Name, *, kernel: Union[Kernel, _Name, None] = None) -> Tables: ...
    def write(self, path: _Name, *, overwrite: bool = False) -> None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def bits(self) -> int: ...
    @property
    def centre_x(self) -> float: ...
    @property
    def datapath(self) -> int: ...
    @property
    def grid_shape(self) -> Optional[Tuple[int, int]]: ...
    @property
    def units(self) -> NDArray[np.uint32]: ...
    @property
    def row_factors(self) -> Optional[NDArray[np.float64]]: ...
    def sources(self) -> NDArray[np.float64]: ...
    @property
    def kernel(self) -> Kernel: ...
    @property
    def lens(self) -> Lens: ...
    @property
    def source(self) -> str: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

@final
class Corrector:
    def __new__(
        cls,
        tables: Tables,
        *,
        kernel: Union[Kernel, _Name, None] = None,
        path: Optional[str] = None,
    ) -> Corrector: ...
    @property
    def tables(self) -> Tables: ...
    @property
    def path(self) -> str: ...
    def correct(self, frame: _Frame, out: Optional[_Frame] = None) -> _Frame: ...

@final
class Run:
    def json(self) -> str: ...
    def text(self) -> str: ...
    def save(self, path: _Name, overwrite: bool) -> None: ...
    def __copy__(self) -> Run: ...
    def __deepcopy__(self, memo: Any, /) -> Run: ...
    def __reduce__(self) -> Tuple[Type[None], Tuple[()]]: ...

def correct(
    frame: _Frame,
    tables: Tables,
    *,
    kernel: Union[Kernel, _Name, None] = None,
    out: Optional[_Frame] = None,
    path: Optional[str] = None,
) -> _Frame: ...
def read_frame(
    path: _Name,
    *,
    bits: int = 12,
    phase: str = "grbg",
    raw: Optional[str] = None,
    width: Optional[int] = None,
    height: Optional[int] = None,
) -> _Frame: ...
def write_frame(
    path: _Name,
    frame: _Frame,
    *,
    bits: int = 12,
    phase: str = "grbg",
    overwrite: bool = False,
) -> None: ...
def demosaic(frame: _Frame, *, bits: int = 12, phase: str = "grbg") -> NDArray[np.uint8]: ...
def verify(board: str, options: Dict[str, Any]) -> Tuple[Run, Optional[BaseException]]: ...
