"""A harmonic drive in motion: teeth, wave generator, torque over twist, beside the speeds over time."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch, Polygon
from matplotlib.path import Path

from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.components.harmonic_drive import HarmonicDrive
from hdrive_mbs.errors import AnalysisError, unknown_place
from hdrive_mbs.plots.look import COLOURS, GREY, house_look, new_figure, number, readable, style, unit_text
from hdrive_mbs.plots.stroboscope import check_window, moments
from hdrive_mbs.plots.thinning import thinned
from hdrive_mbs.scene import Scene
from hdrive_mbs.signals import FloatArray, TimeHistory
from hdrive_mbs.teeth.section import flexible_teeth, rigid_teeth

FLEXIBLE, RIGID, SOLID = "#9CC9E6", "#D9D9D9", "#F3F3F3"
OVAL = 0.12
"""Ovality at which the wave generator is drawn, where no magnification is given: w0 over its radius."""

PAPER = {"facecolor": "white", "edgecolor": "none", "pad": 2.0, "alpha": 0.85}

PITCHES = 3.2
"""Half width of the close view, in pitches."""

ARCMIN = 60.0 * 180.0 / np.pi


def toothed_drives(scene: Scene, name: str | None) -> str:
    """The name of the drive that is shown.  Raises PlaceError for an unknown one, AnalysisError where none has teeth."""
    drives = [key for key, part in scene.parts.items() if isinstance(part, HarmonicDrive)]
    toothed = [key for key in drives if scene.parts[key].teeth is not None]  # type: ignore[attr-defined]
    if name is not None and name not in toothed:
        raise unknown_place("drive with teeth", name, toothed)
    if not toothed:
        raise AnalysisError(
            f"{scene.name!r} has no gear with teeth to draw"
            + (f" ({', '.join(drives)} is made from a ratio)" if drives else "")
            + ". Make the drive with HarmonicDrive.from_gear(...), or take view='line' for a rotor line."
        )
    return name or toothed[0]


class DrivePicture:
    """The frames of a drive, in the sense in which positive angles turn anticlockwise."""

    def __init__(
        self,
        result: Response,
        scene: Scene,
        name: str,
        window: tuple[float, float] | None,
        count: int,
        seconds: float,
        magnification: float | None,
    ) -> None:
        part = scene.parts[name]
        assert isinstance(part, HarmonicDrive)
        assert part.teeth is not None
        self.count, self._name = count, name
        start, end = check_window(result.times, window)
        self._stage = part.teeth.stages()[0]
        generator, ring = (_angle(result, f"{name}.{flange}") for flange in ("wave_generator", "circular_spline"))
        relative = TimeHistory(f"{name} relative angle", "rad", result.times, generator.values - ring.values)
        self._moments = moments(relative, start, end, count, seconds)
        at = self._moments.times
        self._generator, self._ring = generator.at(at), ring.at(at)
        self._flexspline = result[f"{name}.flexspline.angle"].at(at)
        self._speeds = {key: result[f"{name}.{key}.speed"].at(at) for key in ("wave_generator", "flexspline")}
        self._twist, self._torque = (result[f"{name}.{key}"].at(at) for key in ("twist", "torque"))
        self._half_gap = part.law.half_gap
        one_stage = len(part.teeth.stages()) == 1
        self._taken_up = np.clip(self._twist, -self._half_gap, self._half_gap) if one_stage else np.zeros(count)
        self._output = readable(part.teeth.output)
        w0 = float(np.max(np.abs(part.teeth.deformation.radial(np.linspace(0.0, 2.0 * np.pi, 181)))))  # type: ignore[attr-defined]
        bore = self._stage.fibre_radius - self._stage.direction * (self._stage.fibre_radius - self._stage.flexible.root_radius)
        self._magnified = magnification if magnification is not None else max(1.0, float(f"{OVAL * bore / w0:.1g}"))
        self.description = (
            f"{readable(name)} of {scene.name} in motion from {start:.4g} s to {end:.4g} s: circular spline, flexspline and wave "
            f"generator turning as in the run, teeth going in and out of mesh, torque over twist, speed of the wave generator and torque "
            f"over time. The ovality of the generator is magnified {number(self._magnified)} times; the teeth are to scale."
        )
        with house_look():
            self.figure = new_figure(10.6, 6.6)
            grid = self.figure.add_gridspec(2, 2, height_ratios=(1.9, 1.0), width_ratios=(1.0, 1.0))
            whole = self.figure.add_subplot(grid[0, 0])
            right = grid[0, 1].subgridspec(2, 1)
            close, law = (self.figure.add_subplot(right[k, 0]) for k in range(2))
            history = self.figure.add_subplot(grid[1, :])
            title = f"{scene.name}: {readable(name)}, ratio {number(part.signed_ratio)}, {self._moments.note}"
            self.figure.suptitle(title, x=0.01, ha="left", fontsize=10)
            teeth = "flexspline shifted by the lost motion taken up" if one_stage else "first stage, lost motion not shown"
            note = (
                f"Teeth to scale, {teeth}; ovality of the generator magnified {number(self._magnified)} times. "
                f"Round mark: generator, square mark: {self._output}, triangle: circular spline. Positive angles anticlockwise."
            )
            self.figure.supxlabel(textwrap.fill(note, 160), x=0.01, ha="left", fontsize=8.5, color=GREY)
            self._draw_whole(whole, bore, w0)
            self._draw_close(close)
            self._draw_law(law, result, part, start, end)
            self._cursor = _draw_history(history, result, name, start, end)
        self.moving: list[Artist] = [self._housing, self._body, self._plug, self._axis, self._arrow, self._mark, self._fixed]
        self.moving += [self._words, self._inner, self._teeth, self._state, self._cursor]

    # -- still parts --------------------------------------------------------------------------------
    def _draw_whole(self, ax: Axes, bore: float, w0: float) -> None:
        stage = self._stage
        self._edge = 1e3 * (max(stage.rigid.root_radius, stage.rigid.tip_radius) + 4.0 * stage.rigid.height)
        ax.set_aspect("equal", adjustable="box")
        ax.set_xlim(-1.03 * self._edge, 1.03 * self._edge)
        ax.set_ylim(-1.03 * self._edge, 1.03 * self._edge)
        ax.axis("off")
        numbers = np.arange(stage.rigid.teeth, dtype=float)
        self._rigid = _mirrored(rigid_teeth(stage, numbers).reshape(-1, 2))
        self._housing = PathPatch(Path(np.zeros((3, 2))), facecolor=RIGID, edgecolor="#444444", linewidth=0.4, zorder=1)
        ax.add_patch(self._housing)
        self._body = PathPatch(Path(np.zeros((3, 2))), facecolor=FLEXIBLE, edgecolor=COLOURS[0], linewidth=0.4, zorder=2)
        ax.add_patch(self._body)
        self._cup = 0.90e3 * bore
        angle = np.linspace(0.0, 2.0 * np.pi, 181)
        radius = 0.84e3 * bore + self._magnified * 1e3 * w0 * np.cos(stage.waves * angle) * 0.84
        self._cam = np.stack([-radius * np.sin(angle), radius * np.cos(angle)], axis=1)
        self._plug = Polygon(self._cam, closed=True, facecolor=SOLID, edgecolor=GREY, linewidth=1.0, zorder=3)
        ax.add_patch(self._plug)
        (self._axis,) = ax.plot([], [], color=COLOURS[1], linestyle="-", linewidth=1.6, zorder=4)
        (self._arrow,) = ax.plot([], [], "o", color=COLOURS[1], markersize=7, zorder=5)
        (self._mark,) = ax.plot([], [], "s", color=COLOURS[0], markersize=7, zorder=6)
        (self._fixed,) = ax.plot([], [], "^", color="#444444", markersize=7, zorder=6)
        self._words = ax.text(-0.02, 1.0, "", transform=ax.transAxes, ha="left", va="top", fontsize=9, family="monospace", zorder=8)
        self._inner = ax.text(0.0, -0.22 * self._edge, "", ha="center", va="center", fontsize=8.0, family="monospace", zorder=8, bbox=PAPER)

    def _draw_close(self, ax: Axes) -> None:
        stage = self._stage
        self._shift = np.array([0.0, stage.fibre_radius])
        self._near = np.arange(-np.ceil(PITCHES) - 3.0, np.ceil(PITCHES) + 4.0)
        pitch = 1e3 * stage.rigid.pitch_angle * stage.rigid.tip_radius
        line = 1e3 * (_mirrored(rigid_teeth(stage, self._near).reshape(-1, 2)) - self._shift)
        ax.add_patch(Polygon(_closed(line, stage.direction), closed=True, facecolor=RIGID, edgecolor="#444444", linewidth=0.8))
        self._teeth = Polygon(np.zeros((3, 2)), closed=True, facecolor=FLEXIBLE, edgecolor=COLOURS[0], linewidth=0.8)
        ax.add_patch(self._teeth)
        reach = 1e3 * stage.flexible.height
        radii = 1e3 * (np.array([stage.flexible.root_radius, stage.rigid.root_radius]) - stage.fibre_radius)
        ax.set_xlim(-PITCHES * pitch, PITCHES * pitch)
        ax.set_ylim(radii.min() - 1.0 * reach, radii.max() + 0.6 * reach)
        ax.set_aspect("equal", adjustable="box")
        ax.grid(False)
        ax.set_title("teeth at the top of the circular spline", fontsize=9)
        ax.set_xlabel("along the circle [mm]")
        ax.set_ylabel("from the fibre [mm]")

    def _draw_law(self, ax: Axes, result: Response, part: HarmonicDrive, start: float, end: float) -> None:
        inside = (result.times >= start) & (result.times <= end)
        twist, torque = (result.values[f"{self._name}.{key}"][inside] for key in ("twist", "torque"))
        limit = 1.1 * max(float(np.max(np.abs(twist))), 1.2 * self._half_gap, 1e-9)
        across = np.linspace(-limit, limit, 401)
        if self._half_gap > 0.0:
            ax.axvspan(-ARCMIN * self._half_gap, ARCMIN * self._half_gap, color="#F1E8D6", linewidth=0.0, label="lost motion")
        every = max(1, len(twist) // 6000)
        ax.plot(ARCMIN * twist[::every], torque[::every], color="#BBBBBB", linestyle="-", linewidth=0.5, label="this run")
        ax.plot(ARCMIN * across, np.asarray(part.law.torque(across), float), label="stiffness law", **style(0))
        (self._state,) = ax.plot([], [], "o", color=COLOURS[1], markersize=6)
        ax.set_xlim(-ARCMIN * limit, ARCMIN * limit)
        ax.set_xlabel("twist at the output [arcmin]")
        ax.set_ylabel(f"torque [{unit_text('N m')}]")
        ax.legend(loc="upper left", fontsize=8)

    # -- the frames ---------------------------------------------------------------------------------
    def show(self, number: int) -> None:
        stage = self._stage
        ring, turned = self._ring[number], self._generator[number]
        time, speeds = self._moments.times[number], self._speeds
        # the pattern of the teeth is the same again when the generator has turned by a wave
        phi = (np.mod(turned - ring, 2.0 * np.pi / stage.waves) + stage.start) / (1.0 + stage.relative_turn)
        everyone = flexible_teeth(stage, phi, np.arange(stage.flexible.teeth, dtype=float))
        taken_up = -np.sign(stage.relative_turn) * self._taken_up[number]
        teeth = _turned(_mirrored(everyone), taken_up)
        flexible = teeth.reshape(-1, 2)
        edge = self._edge * np.stack([np.sin(CIRCLE), np.cos(CIRCLE)], axis=1)
        self._housing.set_path(_between(edge, 1e3 * _turned(self._rigid, ring)))
        self._body.set_path(_between(1e3 * _turned(flexible, ring), self._cup * np.stack([np.sin(CIRCLE), np.cos(CIRCLE)], axis=1)))
        self._plug.set_xy(_turned(self._cam, turned))
        tip = _turned(self._cam[:1], turned)[0]
        self._axis.set_data([-tip[0], tip[0]], [-tip[1], tip[1]])
        self._arrow.set_data([0.9 * tip[0]], [0.9 * tip[1]])
        for mark, angle, radius in (
            (self._mark, self._flexspline[number], 0.955e3 * stage.fibre_radius),
            (self._fixed, ring, 0.98 * self._edge),
        ):
            mark.set_data([-radius * np.sin(angle)], [radius * np.cos(angle)])
        self._words.set_text(f"t = {time:7.4f} s")
        self._inner.set_text(
            f"{'generator':<12}{speeds['wave_generator'][number]:8.1f} rad/s\n{self._output:<12}{speeds['flexspline'][number]:8.3f} rad/s\n"
            f"{'torque':<12}{self._torque[number]:8.2f} N m"
        )
        top = np.abs(np.arctan2(-teeth[:, 0, 0], teeth[:, 0, 1])) < (PITCHES + 3.0) * stage.rigid.pitch_angle
        close = teeth[top]
        close = close[np.argsort(close[:, 0, 0])[::-1]]
        self._teeth.set_xy(_closed(1e3 * (close.reshape(-1, 2) - self._shift), -stage.direction))
        self._state.set_data([ARCMIN * self._twist[number]], [self._torque[number]])
        self._cursor.set_xdata([time, time])


CIRCLE = np.linspace(0.0, 2.0 * np.pi, 181)


def _angle(result: Response, place: str) -> TimeHistory:
    """The angle of a flange; zero for one that the ground holds."""
    name = f"{place}.angle"
    if name in result:
        return result[name]
    return TimeHistory(name, "rad", result.times, np.zeros_like(result.times))


def _mirrored(points: FloatArray) -> FloatArray:
    """The frame of the teeth turns clockwise; here positive angles turn anticlockwise."""
    return np.asarray(points * np.array([-1.0, 1.0]), float)


def _turned(points: FloatArray, angle: float) -> FloatArray:
    """Points (..., 2) turned anticlockwise."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points @ np.array([[c, s], [-s, c]]), float)


