"""SI inside: numbers, lists and arrays of other units are converted at the door, ``speed=rpm(1410)``, ``lost_motion=arcmin(9)``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import overload

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@overload
def rpm(value: float) -> float: ...
@overload
def rpm(value: Sequence[float] | FloatArray) -> FloatArray: ...
def rpm(value: float | Sequence[float] | FloatArray) -> float | FloatArray:
    """Revolutions per minute -> rad/s, of a number or of many."""
    return _many(value) * math.pi / 30.0


@overload
def mm(value: float) -> float: ...
@overload
def mm(value: Sequence[float] | FloatArray) -> FloatArray: ...
def mm(value: float | Sequence[float] | FloatArray) -> float | FloatArray:
    """Millimetres -> m, of a number or of many."""
    return _many(value) * 1e-3


@overload
def degrees(value: float) -> float: ...
@overload
def degrees(value: Sequence[float] | FloatArray) -> FloatArray: ...
def degrees(value: float | Sequence[float] | FloatArray) -> float | FloatArray:
    """Degrees -> rad, of a number or of many (``numpy.degrees`` goes the other way)."""
    return _many(value) * (math.pi / 180.0)


@overload
def arcmin(value: float) -> float: ...
@overload
def arcmin(value: Sequence[float] | FloatArray) -> FloatArray: ...
def arcmin(value: float | Sequence[float] | FloatArray) -> float | FloatArray:
    """Minutes of arc -> rad, of a number or of many."""
    return _many(value) / 60.0 * (math.pi / 180.0)


def _many(value: float | Sequence[float] | FloatArray) -> float | FloatArray:
    """A list or tuple as an array; a number as it is."""
    return np.asarray(value, float) if isinstance(value, list | tuple | range) else value  # type: ignore[return-value]
