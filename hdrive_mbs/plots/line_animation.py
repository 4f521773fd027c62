"""A rotor line in motion: deflected shafts with discs, bearings and orbits, beside speed and distance from the axis."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Polygon
from scipy.interpolate import CubicHermiteSpline

from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.analysis.whirl.rotor_places import reference_shaft, rotor_masses
from hdrive_mbs.components.bearing import Bearing
from hdrive_mbs.components.supported_section import SupportedSection
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.plots.lengths import shown_unit
from hdrive_mbs.plots.look import COLOURS, GREY, house_look, new_figure, number, readable, style
from hdrive_mbs.plots.shafts import drive_order, shaft_numbers
from hdrive_mbs.plots.stroboscope import check_window, moments
from hdrive_mbs.plots.thinning import thinned
from hdrive_mbs.scene import Scene
from hdrive_mbs.signals import FloatArray

SEEN = 0.08
"""Largest displacement in the picture over the length of the line, where no magnification is given."""

INTO = np.array([0.42, 0.26])
"""Where x, which points into the picture, is drawn per metre: to the right and up."""

TRAIL = 48
"""Points of the last turn that an orbit shows."""

WHIRLING = 0.05
"""Rotors that move less than this share of the largest motion have no orbit of their own."""

CIRCLE = np.linspace(0.0, 2.0 * np.pi, 49)
_NOWHERE = np.zeros((3, 2))
WEDGE = np.radians(np.linspace(-18.0, 18.0, 9))


@dataclass(frozen=True)
class _Station:
    """A place on a shaft: where it is drawn along the picture, and its motion in each frame (x, y, psi, theta)."""

    place: str
    shaft: int
    along: float
    motion: FloatArray


class LinePicture:
    """The frames of a rotor line."""

    def __init__(
        self,
        result: Response,
        scene: Scene,
        window: tuple[float, float] | None,
        count: int,
        seconds: float,
        magnification: float | None,
    ) -> None:
        self.count = count
        start, end = check_window(result.times, window)
        reference = reference_shaft(scene)
        self._moments = moments(result[f"{reference}.angle"], start, end, count, seconds)
        at = self._moments.times
        self._stations = _stations(result, scene, at)
        self._length = max(item.along for item in self._stations) or 1.0
        self._rotors = [name for name in rotor_masses(scene) if f"{name}.x" in result]
        self._bearings = [name for name, part in scene.parts.items() if isinstance(part, (Bearing, SupportedSection))]
        self._bearings = [name for name in self._bearings if any(item.place == name for item in self._stations)]
        self._place = {item.place: item for item in self._stations}
        self._spin = {name: result[f"{name}.angle"].at(at) for name in self._rotors}
        self._housing = {
            name: np.stack([result[f"{name}.housing.{key}"].at(at) for key in "xy"], axis=1)
            for name in self._bearings
            if f"{name}.housing.x" in result
        }
        self._trails = {name: _trail(result, name, at) for name in self._rotors}
        inside = (result.times >= start) & (result.times <= end)
        reach = {name: float(np.max(np.hypot(*(result.values[f"{name}.{key}"][inside] for key in "xy")))) for name in self._rotors}
        largest = max([*reach.values(), *(float(np.max(np.hypot(*s.motion[:, :2].T))) for s in self._stations)])
        self._scale = magnification if magnification is not None else _readable_scale(SEEN * self._length / largest if largest else 1.0)
        self._whirling = [name for name in self._rotors if reach[name] >= WHIRLING * max(reach.values())] if largest else []
        self._sizes = {name: _disc_radius(scene, name, self._length) for name in self._rotors}
        self._speed = result[f"{reference}.speed"].at(at)
        self._reference = reference
        self.description = (
            f"{scene.name} in motion from {start:.4g} s to {end:.4g} s: deflected shafts with discs, bearings and orbits, displacements "
            f"magnified {number(self._scale)} times, beside the speed of {readable(reference)} and the rotors' distances from the axis."
        )
        with house_look():
            self.figure = new_figure(10.0, 6.2)
            grid = self.figure.add_gridspec(2, 2, height_ratios=(1.75, 1.0), width_ratios=(2.3, 1.0))
            self._line = self.figure.add_subplot(grid[0, 0])
            self._orbits = self.figure.add_subplot(grid[0, 1])
            bottom = grid[1, :].subgridspec(1, 2)
            panels = [self.figure.add_subplot(bottom[0, k]) for k in range(2)]
            self.figure.suptitle(f"{scene.name}: displacements magnified {number(self._scale)} times", x=0.01, ha="left")
            note = f"{self._moments.note}; amplitudes 0-peak"
            self.figure.supxlabel(textwrap.fill(note, 150), x=0.01, ha="left", fontsize=8.5, color=GREY)
            self._draw_still(result, largest)
            self._draw_orbits(largest)
            self._cursors = _histories(panels, result, reference, self._whirling, start, end)
        orbits = [artist for pair in self._orbit_lines.values() for artist in pair]
        drawn = (self._shafts, self._discs, self._wedges, self._boxes, self._rings)
        self.moving: list[Artist] = [artist for group in drawn for artist in group.values()]
        self.moving += [self._paths, self._clock, *orbits, *self._cursors]

    # -- what stands still, and empty artists for what moves ------------------------------------------
    def _project(self, along: Any, x: Any, y: Any) -> FloatArray:
        """Places in the picture [m], (..., 2), of points at a position along the shafts; x and y as drawn."""
        return np.stack([np.asarray(along) + INTO[0] * np.asarray(x), np.asarray(y) + INTO[1] * np.asarray(x)], axis=-1)

    def _draw_still(self, result: Response, largest: float) -> None:
        ax, length = self._line, self._length
        height = max([*self._sizes.values(), 0.06 * length])
        self._box = 0.045 * length
        ax.set_aspect("equal", adjustable="box")
        ax.set_xlim(-0.10 * length, 1.10 * length)
        ax.axis("off")
        for shaft in dict.fromkeys(item.shaft for item in self._stations):
            ends = [item.along for item in self._stations if item.shaft == shaft]
            ax.plot([min(ends), max(ends)], [0.0, 0.0], color=GREY, linestyle=(0, (8, 3, 1, 3)), linewidth=0.7, zorder=1)
        floor = -1.18 * height
        for name in self._bearings:
            z = self._place[name].along
            ax.plot([z - self._box, z + self._box], [floor, floor], color=GREY, linestyle="-", linewidth=1.2, zorder=1)
            ax.plot([z, z], [floor, -self._box], color=GREY, linestyle=":", linewidth=1.0, zorder=1)
        self._name_places(floor, height)
        self._shafts = {
            shaft: ax.plot([], [], color="#333333", linestyle="-", linewidth=3.2, solid_capstyle="round", zorder=6)[0]
            for shaft in dict.fromkeys(item.shaft for item in self._stations)
        }
        self._discs: dict[str, Polygon] = {}
        self._wedges: dict[str, Polygon] = {}
        for k, name in enumerate(self._rotors):
            colour = self._colour(name, k)
            self._discs[name] = Polygon(_NOWHERE, facecolor=colour, edgecolor=colour, alpha=0.32, linewidth=1.0, zorder=4)
            self._wedges[name] = Polygon(_NOWHERE, facecolor=colour, edgecolor="none", zorder=5)
        self._boxes = {name: Polygon(_NOWHERE, fill=False, edgecolor="#444444", linewidth=1.6, zorder=7) for name in self._bearings}
        for patch in [*self._discs.values(), *self._wedges.values(), *self._boxes.values()]:
            ax.add_patch(patch)
        self._rings = {name: ax.plot([], [], color="#444444", linestyle="-", linewidth=1.0, zorder=7)[0] for name in self._bearings}
        self._paths = LineCollection([], colors=[self._colour(name, k) for k, name in enumerate(self._rotors)], linewidths=1.2, zorder=8)
        ax.add_collection(self._paths)
        self._clock = ax.text(0.0, 1.0, "", transform=ax.transAxes, ha="left", va="top", fontsize=10, family="monospace")
        self._draw_scales(largest, height)

    def _draw_scales(self, largest: float, height: float) -> None:
        """A length along the shafts in its true size, and one of magnified displacement."""
        ax, length = self._line, self._length
        along = _readable_scale(0.18 * length)
        factor, unit = shown_unit("m", max(along, 0.0))
        across = _readable_scale(largest) if largest > 0.0 else 0.0
        low, left = -1.75 * height - self._scale * across, 0.0  # below the names of the bearings
        ax.set_ylim(low - 0.25 * height, 1.7 * height)
        ax.plot([left, left + along], [low, low], color="black", linestyle="-", linewidth=1.2, marker="|")
        ax.annotate(
            f"{number(factor * along)} {unit} along z",
            (left + along, low),
            xytext=(8, 0),
            textcoords="offset points",
            va="center",
            fontsize=8.5,
        )
        if across > 0.0:
            factor, unit = shown_unit("m", across)
            x = 0.55 * length
            ax.plot([x, x], [low, low + self._scale * across], color="black", linestyle="-", linewidth=1.2, marker="_")
            ax.annotate(
                f"{number(factor * across)} {unit} across, magnified",
                (x, low),
                xytext=(8, 0),
                textcoords="offset points",
                va="center",
                fontsize=8.5,
            )

    def _name_places(self, floor: float, height: float) -> None:
        """Names of the rotors above and of the bearings below, in two rows where they are close together."""
        for names, low, step, side in (
            (self._rotors, 1.08 * height, 0.17 * height, "bottom"),
            (self._bearings, floor - 0.05 * height, -0.17 * height, "top"),
        ):
            row, before = 0, -np.inf
            for name in sorted(names, key=lambda item: self._place[item].along):
                z = self._place[name].along
                row = (row + 1) % 3 if z - before < 0.16 * self._length else 0
                before = z
                self._line.text(z, low + row * step, readable(name), ha="center", va=side, fontsize=8.0, color="#333333")

    def _colour(self, name: str, index: int) -> str:
        whirling = self._whirling.index(name) if name in self._whirling else None
        return COLOURS[whirling % len(COLOURS)] if whirling is not None else "#888888"

    def _draw_orbits(self, largest: float) -> None:
        ax = self._orbits
        self._unit, unit = shown_unit("m", largest)
        limit = 1.08 * self._unit * largest or 1.0
        ax.set_aspect("equal", adjustable="box")
        ax.set_xlim(-limit, limit)
        ax.set_ylim(-limit, limit)
        ax.set_xlabel(f"x [{unit}]")
        ax.set_ylabel(f"y [{unit}]")
        ax.set_title("last turn of the rotors' centres, 0-peak", fontsize=9)
        ax.plot([0.0], [0.0], "+", color=GREY, markersize=8)
        self._orbit_lines = {
            name: (
                ax.plot([], [], label=readable(name), **style(k))[0],
                ax.plot([], [], "o", color=COLOURS[k % len(COLOURS)], markersize=5)[0],
            )
            for k, name in enumerate(self._whirling)
        }
        if self._whirling:
            ax.legend(loc="upper right", fontsize=8, handlelength=1.6)

    # -- the frames ---------------------------------------------------------------------------------
    def show(self, number: int) -> None:
        time, speed = self._moments.times[number], self._speed[number]
        self._clock.set_text(f"t = {time:8.4f} s   {readable(self._reference)}: {speed:7.1f} rad/s = {30.0 / np.pi * speed:6.0f} rpm")
        for shaft, line in self._shafts.items():
            points = self._shaft(shaft, number)
            line.set_data(points[:, 0], points[:, 1])
        paths = []
        for name in self._rotors:
            self._discs[name].set_xy(self._disc(name, number, CIRCLE, 0.0))
            self._wedges[name].set_xy(self._disc(name, number, self._spin[name][number] + WEDGE, 0.25))
            trail = self._trails[name][number]
            paths.append(self._project(self._place[name].along, self._scale * trail[:, 0], self._scale * trail[:, 1]))
        self._paths.set_segments(paths)
        for name in self._bearings:
            x, y = self._housing[name][number] if name in self._housing else (0.0, 0.0)
            z, h = self._place[name].along, self._box
            corners = np.array([[-h, -h], [h, -h], [h, h], [-h, h]]) + self._scale * np.array([x, y])
            self._boxes[name].set_xy(self._project(z, corners[:, 0], corners[:, 1]))
            ring = self._scale * self._place[name].motion[number, :2] + 0.55 * h * np.stack([np.cos(CIRCLE), np.sin(CIRCLE)], axis=1)
            self._rings[name].set_data(*self._project(z, ring[:, 0], ring[:, 1]).T)
        for name, (line, dot) in self._orbit_lines.items():
            trail = self._unit * self._trails[name][number]
            line.set_data(trail[:, 0], trail[:, 1])
            dot.set_data(trail[-1:, 0], trail[-1:, 1])
        for cursor in self._cursors:
            cursor.set_xdata([time, time])

    def _shaft(self, shaft: int, number: int) -> FloatArray:
        """The centre line: x' = theta, y' = -psi at the stations."""
        own = [item for item in self._stations if item.shaft == shaft]
        z = np.array([item.along for item in own])
        x, y, psi, theta = np.array([item.motion[number] for item in own]).T * self._scale
        if len(own) == 1:
            return self._project(z, x, y)
        fine = np.linspace(z[0], z[-1], 40 * len(own))
        return self._project(fine, CubicHermiteSpline(z, x, theta)(fine), CubicHermiteSpline(z, y, -psi)(fine))

    def _disc(self, name: str, number: int, angles: FloatArray, inner: float) -> FloatArray:
        """A disc, or a piece of it from ``inner`` of its radius on; tilted by psi and theta."""
        station, radius = self._place[name], self._sizes[name]
        x, y, psi, theta = station.motion[number] * self._scale
        rims = [radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)]
        if inner:
            rims.append(inner * rims[0][::-1])
        points = np.vstack(rims)
        lean = np.clip(psi, -0.5, 0.5) * points[:, 1] - np.clip(theta, -0.5, 0.5) * points[:, 0]
        return self._project(station.along + lean, x + points[:, 0], y + points[:, 1])


def _stations(result: Response, scene: Scene, times: FloatArray) -> list[_Station]:
    """All places with lateral motion, in the order of the drive, shafts that would lie on each other one behind the other."""
    at = scene.network().positions
    keys = ("x", "y", "psi", "theta")
    places = [place for place in at if all(f"{place}.{key}" in result for key in keys)]
    if not places:
        raise AnalysisError(f"The run of {scene.name!r} has no place with displacement and tilt.")
    rotors = rotor_masses(scene)
    numbers = dict(zip(places, shaft_numbers(scene, places), strict=True))
    order = [places[k] for k in drive_order(scene, places)]
    shafts = list(dict.fromkeys(numbers[place] for place in order))
    total = sum(float(np.ptp([at[place] for place in places if numbers[place] == shaft])) for shaft in shafts) or 1.0
    found, taken = [], -np.inf
    for shaft in shafts:
        own = [place for place in places if numbers[place] == shaft]
        start, end = min(at[place] for place in own), max(at[place] for place in own)
        shift = taken + 0.2 * total - start if start < taken - 1e-9 * total else 0.0
        taken = end + shift
        met: dict[float, str] = {}
        for place in sorted(own, key=lambda item: (item not in rotors, item not in scene.parts, "." in item)):
            met.setdefault(round(at[place], 9), place)
        for z in sorted(met):
            motion = np.stack([result[f"{met[z]}.{key}"].at(times) for key in keys], axis=1)
            found.append(_Station(met[z], shaft, z + shift, motion))
    lowest = min(item.along for item in found)
    return [_Station(item.place, item.shaft, item.along - lowest, item.motion) for item in found]


def _trail(result: Response, name: str, times: FloatArray) -> FloatArray:
    """x and y over the last turn before each frame, (frames, TRAIL, 2); of what hardly turns over a quarter of a second."""
    speed = np.abs(result[f"{name}.speed"].at(times))
    period = np.minimum(2.0 * np.pi / np.maximum(speed, 1e-9), 0.25)
    back = np.clip(times[:, None] - period[:, None] * np.linspace(1.0, 0.0, TRAIL), result.times[0], None)
    return np.stack([result[f"{name}.{key}"].at(back.ravel()).reshape(back.shape) for key in "xy"], axis=2)


def _disc_radius(scene: Scene, name: str, length: float) -> float:
    """Radius [m] at which a rotor is drawn: that of the disc of its mass and inertia, sqrt(2 Jp/m), within what the picture takes."""
    mass = rotor_masses(scene)[name]
    return float(np.clip(np.sqrt(2.0 * mass.inertia[2][2] / mass.mass), 0.03 * length, 0.16 * length))


def _readable_scale(value: float) -> float:
    """The largest 1, 2 or 5 times a power of ten that is not above the value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value * (1.0 + 1e-9)))


def _histories(panels: list[Axes], result: Response, reference: str, whirling: list[str], start: float, end: float) -> list[Any]:
    """Speed, and distances from the axis, over time; returns the cursors."""
    inside = (result.times >= start) & (result.times <= end)
    times = result.times[inside]
    left, right = panels
    left.plot(*thinned(times, result.values[f"{reference}.speed"][inside]), **style(0))
    left.set_ylabel(f"speed of {readable(reference)} [rad/s]")
    values = {name: result.values[f"{name}.radial"][inside] for name in whirling}
    factor, unit = shown_unit("m", max((float(np.max(item)) for item in values.values()), default=0.0))
    for k, (name, item) in enumerate(values.items()):
        right.plot(*thinned(times, factor * item), label=readable(name), color=COLOURS[k % len(COLOURS)], linestyle="-", linewidth=0.7)
    right.set_ylabel(f"distance from axis [{unit}]")
    cursors = []
    for ax in panels:
        ax.set_xlabel("time [s]")
        ax.set_xlim(start, end)
        cursors.append(ax.axvline(start, color=COLOURS[1], linestyle="-", linewidth=1.2))
    return cursors
