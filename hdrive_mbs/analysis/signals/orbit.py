"""Orbit of a place in the plane across the axis: its path, its ellipse in step with the spin, and its sense."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.run_up.rest_positions import FreeLine, rest_position
from hdrive_mbs.analysis.signals.plane_signal import PlaneSignal, turning_place
from hdrive_mbs.analysis.signals.shaft_angle import TURN, shaft_history, slope_at
from hdrive_mbs.analysis.signals.source import MeasuredChannels, Source, readable
from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.analysis.whirl.rotor_places import rotor_masses, spin_ratios
from hdrive_mbs.errors import AnalysisError, ParameterError, unknown_place
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.signals import FloatArray, TimeHistory

PER_REVOLUTION = 96
"""Points drawn in a revolution at least."""

MOST_POINTS = 400_000

STRAIGHT = 0.02
"""Size of the roundness below which a path has no sense."""

CHANGED = 0.02
"""Change of the speed over the window above which the ellipse is called a mean."""

CENTRES = ("geometric", "mass")
ORIGINS = ("axis", "static", "mean")


@dataclass(frozen=True, kw_only=True, eq=False)
class Orbit(Result):
    """Path of a place over a window; lengths are 0-peak.

    place, centre, about : what moves ("geometric" or "mass" centre) and what it is counted from
    unit : of x and y
    times, x, y : the path [s, m, m]
    angle, speed : of the spin on the path, true sense [rad, rad/s]
    origin : what was taken off x and y [m]
    marks : path where the spin angle is a whole number of revolutions (key phase), rows of (x, y)
    forward, backward : radii of the two circles in step with the spin, in and against its sense (least squares over the
        whole revolutions of the window; NaN with less than one)
    major, minor, inclination : of the ellipse that both make; direction of the major axis from x towards y [rad]
    roundness : integral of x dy - y dx in the sense of the spin over that of |r| |dr|: 1 for a forward circle, -1 for a
        backward one, 0 for a path to and fro; about the mean of the path
    precession : "forward", "backward" or "straight"
    """

    place: str
    centre: str
    about: str
    unit: str
    times: FloatArray
    x: FloatArray
    y: FloatArray
    angle: FloatArray
    speed: FloatArray
    origin: tuple[float, float]
    marks: FloatArray
    forward: float
    backward: float
    major: float
    minor: float
    inclination: float
    roundness: float
    precession: str

    @property
    def radius(self) -> FloatArray:
        """Distance from the origin [m]."""
        return np.hypot(self.x, self.y)

    def tables(self) -> tuple[PrintedTable, ...]:
        """Size, shape and sense of the path."""
        rows = (
            (f"largest distance from the origin [{self.unit}]", float(np.max(self.radius))),
            (f"forward circle in step with the spin, 0-peak [{self.unit}]", self.forward),
            (f"backward circle in step with the spin, 0-peak [{self.unit}]", self.backward),
            (f"major axis of the ellipse of both, 0-peak [{self.unit}]", self.major),
            (f"minor axis, 0-peak [{self.unit}]", self.minor),
            ("inclination of the major axis, from x towards y [rad]", self.inclination),
            ("roundness, 1 for forward circles", self.roundness),
            ("precession", self.precession),
        )
        title = f"{self.centre} centre of {self.place} about {self.about}, {self.times[0]:.6g} to {self.times[-1]:.6g} s"
        return (PrintedTable(title=title, heads=("figure", "value"), rows=rows),)

    def columns(self) -> dict[str, np.ndarray]:
        return {
            "time [s]": self.times,
            f"x [{self.unit}]": self.x,
            f"y [{self.unit}]": self.y,
            "spin angle [rad]": self.angle,
            "speed [rad/s]": self.speed,
        }


def orbit(
    response: Source,
    place: str | tuple[str, str],
    *,
    centre: str = "geometric",
    about: str = "axis",
    start: float | None = None,
    end: float | None = None,
    slowest: float | None = None,
    fastest: float | None = None,
    reference: str | TimeHistory | None = None,
) -> Orbit:
    """Path of a place in x and y.

    response : also a measured record
    place : with channels x and y: a rotor, a bearing, ``bearing_a.housing``; also ``bearing_a.force`` [N]; or two channels (x, y)
    centre : "geometric", or "mass" for the centre of mass of a rotor (self-centring: seed M, Fig. 7)
    about : count from the "axis", from the "static" deflection at the mean speed of the window, or from the "mean" of the path
    start, end : window in time [s]
    slowest, fastest : window in speed of the spin [rad/s, size]: from when it first enters to when it leaves the range
    reference : place, channel of the angle or history [rad] whose spin counts; the place itself, or the reference shaft for one that does
        not turn

    Raises AnalysisError for an empty window.
    """
    if centre not in CENTRES:
        raise ParameterError(f"centre = {centre!r}: must be one of {', '.join(CENTRES)}.")
    if about not in ORIGINS:
        raise ParameterError(f"about = {about!r}: must be one of {', '.join(ORIGINS)}.")
    source = readable(response)
    if isinstance(source, TimeHistory):
        raise ParameterError("A single time history has no plane; an orbit needs a response or a record.")
    signal = PlaneSignal.of(response, place)
    if not signal.plane:
        raise ParameterError(f"{place!r} is one channel; an orbit needs a place that has x and y, like a rotor or a bearing.")
    shaft = shaft_history(source, turning_place(source, signal.name, reference))
    spin = _spin(source, shaft)
    begin, finish = _window(signal, spin, start, end, slowest, fastest)
    times = _times(source.times, begin, finish, shaft)
    z = np.asarray(signal.at(times), complex)
    angle, speed = shaft.at(times), spin.at(times)
    if centre == "mass":
        z = z + _to_mass_centre(source, signal.name, angle, times)
    origin = _origin(source, signal.name, about, z, float(np.mean(speed)), shaft)
    z = z - origin
    p, n = _circles(angle, z)  # exp(i angle) turns with the spin, whatever its sense
    roundness = _roundness(z, float(np.sign(np.mean(speed)) or 1.0))
    changed = float(np.ptp(speed)) > CHANGED * float(np.max(np.abs(speed)))
    return Orbit(
        scene=source.scene,
        status="complete; the speed changes over the window, so the ellipse is a mean" if changed else "complete",
        settings={"start": begin, "end": finish, "slowest": slowest, "fastest": fastest, "reference": shaft.name},
        place=signal.name,
        centre=centre,
        about=about,
        unit=signal.unit,
        times=times,
        x=z.real.copy(),
        y=z.imag.copy(),
        angle=angle,
        speed=speed,
        origin=(origin.real, origin.imag),
        marks=_marks(angle, z),
        forward=abs(p),
        backward=abs(n),
        major=abs(p) + abs(n),
        minor=abs(abs(p) - abs(n)),
        inclination=float(0.5 * np.pi - np.mod(0.5 * np.pi - 0.5 * (np.angle(p) + np.angle(n)), np.pi)),
        roundness=roundness,
        precession="straight" if abs(roundness) < STRAIGHT else "forward" if roundness > 0.0 else "backward",
    )


def _window(
    signal: PlaneSignal, spin: TimeHistory, start: float | None, end: float | None, slowest: float | None, fastest: float | None
) -> tuple[float, float]:
    begin, finish = signal.span(start, end)
    low, high = (0.0 if slowest is None else slowest), (np.inf if fastest is None else fastest)
    if not 0.0 <= low < high:
        raise ParameterError(f"slowest = {low:g} rad/s and fastest = {high:g} rad/s: must rise, from 0 rad/s.")
    inside = (spin.times >= begin) & (spin.times <= finish)
    within = np.nonzero(inside & (np.abs(spin.values) >= low) & (np.abs(spin.values) <= high))[0]
    if len(within) < 3:
        seen = np.abs(spin.values[inside])
        raise AnalysisError(
            f"From {begin:g} s to {finish:g} s {spin.name} lies between {seen.min(initial=np.inf):.4g} rad/s and "
            f"{seen.max(initial=0.0):.4g} rad/s: fewer than 3 samples between {low:g} and {high:g} rad/s."
        )
    if slowest is None and fastest is None:
        return begin, finish
    # the first pass through the range, up to where it is left for longer than torsional vibration lasts
    gaps = np.nonzero(np.diff(spin.times[within]) > 0.1 * (finish - begin))[0]
    last = within[gaps[0]] if len(gaps) else within[-1]
    return float(spin.times[within[0]]), float(spin.times[last])


def _times(own: FloatArray, begin: float, finish: float, shaft: TimeHistory) -> FloatArray:
    """The samples of the run, or closer ones where a revolution has few."""
    inside = own[(own > begin) & (own < finish)]
    turns = abs(float(shaft.at(finish) - shaft.at(begin))) / TURN
    if len(inside) >= 0.5 * PER_REVOLUTION * turns:
        return np.concatenate([[begin], inside, [finish]])
    return np.linspace(begin, finish, min(int(PER_REVOLUTION * turns) + 2, MOST_POINTS))


def _spin(source: Response | MeasuredChannels, shaft: TimeHistory) -> TimeHistory:
    """Speed of the shaft; where none is recorded the slope of its angle."""
    name = f"{shaft.name.removesuffix('.angle')}.speed"
    return source[name] if name in source else TimeHistory(name, "rad/s", shaft.times, slope_at(shaft, shaft.times))


def _to_mass_centre(response: Response | MeasuredChannels, place: str, angle: FloatArray, times: FloatArray) -> np.ndarray:
    """x + i y from the geometric centre of a rotor to its centre of mass."""
    if isinstance(response, MeasuredChannels) or response.scene is None:
        raise AnalysisError("This response or record comes without its scene, so the centre of mass is unknown; take centre='geometric'.")
    masses = rotor_masses(response.scene)
    if place not in masses:
        raise unknown_place("rotor", place, masses)
    x, y, z = masses[place].centre
    arm = np.asarray(complex(x, y) * np.exp(1j * angle))
    if z != 0.0:
        arm = arm + z * (response.at(f"{place}.theta", times) - 1j * response.at(f"{place}.psi", times))
    return arm


def _origin(response: Response | MeasuredChannels, place: str, about: str, z: np.ndarray, speed: float, shaft: TimeHistory) -> complex:
    if about == "axis":
        return 0j
    if about == "mean":
        return complex(np.mean(z))
    scene = response.scene
    if scene is None:
        raise AnalysisError("This response or record comes without its scene, so the static deflection is unknown; take about='mean'.")
    network, turning = scene.network(), shaft.name.removesuffix(".angle")
    names = [channel.name for channel in network.channels]
    if turning not in network.places or not {f"{place}.x", f"{place}.y"} <= set(names):
        asked = f"the shaft {turning!r}" if turning not in network.places else repr(place)
        raise ParameterError(f"about = 'static': {asked} is no place of the scene with a static deflection; take about='mean'.")
    ratio = spin_ratios(scene).get(network.places[turning], 0.0) or 1.0
    known = getattr(response, "static_deflection", {})
    if place in known:
        return complex(rest_position(known[place], np.array([speed / ratio]))[0])
    line = FreeLine(scene)
    return complex(line.positions(line.point(abs(speed / ratio)), [place])[0])


def _circles(angle: FloatArray, z: np.ndarray) -> tuple[complex, complex]:
    """p and n of  z = c + p exp(i angle) + n exp(-i angle), least squares over whole revolutions."""
    turns = np.floor(abs(angle[-1] - angle[0]) / TURN * (1.0 + 1e-9))
    if turns < 1.0:
        return complex(np.nan), complex(np.nan)
    whole = np.abs(angle - angle[0]) <= turns * TURN * (1.0 + 1e-12)
    phase = np.exp(1j * angle[whole])
    # each sample counts for the angle it stands for, so that the sums are integrals over the angle
    weight = np.sqrt(np.abs(np.gradient(angle[whole])))
    basis = np.stack([np.ones_like(phase), phase, phase.conj()], axis=1)
    found = np.linalg.lstsq(basis * weight[:, None], z[whole] * weight, rcond=None)[0]
    return complex(found[1]), complex(found[2])


def _roundness(z: np.ndarray, sense: float) -> float:
    """Area swept about the mean, over the largest that the same steps could sweep."""
    r = z - np.mean(z)
    step, middle = np.diff(r), 0.5 * (r[1:] + r[:-1])
    most = float(np.sum(np.abs(middle) * np.abs(step)))
    return sense * float(np.sum((middle.conj() * step).imag)) / most if most > 0.0 else 0.0


def _marks(angle: FloatArray, z: np.ndarray) -> FloatArray:
    """(x, y) at whole revolutions of the spin angle."""
    rising = angle if angle[-1] >= angle[0] else -angle
    whole = np.arange(np.ceil(rising[0] / TURN), np.floor(rising[-1] / TURN) + 1.0) * TURN
    if not len(whole) or np.any(np.diff(rising) <= 0.0):
        return np.zeros((0, 2))
    return np.stack([np.interp(whole, rising, z.real), np.interp(whole, rising, z.imag)], axis=1)
