"""Random sizes."""

from __future__ import annotations

import numpy as np


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """A positive number whose logarithm is uniform."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def log_normal(rng: np.random.Generator, nominal: float, deviation: float) -> float:
    """Nominal times exp(deviation * normal): the stated uncertainty of a parameter."""
    return float(nominal * np.exp(deviation * rng.standard_normal()))


def phase(rng: np.random.Generator) -> float:
    """An angle [rad]."""
    return float(rng.uniform(0.0, 2.0 * np.pi))


def either(rng: np.random.Generator, low: float, high: float) -> float:
    """A factor outside the tolerance, above 1 or below with equal chance: exp(+-log_uniform(ln low, ln high))."""
    size = log_uniform(rng, np.log(low), np.log(high))
    return float(np.exp(size if rng.random() < 0.5 else -size))
