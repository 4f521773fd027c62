"""Wrong units: an angle and the integral of the speed at the same place must grow alike.

Over stretches of time the increment of the angle is compared with the integral of the speed,
increment = ratio * integral + offset * time, by least squares.  A ratio of 1 is right; one of pi/30,
180/pi, 1000 ... names the unit that the numbers are really in.  Two channels that are wrong by the
same factor agree and are not found.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hdrive_mbs.records.finding import Finding
from hdrive_mbs.records.measurement import Measurement

if TYPE_CHECKING:
    from hdrive_mbs.records.record import Record

PAIRS = {"rad": "rad/s", "rad/s": "rad/s^2", "m": "m/s", "m/s": "m/s^2"}
"""Unit and unit of its rate."""

STRETCHES = 200
"""Stretches into which a record is cut."""

CLEAR = 0.98
"""Squared correlation from which the ratio of two channels is believed."""

TOLERANCE = 0.02
"""Relative deviation of a ratio from a known factor: scale errors of sensors are smaller."""

_RATE_IN = {
    "rad/s": {"rpm": math.pi / 30.0, "deg/s": math.pi / 180.0, "revolution/s": 2.0 * math.pi},
    "rad/s^2": {"rpm/s": math.pi / 30.0, "deg/s^2": math.pi / 180.0, "revolution/s^2": 2.0 * math.pi},
    "m/s": {"mm/s": 1e-3, "inch/s": 0.0254, "km/h": 1.0 / 3.6},
    "m/s^2": {"g_0": 9.80665, "mm/s^2": 1e-3},
}
_WHOLE_IN = {
    "rad": {"deg": math.pi / 180.0, "revolution": 2.0 * math.pi, "arcmin": math.pi / 10800.0},
    "rad/s": {"rpm": math.pi / 30.0, "deg/s": math.pi / 180.0, "revolution/s": 2.0 * math.pi},
    "m": {"mm": 1e-3, "um": 1e-6, "inch": 0.0254},
    "m/s": {"mm/s": 1e-3, "inch/s": 0.0254},
}

_KIND_WORDS = frozenset(
    [
        *("angle", "ang", "position", "pos", "phi", "theta", "turn", "rotation", "displacement", "disp"),
        *("speed", "velocity", "vel", "omega", "w", "rate", "dot", "acceleration", "acc", "accel", "alpha"),
        *("rad", "deg", "rpm", "mm", "um"),
    ]
)
"""Words of a name that tell the kind or unit, not the place."""


def contradicting_units(record: Record) -> Iterator[Finding]:
    """Pairs of a quantity and its rate at one place whose sizes differ by a factor."""
    if len(record) < 16 or not np.all(np.isfinite(record.times)) or not np.all(np.diff(record.times) > 0.0):
        return
    channels = list(record)
    for whole, rate in itertools.permutations(channels, 2):
        if PAIRS.get(whole.unit) != rate.unit:
            continue
        together = _same_place(whole, rate)
        alone = [item.unit for item in channels].count(whole.unit) == 1 == [item.unit for item in channels].count(rate.unit)
        if not (together or alone):
            continue
        ratio = growth_ratio(record.times, whole.values, rate.values)
        if ratio is not None and abs(ratio - 1.0) > TOLERANCE:
            finding = _judged(whole, rate, ratio, together)
            if finding is not None:
                yield finding


def _judged(whole: Measurement, rate: Measurement, ratio: float, together: bool) -> Finding | None:
    causes = [
        f"{rate.name} is in {unit} (units={{{rate.name!r}: {unit!r}}})" for unit, size in _RATE_IN[rate.unit].items() if _near(ratio, size)
    ]
    causes += [
        f"{whole.name} is in {unit} (units={{{whole.name!r}: {unit!r}}})"
        for unit, size in _WHOLE_IN[whole.unit].items()
        if _near(ratio, 1.0 / size)
    ]
    causes += [
        f"{whole.name} is in {whole.unit} and was read as {unit}" for unit, size in _WHOLE_IN[whole.unit].items() if _near(ratio, size)
    ]
    causes += [
        f"{rate.name} is in {rate.unit} and was read as {unit}" for unit, size in _RATE_IN[rate.unit].items() if _near(ratio, 1.0 / size)
    ]
    causes += [
        f"{whole.name} is in {one} and {rate.name} in {other}"
        for one, size in _WHOLE_IN[whole.unit].items()
        for other, scale in _RATE_IN[rate.unit].items()
        if _near(ratio, scale / size)
    ]
    if _near(ratio, 1e-3) and "m" not in whole.unit.split("/"):
        causes.append("the time is in ms")
    if not causes and not together:
        return None  # two places with a gear between them may have any ratio
    if causes:
        text = f"{whole.name} grows {ratio:.4g} times as much as the integral of {rate.name}; as if {' or '.join(causes)}. "
        text += "units='keep' leaves it as it is"
    elif _near(ratio, -1.0):
        text = f"{whole.name} falls where the integral of {rate.name} rises: their positive senses are opposite"
    else:
        text = f"{whole.name} grows {ratio:.4g} times as much as the integral of {rate.name}: a gear between them, a scale, or a wrong unit"
    return Finding(kind="units", channel=rate.name, where="", blocks=together and bool(causes) and ratio > 0.0, text=text)


def _near(ratio: float, known: float) -> bool:
    return abs(ratio / known - 1.0) <= TOLERANCE


def _same_place(one: Measurement, other: Measurement) -> bool:
    if one.quantity is not None and other.quantity is not None:
        return one.quantity.rpartition(".")[0] == other.quantity.rpartition(".")[0]
    first, second = _place_words(one.name), _place_words(other.name)
    return bool(first) and first == second


def _place_words(name: str) -> tuple[str, ...]:
    """``act_vel_mot_deg_per_s[1]`` -> (act, mot, 1): what is left without the words for kind and unit."""
    parted = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()
    words = re.findall(r"[a-z]+|\d+", re.sub(r"_per_(?:s|sec|min)\d?(?![a-z])", "", parted))
    return tuple(word for word in words if word not in _KIND_WORDS)


def growth_ratio(times: np.ndarray, whole: np.ndarray, rate: np.ndarray) -> float | None:
    """Increments of ``whole`` per integral of ``rate`` over stretches of time; None where they are not proportional."""
    good = np.isfinite(whole) & np.isfinite(rate)
    if good.sum() < 16:
        return None
    t, y, v = times[good], whole[good], rate[good]
    integral = np.concatenate(([0.0], np.cumsum(np.diff(t) * (v[1:] + v[:-1]) / 2.0)))
    edges = np.unique(np.linspace(0, len(t) - 1, min(STRETCHES, len(t) // 4) + 1).astype(int))
    a, b, span = np.diff(y[edges]), np.diff(integral[edges]), np.diff(t[edges])
    if np.std(b) > 0.2 * abs(np.mean(b)):  # an offset of the rate sensor can be told from its scale
        design = np.column_stack((b, span))
        solution = np.linalg.lstsq(design, a, rcond=None)[0]
        rest, total = a - design @ solution, a - span * (span @ a) / (span @ span)
    else:
        solution = np.array([(b @ a) / (b @ b) if b @ b > 0.0 else 0.0])
        rest, total = a - solution[0] * b, a
    power = float(total @ total)
    if power == 0.0 or float(rest @ rest) > (1.0 - CLEAR) * power or solution[0] == 0.0:
        return None
    return float(solution[0])
