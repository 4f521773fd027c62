"""How visible a planted cause is beside the tolerances: the D of a case.

D = min over b of |S - J b|^2 + |b|^2 with S the change of all channels in units of their noise (probe offsets taken out of each
record), J the changes by one standard deviation of each toleranced value at the nominal bench. Below about 25 no method can tell.
It is linear in the tolerances: with large causes it overstates a little what refitted values could not take up.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from benchmarks.withheld.plant.rotor_line.equations import FloatArray
from benchmarks.withheld.plant.rotor_line.machine import NOMINAL, TOLERANCE
from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.records import PROBES
from benchmarks.withheld.plant.rotor_line.sensors import CHANNELS, shown

_STEP = 0.1  # standard deviations: the error of the difference stays below a hundredth of a column


def whitened(bench: Planted) -> FloatArray:
    """All channels of all records in units of noise and rounding, probes without their mean."""
    found = []
    for run in bench.runs().values():
        for name, value in shown(run, bench.sensors).items():
            _, noise, resolution = CHANNELS[name]
            centred = value - value.mean() if name in PROBES else value
            found.append(centred / math.hypot(noise, resolution / math.sqrt(12.0)))
    return np.concatenate(found)


@cache
def _nominal() -> tuple[FloatArray, FloatArray]:
    """The nominal channels, and an orthonormal-ready Jacobian in standard deviations."""
    base = whitened(Planted(values=dict(NOMINAL)))
    columns = []
    for name, deviation in TOLERANCE.items():
        values = dict(NOMINAL)
        values[name] *= math.exp(_STEP * deviation)
        columns.append((whitened(Planted(values=values)) - base) / _STEP)
    return base, np.stack(columns, axis=1)


def detectability(changed: Planted) -> tuple[float, float]:
    """(D, raw |S|^2) of what is planted in a bench with otherwise nominal values."""
    base, jacobian = _nominal()
    change = whitened(changed) - base
    right = jacobian.T @ change
    solved = np.linalg.solve(jacobian.T @ jacobian + np.eye(right.size), right)
    raw = float(change @ change)
    return max(raw - float(right @ solved), 0.0), raw
