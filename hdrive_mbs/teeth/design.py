"""Choosing profile angle, tooth height, clearance and w0: sweep, window with reasons, best point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from hdrive_mbs.conversions import degrees
from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.quantities import Described, option, parameter
from hdrive_mbs.teeth.deformation import DeformationLaw, FloatArray
from hdrive_mbs.teeth.design_points import REASONS, UNITS, VARIABLES, DesignPoints
from hdrive_mbs.teeth.kinematics import check_assembly
from hdrive_mbs.teeth.stage import Stage
from hdrive_mbs.teeth.sweep import StageArrays, UnitFibre, flanks, smallest_gaps
from hdrive_mbs.teeth.wheel import StraightToothWheel

STEPS = 601
"""Angles from the starting to the engagement axis, every 0.15 degrees for two waves."""

LARGEST_ANGLE = degrees(60.0)
"""Profile angle [rad] up to which StraightToothWheel takes one."""


@dataclass(frozen=True, kw_only=True)
class Bound:
    """Range of one variable through the best point, and what stops it at each end."""

    variable: str
    unit: str
    low: float
    high: float
    reason_low: str
    reason_high: str


@dataclass(frozen=True, kw_only=True, eq=False)
class DesignWindow:
    """Result of a search.

    points : all designs that were looked at, a grid of ``shape`` over ``box`` in the order of VARIABLES
    best : most teeth in engagement among the designs that stay admissible when one variable changes by one grid step;
        empty when there is none
    bounds : range of each variable through the best point
    status : "complete", or what is missing
    """

    task: DesignTask
    box: Mapping[str, tuple[float, float]]
    shape: tuple[int, ...]
    points: DesignPoints
    best: Mapping[str, float]
    bounds: tuple[Bound, ...]
    status: str

    def slice(self, x: str, y: str, number: int = 40) -> DesignPoints:
        """number x number designs over two variables (y slow), the others at the best point or in the middle of the box."""
        for name in (x, y):
            if name not in VARIABLES:
                raise unknown_place("variable", name, VARIABLES, "A design")
        middle = {name: 0.5 * (low + high) for name, (low, high) in self.box.items()}
        at: dict[str, npt.ArrayLike] = {**middle, **self.best}
        grid_y, grid_x = np.meshgrid(np.linspace(*self.box[y], number), np.linspace(*self.box[x], number), indexing="ij")
        at |= {x: grid_x.ravel(), y: grid_y.ravel()}
        return self.task.evaluate(*(at[name] for name in VARIABLES))

    def explain(self) -> str:
        """The window in words."""
        admissible = int(np.sum(self.points.admissible))
        lines = [f"{admissible} of {len(self.points.verdict)} designs are admissible."]
        if not self.best:
            counts = np.bincount(self.points.verdict, minlength=len(REASONS))
            lines += [f"  {counts[k]} designs: {REASONS[k]}" for k in np.argsort(-counts) if counts[k] and k]
            return "\n".join([*lines, self.status])
        lines.append("best: " + ", ".join(f"{name} {_shown(name, value)}" for name, value in self.best.items()))
        for bound in self.bounds:
            lines.append(
                f"  {bound.variable}: {_shown(bound.variable, bound.low)} to {_shown(bound.variable, bound.high)}\n"
                f"    below: {bound.reason_low}\n    above: {bound.reason_high}"
            )
        return "\n".join(lines)


def common_amplitude(windows: Sequence[DesignWindow]) -> tuple[float, float] | None:
    """Range of w0 [m] admissible in every stage of one flexspline, the rest as in each stage's best point; None if there is none."""
    ranges = [(bound.low, bound.high) for window in windows for bound in window.bounds if bound.variable == "amplitude"]
    if len(ranges) < len(windows):
        return None
    low, high = max(low for low, _ in ranges), min(high for _, high in ranges)
    return (low, high) if low <= high else None


def _shown(name: str, value: float) -> str:
    if name == "profile_angle":
        return f"{np.degrees(value):.2f} deg"
    return f"{1e3 * value:.4f} mm"


