"""Clearances and interference of a flexible tooth with its neighbours on the rigid wheel over a turn of the generator."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from hdrive_mbs.teeth.deformation import FloatArray
from hdrive_mbs.teeth.motion import placed
from hdrive_mbs.teeth.polygons import BoolArray, Gap, signed_gap
from hdrive_mbs.teeth.stage import Stage

ANGLES = 720
"""Angles over a turn of the generator, every half degree: between two of them a smooth gap bends by w0 (2 dphi)^2/8, some nm."""
FINER = 32
"""A step in which corners may clip is divided into so many: the radial motion in one is then below 2 w0 pi/(360 * 32), 0.2 um."""
ROUNDING = 1e-13
"""Distances [m] that differ by less are the same one."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Clearances:
    """Gaps between full tooth outlines over a turn of the generator.  All teeth do the same one after the other.

    angles : phi [rad] from the starting axis, even steps and finer ones where two corners may clip each other
    weight : part of the turn that each angle stands for
    gap : signed distance [m] of the tooth from the nearer of the two rigid teeth beside it, negative where they overlap
    place : where it is, (n, 2) in m, in the frame of the rigid tooth (x across it, y from the rigid wheel's centre)
    feature : "tip corner" or "flank" and so on, of which wheel, per angle
    depth : common radial height [m] of flexible and rigid tooth, negative while they are apart
    ahead, behind : angle [rad] that the flexible tooth could turn about the rigid wheel's centre, towards +x and -x,
        until it touches; infinite while there is no common height
    radial_tip, radial_root : smallest gap [m] between flexible tip and rigid root, rigid tip and flexible root
    """

    stage: Stage
    angles: FloatArray
    weight: FloatArray
    gap: FloatArray
    place: FloatArray
    feature: tuple[str, ...]
    depth: FloatArray
    ahead: FloatArray
    behind: FloatArray
    overlap: BoolArray
    radial_tip: float
    radial_root: float

    @property
    def minimum(self) -> float:
        """Smallest distance [m] between the outlines, negative for interference."""
        return float(np.min(self.gap))

    @property
    def worst(self) -> int:
        """Index of the angle of the smallest distance: the first one of places that are alike in all waves but for rounding."""
        return int(np.flatnonzero(self.gap <= np.min(self.gap) + ROUNDING)[0])

    @property
    def interferes(self) -> bool:
        """Whether any outline enters another one, at a flank, a tip or a root."""
        return bool(np.any(self.overlap)) or min(self.radial_tip, self.radial_root) < 0.0

    @property
    def in_mesh(self) -> BoolArray:
        """Angles at which the teeth have a common height."""
        return np.asarray(self.depth > 0.0)

    @property
    def flank_clearance(self) -> float:
        """Smallest distance [m] while the teeth have a common height."""
        return float(np.min(self.gap[self.in_mesh]))

    @property
    def tip_clearance(self) -> float:
        """Smallest distance [m] while they have none: tip passing tip.  Infinite if they never part."""
        return float(np.min(self.gap[~self.in_mesh], initial=np.inf))

    @property
    def zone(self) -> float:
        """Part of the circumference on which the teeth overlap radially, all waves together."""
        return float(np.sum(self.weight[self.in_mesh]))

    @property
    def teeth_in_engagement(self) -> float:
        """Teeth with a common height, all waves together: zone times the flexible teeth."""
        return self.zone * self.stage.flexible.teeth

    @property
    def lost_motion(self) -> float:
        """Turn [rad] of the flexible against the rigid wheel from contact one way to contact the other way, at least 0.

        The tooth that has least play decides.  The fibre keeps its shape, the generator stands.  Leaves out
        that the tooth is also moved along the deformed fibre: at most (w0/r)(1 + 2 tan alpha) of the play, about 2 %.
        """
        return max(0.0, float(np.min(self.ahead)) + float(np.min(self.behind)))

    def play(self, forward: bool = True) -> FloatArray:
        """Turn [rad] still left at each angle when the first tooth touches, towards +x or -x; infinite out of mesh."""
        free = self.ahead if forward else self.behind
        return np.asarray(free - np.min(free), float)

    def loaded_teeth(self, windup: float, forward: bool = True) -> float:
        """Mean number of teeth in contact when the wheels have turned by windup [rad] after the first contact."""
        return float(np.sum(self.weight[self.play(forward) < windup])) * self.stage.flexible.teeth

    def stiffness_factor(self, windup: float, forward: bool = True) -> float:
        """Secant mesh stiffness over that with all overlapping teeth in contact from the start.

        Each tooth is a spring that begins to carry when its play is used up:  mean(max(0, windup - play)) / (windup * zone),
        the mean taken over all teeth.
        """
        carried = np.maximum(0.0, windup - self.play(forward))
        return float(np.sum(self.weight * carried) / (windup * self.zone))