def _closed(line: FloatArray, side: int) -> FloatArray:
    """An open contour with a body of 4 mm behind it."""
    ends = line[[-1, 0]].copy()
    ends[:, 1] += side * 4.0
    return np.vstack((line, ends))


def _between(outside: FloatArray, inside: FloatArray) -> Path:
    """The area between two contours, whichever way they run."""
    rings = []
    for points, wanted in ((outside, 1.0), (inside, -1.0)):
        x, y = points[:, 0], points[:, 1]
        area = np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
        rings.append(points if np.sign(area) == wanted else points[::-1])
    return Path.make_compound_path(*(Path(np.vstack((ring, ring[:1])), closed=True) for ring in rings))


def _draw_history(ax: Axes, result: Response, name: str, start: float, end: float) -> Any:
    """Speeds and torque over time; returns the cursor."""
    inside = (result.times >= start) & (result.times <= end)
    times = result.times[inside]
    ax.plot(*thinned(times, result.values[f"{name}.wave_generator.speed"][inside]), label="wave generator", **style(0))
    ax.set_ylabel("wave generator [rad/s]")
    beside = ax.twinx()
    beside.plot(
        *thinned(times, result.values[f"{name}.torque"][inside]), label="torque", **{**style(2), "linestyle": "-", "linewidth": 0.8}
    )
    beside.set_ylabel(f"torque of {readable(name)} [{unit_text('N m')}]", color=COLOURS[2])
    beside.spines["right"].set_visible(True)
    beside.grid(False)
    ax.set_xlabel("time [s]")
    ax.set_xlim(start, end)
    return ax.axvline(start, color=COLOURS[1], linestyle="-", linewidth=1.3)