@dataclass(frozen=True, kw_only=True)
class DesignTask(Described):
    """Tooth numbers, module and what is asked of a stage; straight flanks, unshifted wheels (Stage.standard).

    Leaves out strength: stresses in rim and teeth are no part of it.
    """

    flexible_teeth: int = parameter("1", "teeth of the flexible wheel", low=8, high=5000)
    rigid_teeth: int = parameter("1", "teeth of the rigid wheel; more than the flexible one for outward teeth", low=8, high=5000)
    module: float = parameter("m", "module of the stage", above=0.0, high=0.1)
    fibre_radius: float = parameter("m", "r02, radius of the undeformed neutral fibre", above=0.0, high=10.0)
    deformation: DeformationLaw = option("law whose shape is used; its size is a variable of the design")
    backlash: float = parameter("m", "backlash along the reference circle", low=0.0)
    least_flank_gap: float = parameter("m", "smallest allowed distance of the flanks", default=0.0, low=0.0)
    least_bottom_gap: float = parameter(
        "m", "smallest allowed radial gap between tip and root, and between passing tips", default=0.0, low=0.0
    )
    least_tip_thickness: float = parameter(
        "1", "smallest allowed tip land in modules (usual for hardened teeth: 0.2 to 0.25)", default=0.2, low=0.0
    )

    def check(self) -> None:
        for name in ("flexible_teeth", "rigid_teeth"):
            value = getattr(self, name)
            if value != int(value):
                raise ParameterError(f"DesignTask.{name} = {value:g}: must be a whole number.")
            object.__setattr__(self, name, int(value))
        check_assembly("DesignTask", self.flexible_teeth, self.rigid_teeth, self.deformation.waves, self.direction)

    @classmethod
    def of(cls, stage: Stage, **limits: float) -> Self:
        """The task that a stage of unshifted straight teeth is one answer to."""
        flexible, rigid = stage.flexible, stage.rigid
        if not isinstance(flexible, StraightToothWheel) or not isinstance(rigid, StraightToothWheel):
            raise ParameterError(f"{stage.name}: a design window needs straight teeth; this stage has outlines of its own.")
        modules = [2.0 * wheel.reference_radius / wheel.teeth for wheel in (flexible, rigid)]
        if abs(modules[0] - modules[1]) > 1e-6 * modules[0]:
            raise ParameterError(
                f"{stage.name}: the reference radii give the modules {1e3 * modules[0]:.5g} and {1e3 * modules[1]:.5g} mm; "
                "a design window needs one."
            )
        return cls(
            flexible_teeth=flexible.teeth,
            rigid_teeth=rigid.teeth,
            module=modules[0],
            fibre_radius=stage.fibre_radius,
            deformation=stage.deformation,
            backlash=max(0.0, np.pi * modules[0] - flexible.thickness - rigid.thickness),
            **limits,
        )

    @property
    def direction(self) -> int:
        return 1 if self.rigid_teeth > self.flexible_teeth else -1

    @property
    def nominal_amplitude(self) -> float:
        """Displacement [m] at which the reference circles touch: module * difference of teeth / 2."""
        return self.module * abs(self.rigid_teeth - self.flexible_teeth) / 2.0

    def stage(self, *, profile_angle: float, height: float, clearance: float, amplitude: float) -> Stage:
        """The stage of one design point.  Raises ParameterError where it cannot be made."""
        return Stage.standard(
            flexible_teeth=self.flexible_teeth,
            rigid_teeth=self.rigid_teeth,
            module=self.module,
            profile_angle=profile_angle,
            addendum=(height - clearance) / 2.0,
            clearance=clearance,
            backlash=self.backlash,
            fibre_radius=self.fibre_radius,
            deformation=self.deformation.scaled(amplitude),
            name="design",
        )

    # -- many designs --------------------------------------------------------------------------------------
    def evaluate(
        self, profile_angle: npt.ArrayLike, height: npt.ArrayLike, clearance: npt.ArrayLike, amplitude: npt.ArrayLike
    ) -> DesignPoints:
        """Verdict on designs; the arguments are arrays of one shape (or numbers), in rad and m."""
        given = np.broadcast_arrays(*(np.atleast_1d(np.asarray(x, float)).ravel() for x in (profile_angle, height, clearance, amplitude)))
        alpha, h, c, w0 = given
        for name, values in zip(VARIABLES, given):
            if not np.isfinite(values).all() or np.min(values) < 0.0:
                raise ParameterError(
                    f"DesignTask.evaluate: {name} must be finite and not negative, found {np.min(values):g} {UNITS[name]}."
                )
        if np.max(alpha) > LARGEST_ANGLE:
            raise ParameterError(
                f"DesignTask.evaluate: profile_angle = {np.max(alpha):g} rad: must be at most {LARGEST_ANGLE:.4g} rad "
                f"({np.degrees(LARGEST_ANGLE):g} deg); angles are in rad (use degrees(...))."
            )
        d, m = self.direction, self.module
        addendum = (h - c) / 2.0
        r_f, r_r = m * self.flexible_teeth / 2.0, m * self.rigid_teeth / 2.0
        thickness = np.pi * m / 2.0 - self.backlash / 2.0
        flexible_tip, flexible_root = r_f + d * addendum, r_f - d * (addendum + c)
        rigid_tip, rigid_root = r_r - d * addendum, r_r + d * (addendum + c)
        own = flanks(flexible_tip, flexible_root, r_f, thickness, alpha)
        other = flanks(rigid_tip, rigid_root, r_r, thickness, alpha + d * np.pi / self.rigid_teeth)
        shape_at = self.deformation.radial(np.array([self._engagement, self._start])) / self.deformation.on_major_axis
        unit = UnitFibre.of(self.deformation, self._angles())
        contraction = unit.contraction * w0**2 / self.fibre_radius
        reach, withdrawal = d * (shape_at[0] * w0 + contraction), -d * (shape_at[1] * w0 + contraction)
        tip_thickness = 2.0 * np.minimum(own[:, 1, 0], other[:, 1, 0])
        widest = np.maximum(
            self.flexible_teeth * np.arctan2(own[:, 0, 0], own[:, 0, 1]), self.rigid_teeth * np.arctan2(other[:, 0, 0], other[:, 0, 1])
        )
        bottom = np.minimum(d * (rigid_root - flexible_tip), d * (rigid_tip - flexible_root)) - reach
        depth = d * (flexible_tip - rigid_tip) + reach
        passing = d * (rigid_tip - flexible_tip) + withdrawal
        broken = (
            addendum <= 0.0,
            d * (flexible_root - self.fibre_radius) < 0.0,
            ~(tip_thickness > np.maximum(self.least_tip_thickness * m, 0.0)),
            ~(widest <= np.pi),
            bottom < self.least_bottom_gap,
            depth <= 0.0,
            passing < self.least_bottom_gap,
        )
        verdict = np.zeros(len(alpha), np.intp)
        for number, condition in reversed(list(enumerate(broken, start=1))):
            verdict[condition] = number
        gap, place, share = np.full(len(alpha), -np.inf), np.full(len(alpha), np.nan), np.zeros(len(alpha))
        # teeth that are no teeth are not placed; everything else is, so that the sweep says how far it is from working
        real = np.flatnonzero((verdict == 0) | (verdict >= 5))
        if len(real):
            arrays = StageArrays(
                direction=d,
                relative_turn=(self.flexible_teeth - self.rigid_teeth) / self.rigid_teeth,
                rigid_pitch=2.0 * np.pi / self.rigid_teeth,
                fibre_radius=self.fibre_radius,
                amplitude=w0[real],
                flexible_tip=flexible_tip[real],
                rigid_tip=rigid_tip[real],
                rigid_root=rigid_root[real],
                flexible_flank=own[real],
                rigid_flank=other[real],
            )
            gap[real], place[real], share[real] = smallest_gaps(arrays, unit, self._start, self.least_flank_gap)
        span = np.pi / self.deformation.waves
        off_axis = np.abs(np.mod(place, 2.0 * span) - span)  # angle from the engagement axis, which is at phi = span
        meshing = np.arccos(np.clip(1.0 - np.maximum(depth, 0.0) / np.maximum(w0, 1e-12), -1.0, 1.0)) / self.deformation.waves
        interfering = (verdict == 0) & (gap < self.least_flank_gap)
        verdict[interfering & (off_axis > 0.5 * meshing)] = 8
        verdict[interfering & ~(off_axis > 0.5 * meshing)] = 9
        return DesignPoints(
            profile_angle=alpha,
            height=h,
            clearance=c,
            amplitude=w0,
            verdict=verdict,
            flank_gap=gap,
            gap_angle=place,
            bottom_gap=bottom,
            passing_gap=passing,
            tip_thickness=tip_thickness,
            teeth_in_engagement=share * self.flexible_teeth,
        )

    @property
    def _start(self) -> float:
        return np.pi / self.deformation.waves if self.direction > 0 else 0.0

    @property
    def _engagement(self) -> float:
        return np.pi / self.deformation.waves - self._start

    def _angles(self) -> FloatArray:
        """s from the starting axis backwards; to the engagement axis when all waves are alike and symmetric, else a whole turn."""
        terms = self.deformation.harmonics()
        size = np.max(np.abs(terms))
        alike = not np.any(np.abs(terms[np.arange(len(terms)) % self.deformation.waves != 0]) > 1e-12 * size)
        if alike and np.max(np.abs(terms.imag)) < 1e-12 * size:
            return self._start - np.linspace(0.0, np.pi / self.deformation.waves, STEPS)
        return self._start - 2.0 * np.pi * np.arange(2400) / 2400

    # -- search ------------------------------------------------------------------------------------------
    def search_box(self) -> dict[str, tuple[float, float]]:
        """Ranges that a search covers when none are given: 10 to 45 deg, height 1 to 2.2 and clearance 0.05 to 0.4 modules,
        w0 from 0.8 to 1.25 of the nominal one."""
        m, w0 = self.module, self.nominal_amplitude
        return {
            "profile_angle": (degrees(10.0), degrees(45.0)),
            "height": (1.0 * m, 2.2 * m),
            "clearance": (0.05 * m, 0.4 * m),
            "amplitude": (0.8 * w0, 1.25 * w0),
        }

    def window(self, box: Mapping[str, tuple[float, float]] | None = None, per_variable: int = 10) -> DesignWindow:
        """Search a grid of per_variable^4 designs, choose the best and follow each variable through it to its limits."""
        from scipy.ndimage import binary_erosion

        if per_variable < 2:
            raise ParameterError(f"window: {per_variable} points per variable; a grid needs at least 2.")
        chosen = self.search_box()
        for name, limits in (box or {}).items():
            if name not in chosen:
                raise unknown_place("variable", name, VARIABLES, "A design")
            if not limits[0] < limits[1]:
                raise ParameterError(f"window: the range of {name} is {limits[0]:g} to {limits[1]:g} {UNITS[name]}; it must rise.")
            chosen[name] = limits
        axes = [np.linspace(*chosen[name], per_variable) for name in VARIABLES]
        shape = tuple(len(axis) for axis in axes)
        points = self.evaluate(*(grid.ravel() for grid in np.meshgrid(*axes, indexing="ij")))
        good = points.admissible.reshape(shape)
        inner = binary_erosion(good, border_value=1)
        status = "complete"
        if not inner.any():
            inner = good
            status = "No design stays admissible when one variable changes by one grid step; the best point lies on a limit."
        if not good.any():
            status = "No design of the grid is admissible. Give more backlash, or widen the box; the counts say what stops them."
            return DesignWindow(task=self, box=chosen, shape=shape, points=points, best={}, bounds=(), status=status)
        value = np.where(inner.ravel(), points.teeth_in_engagement, -np.inf)
        finest = np.where(value >= np.max(value) - 1e-9, points.flank_gap, -np.inf)
        index = int(np.argmax(finest))
        best = {name: float(getattr(points, name)[index]) for name in VARIABLES}
        bounds = tuple(self._bound(name, best, chosen[name]) for name in VARIABLES)
        return DesignWindow(task=self, box=chosen, shape=shape, points=points, best=best, bounds=bounds, status=status)

    def _bound(self, name: str, best: Mapping[str, float], limits: tuple[float, float], number: int = 401) -> Bound:
        """Walk from the best point to both ends of the box, then once more within the last step."""
        ends: list[tuple[float, str]] = []
        for end in limits:
            first, last, reason = best[name], end, "edge of the search"
            for _ in range(2):
                line = np.linspace(first, last, number)
                points = self.evaluate(*(line if item == name else best[item] for item in VARIABLES))
                failed = np.flatnonzero(~points.admissible)
                if not len(failed):
                    first = last
                    break
                k = int(failed[0])
                reason = REASONS[points.verdict[k]]
                first, last = float(line[max(0, k - 1)]), float(line[k])
            ends.append((first, reason))
        (low, why_low), (high, why_high) = ends
        return Bound(variable=name, unit=UNITS[name], low=low, high=high, reason_low=why_low, reason_high=why_high)

    def explain(self, *, profile_angle: float, height: float, clearance: float, amplitude: float) -> str:
        """In words, why a design is refused, or what it has."""
        point = self.evaluate(profile_angle, height, clearance, amplitude)
        verdict = int(point.verdict[0])
        words = REASONS[verdict]
        numbers = [f"tip land {1e3 * point.tip_thickness[0]:.4g} mm", f"radial gap at the bottom {1e6 * point.bottom_gap[0]:.1f} um"]
        numbers.append(f"between passing tips {1e6 * point.passing_gap[0]:.1f} um")
        if np.isfinite(point.flank_gap[0]):
            numbers.append(
                f"flank gap {1e6 * point.flank_gap[0]:.1f} um at {np.degrees(point.gap_angle[0]):.1f} deg from the starting axis"
            )
            numbers.append(f"{point.teeth_in_engagement[0]:.0f} of {self.flexible_teeth} teeth with a common height")
        return (
            f"{'Refused' if verdict else 'Admissible'}: {words} ({'; '.join(numbers)})."
            if verdict
            else f"Admissible ({'; '.join(numbers)})."
        )