@lru_cache(maxsize=64)
def clearances(stage: Stage, number: int = ANGLES) -> Clearances:
    """Clearances over a turn of the generator against the flexspline.

    number : even steps; the steps beside the smallest gap, and those in which the teeth begin or
        cease to have a common height, are divided by FINER
    """
    phi = 2.0 * np.pi * np.arange(number) / number
    first = _measure(stage, phi)
    before = np.flatnonzero((first.depth > 0.0) != (np.roll(first.depth, -1) > 0.0))
    worst = first.worst
    split = np.unique(np.concatenate((before, [worst, (worst - 1) % number])))
    inner = np.arange(1, FINER) / FINER * 2.0 * np.pi / number
    return _measure(stage, np.sort(np.concatenate((phi, (phi[split][:, None] + inner).ravel()))))


def _measure(stage: Stage, phi: FloatArray) -> Clearances:
    neighbours = beside(stage, phi)
    fixed = stage.rigid.outline()
    gaps = signed_gap(neighbours, fixed)
    nearer = np.argmin(gaps.distance, axis=1)[:, None]
    d = stage.direction
    farthest = np.max(d * np.hypot(neighbours[:, 0, :, 0], neighbours[:, 0, :, 1]), axis=1)
    step = np.diff(phi, append=phi[0] + 2.0 * np.pi)
    return Clearances(
        stage=stage,
        angles=phi,
        weight=(step + np.roll(step, 1)) / (4.0 * np.pi),
        gap=np.take_along_axis(gaps.distance, nearer, axis=1)[:, 0],
        place=np.take_along_axis(gaps.point, nearer[..., None], axis=1)[:, 0],
        feature=tuple(_features(gaps, nearer, stage)),
        depth=farthest - d * stage.rigid.tip_radius,
        ahead=_free_turn(stage, neighbours[:, 1], fixed, ahead=True),
        behind=_free_turn(stage, neighbours[:, 0], fixed, ahead=False),
        overlap=np.any(gaps.overlap, axis=1),
        radial_tip=float(np.min(d * stage.rigid.root_radius - farthest)),
        radial_root=float(np.min(_over_flexible_root(stage, phi))),
    )


def beside(stage: Stage, phi: FloatArray) -> FloatArray:
    """Outline of the flexible tooth in the frames of the rigid teeth behind and ahead of it: (n, 2, k, 2) in m.

    In each frame the rigid tooth stands upright (x across, y from the wheel's centre).  A tooth is
    narrower than a pitch, so the two rigid teeth that its axis lies between are the nearest ones.
    """
    outline = stage.flexible.outline()
    points = placed(stage, outline, phi)
    middle = placed(stage, np.array([[0.0, stage.flexible.tip_radius]]), phi)[:, 0]
    pitch = stage.rigid.pitch_angle
    below = np.floor(np.arctan2(middle[:, 0], middle[:, 1]) / pitch)
    angle = pitch * (below[:, None] + np.array([0.0, 1.0]))
    c, s = np.cos(angle)[:, :, None], np.sin(angle)[:, :, None]
    x, y = points[:, None, :, 0], points[:, None, :, 1]
    return np.stack((x * c - y * s, y * c + x * s), axis=-1)


