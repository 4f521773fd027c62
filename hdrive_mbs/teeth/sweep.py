"""Many designs of a stage at once: straight flanks, separating axes, no loop over designs, teeth or angles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.teeth.deformation import DeformationLaw, FloatArray
from hdrive_mbs.teeth.fibre import _integral, _series, fibre, shortening
from hdrive_mbs.teeth.outline import straight_flank

CHUNK = 400
"""Designs treated together; keeps the arrays in the processor's cache."""
COARSE = 10
"""The first pass of a sweep takes every tenth angle."""


@dataclass(frozen=True, kw_only=True, eq=False)
class UnitFibre:
    """Displacements for w0 = 1 and r0 = 1 at some angles s, to second order in w0/r0:

    w = w0 w1 + (w0^2/r0) c2,  v = w0 v1 + (w0^2/r0) v2,  sin(theta) = (v - dw/ds)/r0

    The next term is of the order w0^3/r0^2, below 0.05 um for w0 = 0.3 mm and r0 = 29 mm.
    """

    s: FloatArray
    w: FloatArray
    slope: FloatArray
    v: FloatArray
    contraction: float
    v_second: FloatArray

    @classmethod
    def of(cls, law: DeformationLaw, s: FloatArray) -> UnitFibre:
        """The shape of a law, scaled to 1 on the major axis."""
        first = fibre(law, 1.0, exact=False)
        size = law.on_major_axis
        w, v = first.w / size, first.v / size
        lost = shortening(w, v, 1.0, second_order=True)
        rate = -lost
        rate[0] = 0.0
        return cls(
            s=s,
            w=_series(w, s, 0),
            slope=_series(w, s, 1),
            v=_series(v, s, 0),
            contraction=-lost[0].real,
            v_second=_series(_integral(rate), s, 0),
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class StageArrays:
    """Data of many designs, every field an array of one length.  See Stage and StraightToothWheel."""

    direction: int
    relative_turn: float
    rigid_pitch: float
    fibre_radius: float
    amplitude: FloatArray
    flexible_tip: FloatArray
    rigid_tip: FloatArray
    rigid_root: FloatArray
    flexible_flank: FloatArray
    rigid_flank: FloatArray

    def __len__(self) -> int:
        return len(self.amplitude)

    def part(self, chosen: slice | npt.NDArray[np.intp]) -> StageArrays:
        """Some of the designs."""
        arrays = {name: value[chosen] for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        return StageArrays(**{**vars(self), **arrays})

    def chunks(self) -> Iterator[tuple[slice, StageArrays]]:
        for start in range(0, len(self), CHUNK):
            chosen = slice(start, min(start + CHUNK, len(self)))
            yield chosen, self.part(chosen)


def flanks(tip: npt.ArrayLike, root: npt.ArrayLike, reference: float, thickness: npt.ArrayLike, profile_angle: npt.ArrayLike) -> FloatArray:
    """Right flanks (n, 2, 2) of straight teeth; not a number where the flank misses a circle."""
    with np.errstate(invalid="ignore"):
        return straight_flank(tip, root, reference, thickness, profile_angle)


def smallest_gaps(designs: StageArrays, unit: UnitFibre, start: float, stop_below: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Per design: smallest separation [m] of the flexible tooth from its rigid neighbours while they have a common height,
    the angle phi [rad] where it is, and the part of the angles with a common height.

    The separation is the largest over the separating axes (normals of all flanks and tip lands): its
    sign is exact for convex teeth, its value is the distance except between two corners, where the
    distance is larger.  A first pass takes every COARSE-th angle; designs whose separation is not
    below ``stop_below`` there are looked at again on all angles around their smallest separation
    and where their teeth begin to have a common height: there two corners may just clip each other.
    """
    gap, place, share = np.empty(len(designs)), np.empty(len(designs)), np.empty(len(designs))
    every = np.arange(0, len(unit.s), COARSE)[None, :]
    window = np.arange(-COARSE, COARSE + 1)
    for chosen, some in designs.chunks():
        table, depth = _separations(some, unit, start, np.broadcast_to(every, (len(some), every.shape[1])))
        share[chosen] = _positive_part(depth)
        worst = np.argmin(table, axis=1)
        gap[chosen], place[chosen] = np.min(table, axis=1), start - unit.s[every[0, worst]]
        near = np.flatnonzero(gap[chosen] >= stop_below)
        if not len(near):
            continue
        entry = np.argmax(depth[near] > 0.0, axis=1)
        around = every[0, np.concatenate((worst[near, None], entry[:, None]), axis=1)][:, :, None] + window
        index = np.clip(around.reshape(len(near), -1), 0, len(unit.s) - 1)
        fine, _ = _separations(some.part(near), unit, start, index)
        lowest = np.argmin(fine, axis=1)
        value = fine[np.arange(len(near)), lowest]
        at = chosen.start + near
        better = value < gap[at]
        gap[at[better]] = value[better]
        place[at[better]] = start - unit.s[index[np.arange(len(near)), lowest]][better]
    return gap, place, share


def _separations(d: StageArrays, unit: UnitFibre, start: float, index: npt.NDArray[np.intp]) -> tuple[FloatArray, FloatArray]:
    """Separations at the angles of that index, one row per design (infinite out of mesh), and common heights."""
    r0 = d.fibre_radius
    size = d.amplitude[:, None]
    w = size * unit.w[index] + size**2 / r0 * unit.contraction
    v = size * unit.v[index] + size**2 / r0 * unit.v_second[index]
    theta = np.arcsin((v - size * unit.slope[index]) / r0)
    phi = start - unit.s[index]
    tangential, radial = _carried(_tooth(d.flexible_flank), w, v, theta, r0)
    farthest = np.max(d.direction * np.hypot(tangential, radial), axis=-1)
    depth = np.asarray(farthest - d.direction * d.rigid_tip[:, None], float)
    mesh = depth > 0.0
    design, step = np.nonzero(mesh)
    turned = d.relative_turn * phi[design, step]
    x, y = tangential[design, step], radial[design, step]
    # the axis of the tooth at its tip lies between the rigid teeth number ``behind`` and ``behind + 1``
    behind = np.floor((np.arctan2(x[:, 2], y[:, 2]) + turned) / d.rigid_pitch)
    fixed = _tooth(d.rigid_flank)[design]
    gap = np.full(len(design), np.inf)
    for neighbour in (0.0, 1.0):
        turn = turned - d.rigid_pitch * (behind + neighbour)
        c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
        moving = np.stack((x * c + y * s, y * c - x * s), axis=-1)
        gap = np.minimum(gap, _separation(moving, fixed))
    table = np.full(mesh.shape, np.inf)
    table[design, step] = gap
    return table, depth


def _positive_part(values: FloatArray) -> FloatArray:
    """Part of the way along each row on which the values, joined by straight lines, are positive."""
    above = np.maximum(values, 0.0)
    size = np.abs(values[:, 1:]) + np.abs(values[:, :-1])
    both = values[:, 1:] * values[:, :-1] > 0.0
    part = np.where(both, above[:, 1:] > 0.0, (above[:, 1:] + above[:, :-1]) / np.where(size > 0.0, size, 1.0))
    return np.asarray(np.mean(part, axis=1), float)


def _tooth(flank: FloatArray) -> FloatArray:
    """Corners (n, 5, 2): root, tip, middle of the tip, tip, root, from right to left."""
    tip = flank[:, 1:]
    crown = np.stack((np.zeros_like(tip[..., 0]), np.hypot(tip[..., 0], tip[..., 1])), axis=-1)
    return np.concatenate((flank, crown, flank[:, ::-1] * np.array([-1.0, 1.0])), axis=1)


def _carried(corners: FloatArray, w: FloatArray, v: FloatArray, theta: FloatArray, r0: float) -> tuple[FloatArray, FloatArray]:
    across, along = corners[:, None, :, 0], corners[:, None, :, 1] - r0
    c, s = np.cos(theta)[..., None], np.sin(theta)[..., None]
    return v[..., None] + across * c + along * s, (r0 + w)[..., None] + along * c - across * s


def _separation(moving: FloatArray, fixed: FloatArray) -> FloatArray:
    """Largest signed gap over the edges of both teeth (n, 5, 2)."""
    return np.maximum(_edges_to_points(moving, fixed), _edges_to_points(fixed, moving))


def _edges_to_points(tooth: FloatArray, points: FloatArray) -> FloatArray:
    """max over the edges of the tooth of min over the points of the distance outside that edge."""
    along = tooth[:, 1:] - tooth[:, :-1]
    length = np.hypot(along[..., 0], along[..., 1])
    # outside is to the right of the edges of an outward tooth, which run from right to left; inward teeth mirror this
    outwards = np.sign(tooth[:, 1, 1] - tooth[:, 0, 1])
    normal_x = outwards[:, None] * along[..., 1] / length
    normal_y = -outwards[:, None] * along[..., 0] / length
    best = np.full(len(tooth), -np.inf)
    for edge in range(4):
        nearest = np.full(len(tooth), np.inf)
        for k in range(5):
            off = points[:, k] - tooth[:, edge]
            nearest = np.minimum(nearest, normal_x[:, edge] * off[:, 0] + normal_y[:, edge] * off[:, 1])
        best = np.maximum(best, nearest)
    return best
