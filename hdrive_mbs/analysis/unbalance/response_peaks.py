"""Maxima of amplitudes over speed, refined between the speeds, with their half-power widths."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

FloatArray = npt.NDArray[np.float64]

Amplitudes = Callable[[FloatArray], FloatArray]
"""Amplitudes of all places at given speeds, (s,) -> (s, places)."""

PROMINENCE = 1e-3
"""A maximum counts when it stands above both valleys beside it by this share of its height."""

NARROW = 1e-6
"""Share of the speed to which a maximum is narrowed down; one narrower than that counts as undamped."""

PIECES = 10


class ResponsePeak(NamedTuple):
    """A maximum of an amplitude over speed.

    place : where
    speed : rad/s of the reference shaft
    amplitude : major semi-axis, 0-peak [m]; infinite at an undamped critical speed
    width : half-power width [rad/s]: between the speeds at which the amplitude is 1/sqrt(2) of the peak; NaN where
        a neighbouring peak or the end of the range comes first
    quality : speed over width
    """

    place: str
    speed: float
    amplitude: float
    width: float
    quality: float


def peaks(amplitudes: Amplitudes, speeds: FloatArray, hints: FloatArray, places: tuple[str, ...], columns: list[int]) -> list[ResponsePeak]:
    """All maxima of some places, in the order of the places, then of the speeds.

    amplitudes : of all places at any speeds within the range
    speeds : where to look, ascending;  hints : further speeds close to which a narrow peak may hide
    columns : the places to look at

    Each maximum is narrowed down in steps of ten evaluations, all of them at once, to 1e-6 of its speed.
    """
    inside = hints[(hints > speeds[0]) & (hints < speeds[-1])]
    grid = np.unique(np.concatenate([speeds, inside]))
    heights = amplitudes(grid)
    found = [(column, k) for column in columns for k in _maxima(heights[:, column])]
    if not found:
        return []
    tops, values, sharp = _narrowed(amplitudes, grid, found)
    result = []
    for (column, k), speed, height, undamped in zip(found, tops.tolist(), values.tolist(), sharp.tolist(), strict=True):
        if undamped:
            result.append(ResponsePeak(places[column], speed, np.inf, 0.0, np.inf))
            continue
        width = _width(lambda at, column=column: float(amplitudes(np.array([at]))[0, column]), grid, heights[:, column], k, speed, height)  # type: ignore[misc]
        result.append(ResponsePeak(places[column], speed, height, width, abs(speed) / width if width > 0.0 else np.nan))
    return result


def _maxima(height: FloatArray) -> list[int]:
    """Inner maxima that stand above the lowest points between them and a higher one (or the end)."""
    level = np.where(np.isfinite(height), height, np.inf)
    chosen = []
    for k in range(1, len(level) - 1):
        if not (level[k - 1] < level[k] >= level[k + 1]):
            continue
        if level[k] == np.inf:
            chosen.append(k)
            continue
        higher = level > level[k]
        left, right = np.flatnonzero(higher[:k]), np.flatnonzero(higher[k + 1 :])
        low = float(level[(left[-1] if len(left) else 0) : k].min())
        high = float(level[k + 1 : (k + 2 + right[0] if len(right) else len(level))].min())
        if max(low, high) <= (1.0 - PROMINENCE) * level[k]:
            chosen.append(k)
    return chosen


def _narrowed(
    amplitudes: Amplitudes, grid: FloatArray, found: list[tuple[int, int]]
) -> tuple[FloatArray, FloatArray, npt.NDArray[np.bool_]]:
    """Speed and height of each maximum, and whether it is too narrow to be resolved."""
    columns, at = np.array([column for column, _ in found]), np.array([k for _, k in found])
    low, high = grid[at - 1], grid[at + 1]
    shares = np.arange(PIECES + 1) / PIECES
    while True:
        tried = low[:, None] + (high - low)[:, None] * shares
        every = amplitudes(tried.ravel()).reshape(*tried.shape, -1)
        height = every[np.arange(len(columns))[:, None], np.arange(PIECES + 1), columns[:, None]]
        height = np.where(np.isfinite(height), height, np.inf)
        best = np.clip(np.argmax(height, axis=1), 1, PIECES - 1)
        rows = np.arange(len(columns))
        top = tried[rows, best]
        if np.all(high - low <= NARROW * np.maximum(np.abs(top), 1e-300)):
            break
        low, high = tried[rows, best - 1], tried[rows, best + 1]
    value = height[rows, best]
    steep = np.minimum(height[:, 0], height[:, -1]) < np.sqrt(0.5) * value
    return top, value, steep | ~np.isfinite(value)


def _width(amplitude: Callable[[float], float], grid: FloatArray, height: FloatArray, k: int, speed: float, peak: float) -> float:
    """Half-power width by search outwards from the peak."""
    level = np.sqrt(0.5) * peak
    ends = []
    for step in (-1, 1):
        inner, j, last = speed, k + (0 if step * (grid[k] - speed) > 0.0 else step), peak
        while 0 <= j < len(grid) and height[j] > level and height[j] <= last * (1.0 + 1e-9):
            inner, last, j = float(grid[j]), float(height[j]), j + step
        if not 0 <= j < len(grid) or not height[j] <= level:
            return float("nan")
        ends.append(float(brentq(lambda at: amplitude(at) - level, inner, grid[j], xtol=1e-12 * abs(speed))))
    return ends[1] - ends[0]
