"""Speeds between those asked for, so close where an amplitude grows and its phase turns that its curves have no corners."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.unbalance.response_peaks import NARROW

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

CORNERS = 48
"""Of the polygon a full circle may at most be coarsened to: it misses the circle by 0.2 % of its radius."""

GROWTH = 1.3
"""Ratio of two neighbouring amplitudes: the flank of a peak over speed is straight in the complex plane, but steep and bent."""

SHORT = 5e-3
"""Share of the largest amplitude on a curve below which a straight piece of it is left as it is."""

MOST_HALVINGS = 40


def between_speeds(curves: Callable[[FloatArray], ComplexArray], speeds: FloatArray, hints: FloatArray, endless: FloatArray) -> FloatArray:
    """Further speeds, ascending: with them no curve has a sharper corner than that polygon, nor a steeper step than GROWTH.

    curves : complex amplitudes at any speeds within the range, (s,) -> (s, curves)
    speeds : those asked for, ascending
    hints : speeds of peaks and poles, beside which a circle may hide between two speeds asked for
    endless : speeds without a steady amplitude, around which nothing is added

    Steps, and the pieces on both sides of corners, are halved, all of them at once, until none is left.
    """
    if len(speeds) < 2:
        return np.zeros(0)
    closed = np.zeros(len(speeds) + 1, bool)  # before, between and behind the speeds
    closed[[0, -1]] = True
    closed[np.searchsorted(speeds, endless)] = True
    closed[np.searchsorted(speeds, endless, side="right")] = True

    def is_open(at: FloatArray) -> npt.NDArray[np.bool_]:
        return np.asarray(~closed[np.searchsorted(speeds, at)])

    tolerance = NARROW * float(np.max(np.abs(speeds)))
    extra = np.unique(hints[is_open(hints)])
    extra = extra[np.diff(extra, prepend=-np.inf) > tolerance]
    extra = extra[np.min(np.abs(extra[:, None] - speeds), axis=1) > tolerance]
    at = np.sort(np.concatenate([speeds, extra]))
    value = curves(at)
    size = np.max(np.abs(value), axis=0, initial=0.0, where=np.isfinite(value))
    size[size == 0.0] = np.inf
    for _ in range(MOST_HALVINGS):
        piece = np.diff(value, axis=0)
        corner = np.abs(np.angle(piece[1:] * np.conj(piece[:-1]))) > 2.0 * np.pi / CORNERS
        long = np.abs(piece) > SHORT * size
        height = np.abs(value)
        steep = np.maximum(height[1:], height[:-1]) > GROWTH * np.minimum(height[1:], height[:-1])
        halved = np.any(steep & long, axis=1)
        halved[:-1] |= np.any(corner & long[:-1], axis=1)
        halved[1:] |= np.any(corner & long[1:], axis=1)
        middle = 0.5 * (at[1:] + at[:-1])
        halved &= is_open(middle) & (np.diff(at) > tolerance)
        if not halved.any():
            break
        order = np.argsort(np.concatenate([at, middle[halved]]), kind="stable")
        at, value = np.concatenate([at, middle[halved]])[order], np.concatenate([value, curves(middle[halved])])[order]
    return np.setdiff1d(at[np.all(np.isfinite(value), axis=1)], speeds)
