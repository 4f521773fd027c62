"""The three records of the bench: speed reference and load torque at every sample.

The bench's data sheet names the records only; these forms give the inputs of the practice cases to rounding (a test compares them).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.withheld.case import Array

RATE = 2000.0  # Hz
COUNT = 18000
RECORDS = ("staircase", "load_cycle", "sweep")


def times() -> Array:
    """Sample instants [s]."""
    return np.arange(COUNT) / RATE


def inputs(record: str) -> tuple[Array, Array]:
    """Speed reference [rad/s] and load torque [N m]."""
    return _INPUTS[record](times())


def _staircase(time: Array) -> tuple[Array, Array]:
    levels = np.array([20.0, 60.0, 120.0, 200.0, 314.0, -60.0, -200.0, 10.0])
    speed = _blended(levels[np.minimum((time / 1.125).astype(int), 7)], 700)
    load = 40.0 + 12.0 * np.sin(2.0 * np.pi * 0.7 * time) + 8.0 * np.sin(2.0 * np.pi * 3.3 * time)
    return speed, load * _ramp(time)


def _load_cycle(time: Array) -> tuple[Array, Array]:
    triangle = 135.0 * 2.0 / np.pi * np.arcsin(np.sin(2.0 * np.pi * time / 4.0))
    return _blended(np.where(time < 4.5, 5.0, -5.0), 200), _blended(triangle, 60)


def _sweep(time: Array) -> tuple[Array, Array]:
    speed = 20.0 + 280.0 / 9.0 * time * np.minimum(time / 0.2, 1.0)
    phase = 2.0 * np.pi * np.cumsum(1.0 + 59.0 / 9.0 * time) / RATE  # 1 to 60 Hz
    return speed, (45.0 + 28.0 * np.sin(phase)) * _ramp(time)


def _ramp(time: Array) -> Array:
    """0 to 1 over the first 0.3 s."""
    return np.minimum(time / 0.3, 1.0)


def _blended(values: Array, samples: int) -> Array:
    """Moving average with a raised-cosine window."""
    window = np.hanning(samples)
    padded = np.pad(values, samples, mode="edge")
    return np.convolve(padded, window / window.sum(), "same")[samples:-samples]


_INPUTS: dict[str, Callable[[Array], tuple[Array, Array]]] = {"staircase": _staircase, "load_cycle": _load_cycle, "sweep": _sweep}
