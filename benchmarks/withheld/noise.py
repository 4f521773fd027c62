"""Measurement noise and rounding."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

from benchmarks.withheld.case import Array


def white(rng: np.random.Generator, size: float, count: int) -> Array:
    """Independent normal noise, standard deviation ``size``."""
    return size * rng.standard_normal(count)


def first_order(rng: np.random.Generator, size: float, memory: float, count: int) -> Array:
    """Stationary first-order coloured noise: x[k] = memory x[k-1] + e[k], standard deviation ``size``."""
    if not 0.0 <= memory < 1.0:
        raise ValueError(f"memory = {memory:g} a sample: first-order noise needs 0 <= memory < 1.")
    steps = size * np.sqrt(1.0 - memory**2) * rng.standard_normal(count)
    start = size * rng.standard_normal()
    return np.asarray(lfilter([1.0], [1.0, -memory], steps, zi=[memory * start])[0])


def coloured(rng: np.random.Generator, size: float, memory: float, count: int) -> Array:
    """Noise of standard deviation ``size``: half of the variance white, half of first order (white alone at memory 0)."""
    if memory == 0.0:
        return white(rng, size, count)
    half = size * np.sqrt(0.5)
    return white(rng, half, count) + first_order(rng, half, memory, count)


def rounded(values: Array, resolution: float) -> Array:
    """Values on the grid of whole multiples of ``resolution``."""
    return np.asarray(np.round(values / resolution) * resolution)
