"""Least-squares fits of stiffness polynomials that stay restoring and rising."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.flexsplines.law import FloatArray, StiffnessLaw

Curve = StiffnessLaw | tuple[Sequence[float], Sequence[float]]
"""What a polynomial is fitted to: another law, or measured (twists [rad], torques [N m])."""

SAMPLES = 2001
"""Points along a law, evenly over the twist: the sum of squares then approaches the integral."""


def gap_of(curve: Curve, lost_motion: float | None) -> float:
    """Full width of the gap [rad]: the given one, else that of the law."""
    if lost_motion is not None:
        return lost_motion
    if isinstance(curve, StiffnessLaw):
        return 2.0 * curve.half_gap
    raise ParameterError("Measured points do not say how wide the gap is: give lost_motion [rad].")


def one_side(curve: Curve, largest_torque: float | None, start: float, sign: int) -> tuple[FloatArray, FloatArray]:
    """Twists and torques of one side as positive numbers, from twist ``start`` to the largest torque.

    sign : +1 or -1, the side; 0 for the mean of both, which has the same least-squares odd law as both.
    Both sides of a law go to the same twist, where the softer one reaches the largest torque;
    measured points of both sides are always folded on to each other.
    """
    if largest_torque is not None and not largest_torque > 0.0:
        raise ParameterError(f"largest_torque = {largest_torque} N m: must be greater than 0 N m.")
    if isinstance(curve, StiffnessLaw):
        if largest_torque is None:
            raise ParameterError("largest_torque [N m] is missing: a law has no end, so say up to which torque to fit it.")
        end = float(np.max(np.abs(curve.twist([-largest_torque, largest_torque]))))
        twist = np.linspace(start, end, SAMPLES)
        signs = (sign,) if sign else (1, -1)
        return twist, np.mean([side * np.asarray(curve.torque(side * twist), float) for side in signs], axis=0)
    twist, torque = (np.asarray(values, float) for values in curve)
    if twist.shape != torque.shape or twist.ndim != 1:
        raise ParameterError(f"Points to fit: {twist.shape} twists and {torque.shape} torques; both must be lists of the same length.")
    if not (np.isfinite(twist).all() and np.isfinite(torque).all()):
        raise ParameterError("Points to fit: every twist [rad] and torque [N m] must be a finite number.")
    twist, torque = np.abs(twist), np.sign(twist) * torque
    kept = twist >= start
    if largest_torque is not None:
        kept &= torque <= largest_torque
    if len(np.unique(twist[kept])) < 4:
        raise ParameterError(
            f"Points to fit: {len(np.unique(twist[kept]))} different twists from {start:.4g} rad on; at least 4 are needed."
        )
    return twist[kept], torque[kept]


def fit_pair(twist: FloatArray, torque: FloatArray, power: int, edge: float) -> tuple[float, float]:
    """b, d of  M = b x^m + d x^(m+2)  with m = power, least squares, M(edge) >= 0 and rising.

    M(x)/x^m = b + d k at k = x^2 and M'(x)/(m x^(m-1)) = b + d k at k = x^2 (m+2)/m.  Both are linear
    in k, so they are non-negative on [edge, X] exactly if b + d k is at k = edge^2 and at
    k = X^2 (m+2)/m; these two values are the unknowns of a non-negative least-squares problem.
    """
    end = float(np.max(twist))
    low, high = (edge / end) ** 2, (power + 2.0) / power
    x = twist / end
    first, second = x**power, x ** (power + 2)
    # b + d low = p, b + d high = q
    columns = [(high * first - second) / (high - low), (second - low * first) / (high - low)]
    p, q = _non_negative(columns, torque)
    d = (q - p) / (high - low)
    b = p - d * low
    return b / end**power, d / end ** (power + 2)


def fit_side(distance: FloatArray, torque: FloatArray) -> tuple[float, float, float]:
    """k1, k2, k3 of  M = k1 s + k2 s^2 + k3 s^3, least squares and rising on [0, S].

    The free fit is taken if it rises.  Else the slope is built from the extreme rays of the
    quadratics that are non-negative on [0, 1], (s - r)^2 and s (1 - s), with factors >= 0; r is taken
    from 101 places, so the fit always rises and is the best one but for that grid.
    """
    end = float(np.max(distance))
    s = distance / end
    free = np.linalg.lstsq(np.stack([s, s**2, s**3], axis=1), torque, rcond=None)[0]
    slope = np.polynomial.Polynomial([free[0], 2.0 * free[1], 3.0 * free[2]])
    turning = [float(root) for root in np.real(slope.deriv().roots()) if 0.0 < root < 1.0]
    if min(float(slope(x)) for x in (0.0, 1.0, *turning)) >= 0.0:
        k = free
    else:
        r = np.linspace(0.0, 1.0, 101)
        rays = np.concatenate((np.stack([r**2, -r, np.full_like(r, 1.0 / 3.0)]), [[0.0], [0.5], [-1.0 / 3.0]]), axis=1)
        k = rays @ _non_negative(list((np.stack([s, s**2, s**3], axis=1) @ rays).T), torque)
    return float(k[0]) / end, float(k[1]) / end**2, float(k[2]) / end**3


def _non_negative(columns: Sequence[FloatArray], torque: FloatArray) -> npt.NDArray[np.float64]:
    from scipy.optimize import nnls

    return np.asarray(nnls(np.stack(columns, axis=1), torque)[0], float)
