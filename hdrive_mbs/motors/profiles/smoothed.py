"""A measured motion without the noise and the steps of its sensor."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.motors.profiles.angle_table import AngleTable
from hdrive_mbs.records.checks.wrapped import seams_of

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

FloatArray = npt.NDArray[np.float64]

FEWEST, NARROWEST = 8, 4.0
"""Samples that a motion needs, and samples between two knots at least."""
MOST = 400
"""Pieces that are tried at most: a motion with more in it is given as an ``AngleTable`` of one's own."""
FINER, POINTS = 3, 400
"""Points of the table between two knots, and in all, at least: a table's spline bends not at all at its ends, which costs an acceleration
a there an angle of some a h^2/20 within the first distances h of its points."""


def smoothed_motion(times: npt.ArrayLike, values: npt.ArrayLike, *, of: str = "angle", knots: float | None = None) -> AngleTable:
    """The motion of a shaft from its measured angle or speed, smooth enough to hold a shaft to it.

    A cubic spline through the samples by least squares, with even knots as far apart as generalised cross-validation wants
    them, n |r|^2/(n - p)^2 of n residuals r and p coefficients the least.  Of an angle it is the motion itself, which keeps
    the angle at which it starts; of a speed its integral, from the angle 0 at the first sample on.  Before and behind the
    samples the speed stays as it is there.

    times : s, rising, shape (n,);  values : rad or rad/s, shape (n,); nan where there is none
    of : "angle" or "speed";  knots : distance of the knots [s], chosen if not given

    What is faster than the knots is lost: a torsional vibration, say.  Do not give it to a rotor whose torsion is what you are after.

    Source: Golub, Heath, Wahba, Technometrics 21 (1979) 215.  Raises ParameterError for too few samples, times that do not
    rise, an angle that begins again after each turn, knots closer than four samples, or another ``of``.
    """
    at, seen = np.asarray(times, float), np.asarray(values, float)
    if of not in ("angle", "speed"):
        raise ParameterError(f"of = {of!r}: must be 'angle' or 'speed'.")
    if at.ndim != 1 or at.shape != seen.shape:
        raise ParameterError(f"times and values have the shapes {at.shape} and {seen.shape}; give one value for each time, shape (n,).")
    there = np.isfinite(seen)
    at, seen = at[there], seen[there]
    if len(at) < FEWEST or not np.all(np.diff(at) > 0.0):
        raise ParameterError(f"A smoothed motion needs at least {FEWEST} values at rising times; there are {len(at)}.")
    if of == "angle" and seams_of(seen) is not None:
        raise ParameterError(
            "The angle begins again after each turn: numpy.unwrap it before, or read it with repair={'wrapped': 'unwrap'}."
        )
    length, closest = at[-1] - at[0], NARROWEST * (at[-1] - at[0]) / (len(at) - 1)
    if knots is not None and not closest <= knots < math.inf:
        raise ParameterError(f"knots = {knots:g} s: must be at least {closest:.3g} s, four samples.")
    most = max(1, min(MOST, int(length / closest)))
    pieces = _fewest_that_fit(at, seen, most) if knots is None else max(1, round(length / knots))
    spline, _ = _fitted(at, seen, pieces)
    if spline is None:
        raise ParameterError(
            f"knots = {length / pieces:.3g} s: values are missing for longer than that; leave knots out, or cut the record."
        )
    motion = spline.antiderivative() if of == "speed" else spline
    points = np.linspace(at[0], at[-1], max(FINER * pieces, POINTS) + 1)
    angles = [float(angle) for angle in motion(points)]
    return AngleTable(times=tuple(points.tolist()), angles=tuple(angles), absolute=True)


def _fewest_that_fit(at: FloatArray, seen: FloatArray, most: int) -> int:
    """Pieces with the least criterion of cross-validation, from 1 on, each time half as many again."""
    tried = [1]
    while tried[-1] < most:
        tried.append(min(most, max(tried[-1] + 1, tried[-1] * 3 // 2)))
    return min(tried, key=lambda pieces: _fitted(at, seen, pieces)[1])


def _fitted(at: FloatArray, seen: FloatArray, pieces: int) -> tuple[BSpline | None, float]:
    """The spline with so many pieces and its criterion; none where values are missing for longer than a piece."""
    from scipy.interpolate import make_lsq_spline

    inner = np.linspace(at[0], at[-1], pieces + 1)
    if np.any(np.histogram(at, inner)[0] < 1):
        return None, math.inf
    spline = make_lsq_spline(at, seen, np.concatenate(([inner[0]] * 3, inner, [inner[-1]] * 3)), k=3)
    free = len(at) - (pieces + 3)
    left = seen - spline(at)
    return spline, len(at) * float(left @ left) / free**2
