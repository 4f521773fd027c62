"""Outlines of straight-flanked teeth, for one wheel or for arrays of designs, and polygon checks."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hdrive_mbs.teeth.deformation import FloatArray


def straight_flank(
    tip_radius: npt.ArrayLike,
    root_radius: npt.ArrayLike,
    reference_radius: npt.ArrayLike,
    thickness: npt.ArrayLike,
    profile_angle: npt.ArrayLike,
) -> FloatArray:
    """Points (a, y) of the right flank, at the root and at the tip: shape (..., 2, 2).

    a is measured across the tooth from its axis, y along the axis from the wheel's centre.  The
    flank is a straight line at the profile angle to the axis, through the point on the reference
    circle where the tooth has its (arc) thickness; it ends on the root and on the tip circle:

        a = A - k y,  a^2 + y^2 = r^2  ->  y = (A k + sqrt((1 + k^2) r^2 - A^2)) / (1 + k^2)

    with k = tan(alpha), negative for a tooth that points inwards.
    """
    tip, root, reference, s, alpha = (np.asarray(x, float) for x in (tip_radius, root_radius, reference_radius, thickness, profile_angle))
    k = np.where(tip > root, 1.0, -1.0) * np.tan(alpha)
    half = s / (2.0 * reference)
    A = reference * (np.sin(half) + k * np.cos(half))
    points = []
    for radius in (root, tip):
        y = (A * k + np.sqrt((1.0 + k**2) * radius**2 - A**2)) / (1.0 + k**2)
        points.append(np.stack(np.broadcast_arrays(A - k * y, y), axis=-1))
    return np.stack(points, axis=-2)


def closed(right_flank: FloatArray) -> FloatArray:
    """Closed outline of a tooth from its right flank (root to tip): mirrored, with the middle of the tip land on the
    tip circle and, below the root, a piece of the body as deep as the tooth is high."""
    root, tip = right_flank[..., :1, :], right_flank[..., -1:, :]
    top = np.hypot(tip[..., 0], tip[..., 1])
    crown = np.stack((np.zeros_like(top), top), axis=-1)
    body = root.copy()
    body[..., 1] -= tip[..., 1] - root[..., 1]
    right = np.concatenate((body, right_flank), axis=-2)
    left = right[..., ::-1, :] * np.array([-1.0, 1.0])
    return np.concatenate((right, crown, left), axis=-2)


def crossings(outline: FloatArray) -> npt.NDArray[np.bool_]:
    """Whether a closed polygon (n, 2) crosses itself: any two edges that are not neighbours intersect."""
    start, end = outline, np.roll(outline, -1, axis=0)
    n = len(outline)
    hit = segments_cross(start[:, None], end[:, None], start[None], end[None])
    gap = np.abs(np.arange(n)[:, None] - np.arange(n)[None])
    apart = (gap > 1) & (gap < n - 1)
    return np.asarray(np.any(hit & apart))


def segments_cross(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> npt.NDArray[np.bool_]:
    """Whether the segments a-b and c-d cross at a point inside both."""

    def side(p: FloatArray, q: FloatArray, r: FloatArray) -> FloatArray:
        return np.asarray((q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (r[..., 0] - p[..., 0]), float)

    return np.asarray((side(a, b, c) * side(a, b, d) < 0.0) & (side(c, d, a) * side(c, d, b) < 0.0))