def _over_flexible_root(stage: Stage, phi: FloatArray) -> FloatArray:
    """Gap [m] between the rigid tip circle and the flexible root circle, carried along on the tooth's axis and half a pitch beside it."""
    half = np.array([-0.5, 0.0, 0.5]) * stage.flexible.pitch_angle
    points = stage.flexible.root_radius * np.stack((np.sin(half), np.cos(half)), axis=-1)
    root = placed(stage, points, phi)
    radius = np.hypot(root[..., 0], root[..., 1])
    return np.asarray(np.min(stage.direction * (stage.rigid.tip_radius - radius), axis=1), float)


def _features(gaps: Gap, nearer: npt.NDArray[np.intp], stage: Stage) -> list[str]:
    moving = np.take_along_axis(gaps.of_moving, nearer, axis=1)[:, 0]
    vertex = np.take_along_axis(gaps.vertex, nearer, axis=1)[:, 0]
    words = {True: _words(stage.flexible.right_flank()), False: _words(stage.rigid.right_flank())}
    return [f"{'flexible' if own else 'rigid'} {words[bool(own)][k]}" for own, k in zip(moving, vertex)]


def _words(flank: FloatArray) -> list[str]:
    """Names of the vertices in the order of ``closed``."""
    right = ["body", "root corner", *["flank"] * (len(flank) - 2), "tip corner"]
    return [*right, "tip", *right[::-1]]


def _free_turn(stage: Stage, moving: FloatArray, fixed: FloatArray, ahead: bool) -> FloatArray:
    """Angle [rad] about the centre until the flank facing the rigid tooth touches it.

    Both flanks are angle(radius), piecewise; their difference is smallest at a vertex of one of them.
    """
    n_moving, n_fixed = len(stage.flexible.right_flank()), len(stage.rigid.right_flank())
    near = slice(1, 1 + n_moving) if ahead else slice(-1 - n_moving, -1)
    far = slice(-1 - n_fixed, -1) if ahead else slice(1, 1 + n_fixed)
    own, other = moving[:, near], np.broadcast_to(fixed[far], (len(moving), n_fixed, 2))
    sign = 1.0 if ahead else -1.0
    first = sign * (_angle_at(other, _radius(own)) - np.arctan2(own[..., 0], own[..., 1]))
    second = sign * (np.arctan2(other[..., 0], other[..., 1]) - _angle_at(own, _radius(other)))
    free = np.concatenate((first, second), axis=1)
    return np.asarray(np.min(np.where(np.isnan(free), np.inf, free), axis=1), float)


def _radius(points: FloatArray) -> FloatArray:
    return np.hypot(points[..., 0], points[..., 1])


def _angle_at(chain: FloatArray, radius: FloatArray) -> FloatArray:
    """Polar angle (from y towards x) at which chains (n, k, 2) meet circles of these radii (n, m); nan where they do not."""
    start, along = chain[:, None, :-1], chain[:, None, 1:] - chain[:, None, :-1]
    a = np.sum(along * along, axis=-1)
    b = np.sum(start * along, axis=-1)
    c = np.sum(start * start, axis=-1) - radius[..., None] ** 2
    root = np.sqrt(np.maximum(b * b - a * c, 0.0))
    # the chain is nearly radial: the crossing is the one on the side of the rising or falling radius
    t = np.where(b > 0.0, -c / (b + root), -c / (b - root))
    hit = (t >= -1e-12) & (t <= 1.0 + 1e-12)
    point = start + t[..., None] * along
    angle = np.where(hit, np.arctan2(point[..., 0], point[..., 1]), np.nan)
    with np.errstate(invalid="ignore"):
        found = np.where(np.any(hit, axis=-1), np.nanmin(np.where(hit, angle, np.inf), axis=-1), np.nan)
    return np.asarray(found, float)
