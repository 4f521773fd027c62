"""The angle of a shaft as an axis: where it keeps turning one way, and when it takes given values."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from hdrive_mbs.analysis.signals.source import MeasuredChannels, Source, readable
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.signals import FloatArray, TimeHistory

TURN = 2.0 * np.pi


def shaft_history(given: Source | MeasuredChannels, against: str | TimeHistory) -> TimeHistory:
    """The angle meant by a history, a channel ("motor.angle") or a place ("motor").  Raises ParameterError for what is no angle."""
    if isinstance(against, TimeHistory):
        return against
    source = readable(given)
    if isinstance(source, TimeHistory):
        raise ParameterError(f"against = {against!r} names a channel, but a single time history has none; give the angle as a TimeHistory.")
    found = source[against if against in source or against.endswith(".angle") else f"{against}.angle"]
    if found.unit != "rad":
        raise ParameterError(f"{found.name} is in {found.unit}, but turns are counted by an angle [rad].")
    return found


def slope_at(shaft: TimeHistory, times: FloatArray) -> FloatArray:
    """Slope of the interpolated angle."""
    if shaft.slope is not None:
        return np.asarray(CubicHermiteSpline(shaft.times, shaft.values, shaft.slope)(times, 1), float)
    return np.asarray(PchipInterpolator(shaft.times, shaft.values)(times, 1), float)


@dataclass(frozen=True, eq=False)
class ShaftAngle:
    """Angle of a shaft over a span in which it keeps turning one way.

    times, angles, speeds : s, rad, rad/s at the samples of the record and at both ends of the span
    direction : +1 or -1
    """

    name: str
    times: FloatArray
    angles: FloatArray
    speeds: FloatArray
    direction: float

    @classmethod
    def over(cls, shaft: TimeHistory, begin: float, finish: float) -> ShaftAngle:
        """Raises AnalysisError where the shaft stands or turns back; it may start or end at rest."""
        inside = shaft.between(begin, finish)
        times = np.unique(np.concatenate([[begin], inside.times, [finish]]))
        angles, speeds = shaft.at(times), slope_at(shaft, times)
        return cls(shaft.name, times, angles, speeds, _direction(shaft.name, times, angles, speeds))

    @property
    def turns(self) -> float:
        """Revolutions over the span."""
        return float(abs(self.angles[-1] - self.angles[0]) / TURN)

    def times_of(self, wanted: FloatArray) -> FloatArray:
        """Times at which the (Hermite) angle takes the wanted values: bisection within each own step."""
        curve = CubicHermiteSpline(self.times, self.angles, self.speeds)
        times, angles, direction = self.times, self.angles, self.direction
        place = np.clip(np.searchsorted(direction * angles, direction * wanted, side="right") - 1, 0, len(times) - 2)
        low, high = times[place], times[place + 1]
        guess = low + (high - low) * (wanted - angles[place]) / (angles[place + 1] - angles[place])
        for _ in range(60):
            error = direction * (curve(guess) - wanted)
            low, high = np.where(error < 0.0, guess, low), np.where(error < 0.0, high, guess)
            slope = direction * curve(guess, 1)
            newton = guess - error / np.where(slope > 0.0, slope, 1.0)
            new = np.where((slope > 0.0) & (newton >= low) & (newton <= high), newton, 0.5 * (low + high))
            if np.max(np.abs(new - guess)) <= 1e-15 * max(abs(times[-1]), 1e-300):
                break
            guess = new
        return np.asarray(np.clip(guess, times[0], times[-1]), float)


def turning_span(shaft: TimeHistory, begin: float, finish: float) -> tuple[float, float]:
    """The longest part of a span in which the shaft turns one way, by revolutions [s].

    A run-up from rest may begin with a shiver, a coast-down end with one: neither has an order.
    """
    inside = shaft.between(begin, finish)
    steps = np.sign(np.diff(inside.values))
    if inside.slope is not None:
        inner = np.sign(inside.slope)
        inner[[0, -1]] = 0.0
        steps = np.where((inner[:-1] * steps < 0.0) | (inner[1:] * steps < 0.0), 0.0, steps)
    edges = np.concatenate([[0], np.nonzero(np.diff(steps))[0] + 1, [len(steps)]]).astype(int)
    spans = [(first, last) for first, last in itertools.pairwise(edges) if last > first and steps[first] != 0.0]
    if not spans:
        raise AnalysisError(f"{shaft.name} does not turn from {begin:g} s to {finish:g} s.")
    first, last = max(spans, key=lambda span: abs(inside.values[span[1]] - inside.values[span[0]]))
    return float(inside.times[first]), float(inside.times[last])


def _direction(name: str, times: FloatArray, angles: FloatArray, speeds: FloatArray) -> float:
    """+1 or -1; raises AnalysisError where the shaft stands or turns back."""
    direction = 1.0 if angles[-1] >= angles[0] else -1.0
    backwards = direction * speeds <= 0.0
    backwards[[0, -1]] = direction * speeds[[0, -1]] < 0.0  # the run may start or end at rest
    backwards[1:] |= direction * np.diff(angles) <= 0.0
    if backwards.any():
        turning = np.nonzero(np.sign(speeds[1:]) * np.sign(speeds[:-1]) <= 0.0)[0]
        where = turning if len(turning) else np.nonzero(backwards)[0]
        first, last = times[where[0]], times[where[-1]]
        when = f"at t = {first:.4g} s" if first == last else f"first at t = {first:.4g} s and last at t = {last:.4g} s"
        raise AnalysisError(
            f"{name} does not run in one direction: it stands still or turns back {when}. An angle that repeats cannot be the axis; "
            "choose start and end where the shaft keeps turning."
        )
    return direction
