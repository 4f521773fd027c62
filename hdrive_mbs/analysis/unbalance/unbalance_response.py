"""Steady response of a rotor line to its unbalance over speed."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.unbalance.bent_bearings import bent_bearings
from hdrive_mbs.analysis.unbalance.between_speeds import between_speeds
from hdrive_mbs.analysis.unbalance.response_peaks import ResponsePeak, peaks
from hdrive_mbs.analysis.unbalance.speed_line import check_lateral, free_to_turn
from hdrive_mbs.analysis.unbalance.unbalanced_line import DIRECTIONS, UnbalancedLine
from hdrive_mbs.analysis.unbalance.whirl_orbit import WhirlOrbit, lag
from hdrive_mbs.analysis.whirl.lateral_stability import instability
from hdrive_mbs.errors import AnalysisError, ParameterError, unknown_place
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.progress import progress_bar
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class PlaceResponse(WhirlOrbit):
    """Motion of one place at one frequency: an orbit, and the tilts that go with it.

    speeds : of the reference shaft [rad/s]
    psi, theta : complex amplitudes of the tilts about x and y, 0-peak [rad]; zero for a housing
    """

    place: str
    speeds: FloatArray
    psi: ComplexArray
    theta: ComplexArray

    @property
    def phase_lag_x(self) -> FloatArray:
        """Lag of x behind the angle of the reference shaft [rad], from -pi/4 up to 7 pi/4."""
        return lag(self.x)

    @property
    def phase_lag_y(self) -> FloatArray:
        """Lag of y behind the angle of the reference shaft [rad]; for forward circles pi/2 more than that of x."""
        return lag(self.y)


@dataclass(frozen=True, kw_only=True, eq=False)
class UnbalanceResponse(Result):
    """Steady whirl over the speed of the reference shaft, seen from the fixed frame; every amplitude is 0-peak.

    ``response["rotor_1"]`` has the orbit of a place over the speeds: ``.major``, ``.minor``, ``.inclination``,
    ``.forward``, ``.backward``, ``.phase_lag_x`` and the complex amplitudes.

    speeds : of the reference shaft [rad/s], shape (s,), ascending
    places : p names
    frequency_ratios : frequency over reference speed of g groups; the first is 1 where a rotor that turns with the
        reference shaft has unbalance.  Rotors behind a gear make groups of their own
    x, y, psi, theta : complex amplitudes A of Re[A exp(i w t)], shape (g, s, p) [m, rad]; t = 0 where the reference
        shaft has the angle 0, so -arg A is the lag behind it.  NaN at a speed that has no steady amplitude
    senses : +1 or -1, sense of the spin at each place for positive reference speed, shape (p,)
    bearings : b names
    force_x, force_y : complex amplitudes of the forces of the bearings on their housings [N], shape (g, s, b)
    peak_places, peak_speeds, peak_amplitudes, peak_widths : see ``peaks``
    between : speeds, x, ... force_y at further speeds, where a phase turns quickly; ``refined`` puts them in
    seconds : CPU time
    """

    speeds: FloatArray
    places: tuple[str, ...]
    frequency_ratios: FloatArray
    x: ComplexArray
    y: ComplexArray
    psi: ComplexArray
    theta: ComplexArray
    senses: FloatArray
    bearings: tuple[str, ...]
    force_x: ComplexArray
    force_y: ComplexArray
    peak_places: tuple[str, ...]
    peak_speeds: FloatArray
    peak_amplitudes: FloatArray
    peak_widths: FloatArray
    seconds: float
    between: Mapping[str, np.ndarray] = field(default_factory=dict)

    def __getitem__(self, place: str) -> PlaceResponse:
        return self.of(place)

    def of(self, place: str, group: int = 0) -> PlaceResponse:
        """The response of a place at the frequency of a group."""
        if place not in self.places:
            raise unknown_place("place", place, self.places, "This response")
        k = self.places.index(place)
        sense = self.senses[k] * np.where(self.speeds < 0.0, -1.0, 1.0)
        x, y, psi, theta = (values[group, :, k] for values in (self.x, self.y, self.psi, self.theta))
        return PlaceResponse(x, y, sense, place, self.speeds, psi, theta)

    def force(self, bearing: str, group: int = 0) -> WhirlOrbit:
        """The force of a bearing on its housing over the speeds: an orbit in N."""
        if bearing not in self.bearings:
            raise unknown_place("bearing", bearing, self.bearings, "This response")
        k = self.bearings.index(bearing)
        return WhirlOrbit(self.force_x[group, :, k], self.force_y[group, :, k], np.where(self.speeds < 0.0, -1.0, 1.0))

    def tables(self) -> tuple[PrintedTable, ...]:
        """Peaks of each place."""
        heads = ("place", "speed [rad/s]", "amplitude, 0-peak [m]", "half-power width [rad/s]", "quality factor")
        rows = tuple((one.place, one.speed, one.amplitude, one.width, one.quality) for one in self.peaks)
        first, last = float(np.min(self.speeds)), float(np.max(self.speeds))
        title = "peaks of the unbalance response" if rows else f"no peak of the unbalance response from {first:g} to {last:g} rad/s"
        return (PrintedTable(title=title, heads=heads, rows=rows),)

    @property
    def peaks(self) -> tuple[ResponsePeak, ...]:
        """Maxima of the major semi-axis at the first frequency, by place: speed, amplitude, width and quality."""
        rows = zip(self.peak_places, self.peak_speeds.tolist(), self.peak_amplitudes.tolist(), self.peak_widths.tolist(), strict=True)
        return tuple(
            ResponsePeak(place, speed, size, width, abs(speed) / width if width > 0.0 else (np.inf if width == 0.0 else np.nan))
            for place, speed, size, width in rows
        )

    def at(self, place: str, speed: float, group: int = 0) -> PlaceResponse:
        """The response of a place at one speed [rad/s], calculated for it (arrays of one value)."""
        return self._again([speed], self._extra()).of(place, group)

    def orbit(self, place: str, speed: float, *, turns: float = 1.0, points: int = 361) -> tuple[FloatArray, FloatArray]:
        """x and y [m] of a place about its static position over turns of the reference shaft, all frequencies together."""
        there = self._again([speed], self._extra())
        angle = np.linspace(0.0, 2.0 * np.pi * turns, points)
        turning = np.exp(1j * np.outer(there.frequency_ratios, angle))
        k = there.places.index(there[place].place)
        x, y = (np.real(values[:, 0, k] @ turning) for values in (there.x, there.y))
        return np.asarray(x), np.asarray(y)

    def refined(self) -> UnbalanceResponse:
        """The same with more speeds where a phase turns quickly, so many that no curve of the polar diagram has corners."""
        if not self.between:
            return self
        speeds = np.concatenate([self.speeds, self.between["speeds"]])
        order = np.argsort(speeds)
        others: dict[str, Any] = {
            name: np.concatenate([getattr(self, name), more], axis=1)[:, order] for name, more in self.between.items() if name != "speeds"
        }
        return dataclasses.replace(self, speeds=speeds[order], between={}, **others)

    def influence(self, plane: str) -> UnbalanceResponse:
        """Influence coefficients: the response to 1 kg m at angle 0 at a plane alone [m/(kg m), rad/(kg m), N/(kg m)]."""
        one = self._again(self.speeds, {plane: (1.0, 0.0)}, rotors=False)
        # what 1 kg m would bend is of no interest: the notes on amplitudes are those of this response
        return dataclasses.replace(one, status=self.status)

    def correction(self, planes: Sequence[str], places: Sequence[str], speed: float) -> dict[str, tuple[float, float]]:
        """Correction masses, plane -> (kg m, angle [rad]), that bring x and y of places at a speed nearest to zero.

        Least squares over influence coefficients (Goodman 1964, without weights); hand the result to ``extra``.
        Raises AnalysisError where the places cannot tell the planes apart.
        """
        now = self._again([speed], self._extra())

        def column(response: UnbalanceResponse) -> ComplexArray:
            picked = [response[place] for place in places]
            return np.concatenate([[one.x[0], one.y[0]] for one in picked])

        columns = []
        for plane in planes:
            unit = self._again([speed], {plane: (1.0, 0.0)}, rotors=False)
            if abs(unit.frequency_ratios[0] - now.frequency_ratios[0]) > 1e-9:
                raise AnalysisError(
                    f"{plane!r} turns at another speed than the unbalance of the first frequency, so no mass there balances it."
                )
            columns.append(column(unit))
        matrix, motion = np.array(columns).T, column(now)
        scale = np.linalg.norm(matrix, axis=0)
        if not len(columns) or np.any(scale == 0.0) or np.linalg.cond(matrix / scale) > 1e8:
            raise AnalysisError(
                f"At {speed:g} rad/s the places {', '.join(places)} cannot tell the planes {', '.join(planes)} apart. "
                "Take another speed, more places or fewer planes."
            )
        solved = -np.linalg.lstsq(matrix, motion, rcond=None)[0]
        senses = {plane: now.senses[now.places.index(plane)] * (1.0 if speed >= 0.0 else -1.0) for plane in planes}
        return {plane: (float(abs(u)), float(senses[plane] * np.angle(u))) for plane, u in zip(planes, solved, strict=True)}

    def columns(self) -> dict[str, np.ndarray]:
        table: dict[str, np.ndarray] = {"speed [rad/s]": self.speeds}
        for group, ratio in enumerate(self.frequency_ratios):
            before = "" if group == 0 else f"frequency {ratio:.6g} x: "
            for place in self.places:
                one = self.of(place, group)
                named = before + place
                table |= {
                    f"{named} major semi-axis, 0-peak [m]": one.major,
                    f"{named} minor semi-axis, 0-peak [m]": one.minor,
                    f"{named} inclination [rad]": one.inclination,
                    f"{named} forward, 0-peak [m]": one.forward,
                    f"{named} backward, 0-peak [m]": one.backward,
                }
                for key in DIRECTIONS:
                    amplitude, unit = getattr(one, key), "m" if key in "xy" else "rad"
                    table |= {f"{named} {key}, 0-peak [{unit}]": np.abs(amplitude), f"{named} {key} lag [rad]": lag(amplitude)}
            for bearing in self.bearings:
                force = self.force(bearing, group)
                table |= {f"{before}{bearing} force {key}, 0-peak [N]": np.abs(getattr(force, key)) for key in "xy"}
        return table

    def _extra(self) -> dict[str, tuple[float, float]]:
        return {place: (size, angle) for place, (size, angle) in self.settings["extra"].items()}

    def _again(
        self, speeds: Sequence[float] | FloatArray, extra: Mapping[str, tuple[float, float]], rotors: bool | None = None
    ) -> UnbalanceResponse:
        if self.scene is None:
            raise AnalysisError("This response came from a file without its scene, so nothing more can be calculated from it.")
        with_rotors = bool(self.settings["rotors"]) if rotors is None else rotors
        return unbalance_response(self.scene, speeds, extra=extra, rotors=with_rotors, progress=False)


def unbalance_response(
    scene: Scene,
    speeds: Sequence[float] | FloatArray,
    *,
    extra: Mapping[str, tuple[float, float]] | None = None,
    rotors: bool = True,
    progress: bool | None = None,
) -> UnbalanceResponse:
    """Steady whirl of a line under static and dynamic unbalance:  (K + i w D - w^2 M) Q = F  at each speed.

    speeds : of the reference shaft (the motor's, else the first of the line) [rad/s], ascending
    extra : place -> (mass times radius [kg m], angle [rad] from x towards y, turning with the place): trial masses
    rotors : whether the unbalance of the rotors counts too

    F_x + i F_y = m e w^2 exp(i phi),  M_y - i M_x = -(J_xz + i J_yz) w^2 exp(i phi)  with phi = w t + angle (signs as in
    the exact equations of the rotors; any book on rotor dynamics, e.g. Genta, Dynamics of Rotating Systems, 2005).
    Bearings that are not linear, or change with speed, are linearised about the static deflection at each speed, which
    ``status`` says.  Leaves out what small motions leave out (amplitudes that bend a bearing's law), and torsional
    vibration by m g e: every spin is held at its steady speed.

    Raises AnalysisError for a line that is balanced, only turns, or is unstable within the speeds, and ParameterError
    for speeds that do not increase.
    """
    started = time.process_time()
    grid = _checked(speeds)
    check_lateral(scene, "An unbalance response")
    free = free_to_turn(scene)
    with progress_bar(f"{scene.name}: unbalance response", 1.0, progress) as report:
        model = UnbalancedLine.build(free, grid, extra or {}, rotors, report)
        unstable = instability(model.line, grid)
        if unstable is not None:
            raise AnalysisError(_unstable_text(scene, grid, unstable.speed, unstable.growth, unstable.frequency))
        found = peaks(lambda at: model.major(at), grid, model.hints(), model.places, model.own_places())
        values: dict[str, Any] = _amplitudes(model, grid)
        between = _between(model, grid, values["x"][0], found)
    return UnbalanceResponse(
        scene=scene,
        status="; ".join(["complete", *_notes(model, grid, values, found)]),
        settings={
            "speeds": f"{grid[0]:g} .. {grid[-1]:g} rad/s, {len(grid)} points",
            "extra": {place: tuple(float(v) for v in value) for place, value in (extra or {}).items()},
            "rotors": rotors,
        },
        speeds=grid,
        places=model.places,
        frequency_ratios=np.array([ratio for ratio, _ in model.groups]),
        senses=model.senses,
        bearings=model.bearings,
        peak_places=tuple(peak.place for peak in found),
        peak_speeds=np.array([peak.speed for peak in found]),
        peak_amplitudes=np.array([peak.amplitude for peak in found]),
        peak_widths=np.array([peak.width for peak in found]),
        seconds=time.process_time() - started,
        between=between,
        **values,
    )


def _amplitudes(model: UnbalancedLine, speeds: FloatArray) -> dict[str, ComplexArray]:
    """x, y, psi, theta, (groups, s, places), and force_x, force_y, (groups, s, bearings)."""
    motion, force = (np.array(part) for part in zip(*(model.response(group, speeds) for group in range(len(model.groups))), strict=True))
    return {key: motion[..., k] for k, key in enumerate(DIRECTIONS)} | {"force_x": force[..., 0], "force_y": force[..., 1]}


def _between(model: UnbalancedLine, grid: FloatArray, x: ComplexArray, found: list[ResponsePeak]) -> dict[str, np.ndarray]:
    """What ``refined`` puts in."""
    tops = np.array([peak.speed for peak in found])
    endless = np.array([peak.amplitude == np.inf for peak in found], bool)
    lost = grid[np.any(~np.isfinite(x), axis=1)]
    hints = np.concatenate([model.hints(damped=True), tops[~endless]])
    speeds = between_speeds(model.curves, grid, hints, np.concatenate([tops[endless], lost]))
    return {"speeds": speeds, **_amplitudes(model, speeds)} if len(speeds) else {}


def _checked(speeds: Sequence[float] | FloatArray) -> FloatArray:
    try:
        grid = np.atleast_1d(np.asarray(speeds, float))
    except (TypeError, ValueError):
        grid = np.zeros(0)
    if grid.ndim != 1 or not len(grid) or not np.all(np.isfinite(grid)):
        raise ParameterError("speeds: give a list of speeds of the reference shaft [rad/s].")
    if not np.all(np.diff(grid) > 0.0):
        k = int(np.argmin(np.diff(grid) > 0.0))
        raise ParameterError(
            f"speeds must increase, but {grid[k]:g} rad/s is followed by {grid[k + 1]:g} rad/s. Give them in ascending order."
        )
    return grid


def _unstable_text(scene: Scene, grid: FloatArray, speed: float, growth: float, frequency: float) -> str:
    start = f"from {speed:.6g} rad/s on" if speed > grid[0] else f"already at {speed:.6g} rad/s"
    return (
        f"{scene.name!r} has no steady response up to {grid[-1]:g} rad/s: it is unstable {start} (a whirl of "
        f"{frequency:.4g} rad/s grows with {growth:.3g} 1/s). End the speeds below, or look for what feeds whirl: rotating_damping of "
        "shafts, stiffness_xy unlike stiffness_yx of bearings, the oil film of a JournalBearing that turns fast or carries little; "
        "damping of bearings and foundations works against it."
    )


def _notes(model: UnbalancedLine, grid: FloatArray, values: Mapping[str, ComplexArray], found: list[ResponsePeak]) -> list[str]:
    notes = []
    if model.line.varying:
        tops = np.array([peak.speed for peak in found if np.isfinite(peak.amplitude)])
        notes += bent_bearings(model, np.union1d(grid, tops))
    if len(model.groups) > 1:
        others = ", ".join(f"{ratio:.6g}" for ratio, _ in model.groups[1:])
        notes.append(f"unbalance at other frequencies too ({others} per reference speed), in further groups")
    lost = grid[np.any([~np.isfinite(values[key]) for key in DIRECTIONS], axis=(0, 1, 3))]
    endless = sorted({f"{peak.speed:.6g}" for peak in found if peak.amplitude == np.inf} | {f"{speed:.6g}" for speed in lost}, key=float)
    if endless:
        notes.append(f"no steady amplitude at {', '.join(endless)} rad/s: an undamped critical speed; give bearings or foundations damping")
    return notes
