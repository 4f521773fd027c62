"""How visible a planted cause is beside the tolerances: the D of a case.

D = min over b of |S - Y(b) + Y(0)|^2 + |b|^2: S is the change of all channels that the cause makes at the nominal bench, in units
of noise and rounding (probes without their mean, as their offsets are unknown), Y(b) the channels of a bench without the cause whose
toleranced values are b standard deviations away. So D is what the best bench without the cause leaves unexplained. A value outside
its tolerance costs its own square. Below about 25 no method can tell. The minimum is searched with a Jacobian that is updated
(Broyden), not computed anew; where the search stops early D is too large, never too small.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

import numpy as np

from benchmarks.withheld.plant.rotor_line.equations import FloatArray
from benchmarks.withheld.plant.rotor_line.machine import NOMINAL, TOLERANCE
from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.records import PROBES, RECORDS, UnstableError
from benchmarks.withheld.plant.rotor_line.sensors import CHANNELS, shown

_STEP = 0.1  # standard deviations
_TRUST = 6.0  # standard deviations a step
_NAMES = tuple(TOLERANCE)


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
def _nominal(records: tuple[str, ...]) -> tuple[FloatArray, FloatArray]:
    """The nominal channels, and their changes by one standard deviation of each toleranced value."""
    base = whitened(_bench(np.zeros(len(_NAMES))), records)
    return base, np.stack([(whitened(_bench(_STEP * axis), records) - base) / _STEP for axis in np.eye(len(_NAMES))], axis=1)


def detectability(changed: Planted, *, tries: int = 6, records: tuple[str, ...] = RECORDS) -> tuple[float, float]:
    """(D, |S|^2) of what is planted in a bench with otherwise nominal values."""
    base, jacobian = _nominal(records)
    jacobian = jacobian.copy()
    target = whitened(changed, records)
    b, rest = np.zeros(len(_NAMES)), target - base
    raw = cost = float(rest @ rest)
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
        if longest < 1e-9:
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
    return cost, raw
