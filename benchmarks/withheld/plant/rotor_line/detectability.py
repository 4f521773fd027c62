"""How visible planted causes are beside the tolerances.

S is the change of all channels that the causes make at the nominal bench, in units of noise and rounding (probes without their mean,
as their offsets are unknown); Y(b) the channels of a bench without them whose toleranced values are b standard deviations away.

- linear: min over b of |S - J b|^2 + |b|^2 with the nominal bench's J: the gain in fit that the right cause brings over the best
  bench without it. Right for faint causes, an order of magnitude for strong ones, and far too large for a value outside its tolerance;
- refitted: min over b of |S - Y(b) + Y(0)|^2 + |b|^2, searched for with a Jacobian that is updated (Broyden) and not computed anew:
  where the search stops early it is too large, never too small. A value outside its tolerance costs at most its own square.

Below about 25 no method can tell.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from benchmarks.withheld.plant.rotor_line.equations import FloatArray
from benchmarks.withheld.plant.rotor_line.machine import NOMINAL, TOLERANCE
from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.records import PROBES, RECORDS, UnstableError
from benchmarks.withheld.plant.rotor_line.sensors import CHANNELS, shown

_STEP = 0.1  # standard deviations
_TRUST = 6.0  # standard deviations a step
_NAMES = tuple(TOLERANCE)


class Visible(NamedTuple):
    """The two figures, and |S|^2."""

    linear: float
    refitted: float
    raw: float


def whitened(bench: Planted, records: Sequence[str] = RECORDS) -> FloatArray:
    """All channels of the records in units of noise and rounding, probes without their mean."""
    found = []
    for run in bench.runs(records).values():
        for name, value in shown(run, bench.sensors).items():
            _, noise, resolution = CHANNELS[name]
            centred = value - value.mean() if name in PROBES else value
            found.append(centred / math.hypot(noise, resolution / math.sqrt(12.0)))
    return np.concatenate(found)


def _bench(b: FloatArray) -> Planted:
    values = dict(NOMINAL)
    for name, deviation in zip(_NAMES, b, strict=True):
        values[name] *= math.exp(deviation * TOLERANCE[name])
    return Planted(values=values)


@cache
def nominal(records: tuple[str, ...] = RECORDS) -> tuple[FloatArray, FloatArray]:
    """The nominal channels, and their changes by one standard deviation of each toleranced value; computed once a process."""
    base = whitened(_bench(np.zeros(len(_NAMES))), records)
    return base, np.stack([(whitened(_bench(_STEP * axis), records) - base) / _STEP for axis in np.eye(len(_NAMES))], axis=1)


def linear(change: FloatArray, *beside: FloatArray, records: tuple[str, ...] = RECORDS) -> float:
    """What the nominal bench's tolerances leave of a change; ``beside`` are changes by other causes, free in their size."""
    jacobian = nominal(records)[1]
    columns = np.column_stack([jacobian, *beside]) if beside else jacobian
    right = columns.T @ change
    held = np.eye(right.size)
    held[jacobian.shape[1] :] *= 1e-9 * max(1.0, float(change @ change))
    return max(float(change @ change) - float(right @ np.linalg.solve(columns.T @ columns + held, right)), 0.0)


def detectability(changed: Planted, *, tries: int = 6, records: tuple[str, ...] = RECORDS) -> Visible:
    """How visible is what is planted in a bench with otherwise nominal values."""
    base, jacobian = nominal(records)
    jacobian = jacobian.copy()
    target = whitened(changed, records)
    b, rest = np.zeros(len(_NAMES)), target - base
    raw = cost = float(rest @ rest)
    first = linear(rest, records=records)
    # where toleranced values themselves are changed, the change may be the best explanation: looked at first
    known = np.array([math.log(changed.values[name] / NOMINAL[name]) / TOLERANCE[name] for name in _NAMES])
    if known.any():
        left = target - whitened(_bench(known), records)
        reached = float(left @ left) + float(known @ known)
        if reached < cost:
            b, rest, cost = known, left, reached
    damping = 0.0
    square = jacobian.T @ jacobian
    for _ in range(tries):
        step = np.linalg.solve(square * (1.0 + damping * np.eye(b.size)) + np.eye(b.size), jacobian.T @ rest - b)
        longest = float(np.max(np.abs(step)))
        if longest < 1e-9 or cost <= float(b @ b) * (1.0 + 1e-9):
            break
        step *= min(1.0, _TRUST / longest)
        try:
            left = target - whitened(_bench(b + step), records)
        except UnstableError:
            break
        error = (rest - left) - jacobian @ step
        jacobian += np.outer(error, step / float(step @ step))
        square = jacobian.T @ jacobian
        reached = float(left @ left) + float((b + step) @ (b + step))
        if reached < cost:
            small = cost - reached < 0.01 * reached
            b, rest, cost, damping = b + step, left, reached, 0.3 * damping
            if small and damping < 1e-2:
                break
        else:
            damping = max(10.0 * damping, 1e-2)
    return Visible(first, min(first, cost) if known.any() else cost, raw)
