"""Random sizes of planted causes: strength 0 is hardly seen, strength 1 is strong."""

from __future__ import annotations

import numpy as np


def grown(strength: float, low: float, high: float) -> float:
    """Between low and high, even in the logarithm."""
    return float(low * (high / low) ** strength)


def one_of(rng: np.random.Generator, *choices: int) -> int:
    """One of these laws."""
    return int(rng.choice(choices))


def sign(rng: np.random.Generator) -> float:
    """Plus or minus one."""
    return float(rng.choice([-1.0, 1.0]))
