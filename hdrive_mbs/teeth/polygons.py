"""Signed distance between simple polygons, over arrays of positions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.teeth.deformation import FloatArray
from hdrive_mbs.teeth.outline import segments_cross

BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Gap:
    """Signed distance of two polygons and where it is.

    distance : the distance; minus the deepest vertex's depth where they overlap, at most 0 where only edges cross
    point : the nearest (or deepest) vertex
    of_moving : whether that vertex belongs to the moving polygon
    vertex : its number in its polygon
    """

    distance: FloatArray
    point: FloatArray
    of_moving: BoolArray
    vertex: npt.NDArray[np.intp]
    overlap: BoolArray


def signed_gap(moving: FloatArray, fixed: FloatArray) -> Gap:
    """Gap between polygons moving (..., k, 2) and fixed (m, 2), both closed and without crossings of their own.

    Apart, the distance of two polygons is that of a vertex of one from an edge of the other.
    """
    fixed_full = np.broadcast_to(fixed, (*moving.shape[:-2], *fixed.shape))
    near_moving, inside_moving = _to_edges(moving, fixed_full)
    near_fixed, inside_fixed = _to_edges(fixed_full, moving)
    signed = np.concatenate((np.where(inside_moving, -near_moving, near_moving), np.where(inside_fixed, -near_fixed, near_fixed)), axis=-1)
    vertex = np.argmin(signed, axis=-1)
    distance = np.take_along_axis(signed, vertex[..., None], axis=-1)[..., 0]
    start, end = moving[..., :, None, :], np.roll(moving, -1, axis=-2)[..., :, None, :]
    other, after = fixed[None, :, :], np.roll(fixed, -1, axis=0)[None, :, :]
    crossing = np.any(segments_cross(start, end, other, after), axis=(-1, -2))
    overlap = crossing | (distance < 0.0)
    corners = np.concatenate((moving, fixed_full), axis=-2)
    point = np.take_along_axis(corners, vertex[..., None, None], axis=-2)[..., 0, :]
    count = moving.shape[-2]
    of_moving = vertex < count
    return Gap(
        distance=np.where(crossing, np.minimum(distance, 0.0), distance),
        point=point,
        of_moving=of_moving,
        vertex=np.where(of_moving, vertex, vertex - count),
        overlap=overlap,
    )


def _to_edges(points: FloatArray, polygon: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Distance of points (..., k, 2) from the boundary of polygons (..., m, 2), and whether they lie inside."""
    start, end = polygon[..., None, :, :], np.roll(polygon, -1, axis=-2)[..., None, :, :]
    p = points[..., :, None, :]
    along, off = end - start, p - start
    length = np.sum(along * along, axis=-1)
    t = np.clip(np.sum(off * along, axis=-1) / length, 0.0, 1.0)
    gap = off - t[..., None] * along
    distance = np.sqrt(np.min(np.sum(gap * gap, axis=-1), axis=-1))
    # even-odd rule: edges that the ray to the right of the point crosses
    py, sy, ey = p[..., 1], start[..., 1], end[..., 1]
    straddles = (sy > py) != (ey > py)
    side = along[..., 0] * off[..., 1] - along[..., 1] * off[..., 0]
    inside = np.sum(straddles & ((side > 0.0) == (ey > sy)), axis=-1) % 2 == 1
    return distance, inside
