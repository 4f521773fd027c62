"""What every example of the bench has beyond the data sheet, null or not: small enough to stay in the noise.

A permille or less in what the data sheet calls exact, and two bearings and two supports that are not quite alike. The sizes are small
because the bench sees much: 0.5 % of the tilt stiffness is already a finding (linear detectability 80), and so are 0.05 % between the
supports (17); 0.1 % between the bearings is none (0.2). Nothing is put on the drag, of which the encoder sees 0.01 %.
"""

from __future__ import annotations

import math

import numpy as np

from benchmarks.withheld.plant.rotor_line.planted import Planted

# standard deviation of the logarithm
EXACT = {"m_h": 1e-3, "m_b": 2e-3, "Jt_b": 2e-3, "k_bt": 5e-4, "d_bt": 3e-3, "G": 3e-4}
RINGS = 1e-3  # one stiffer, the other softer
SUPPORTS = 2e-4


def with_finer_detail(rng: np.random.Generator, bench: Planted) -> dict[str, float]:
    """Put the detail into a bench; returns the factors."""
    factors = {name: math.exp(size * rng.standard_normal()) for name, size in EXACT.items()}
    for name, factor in factors.items():
        bench.values[name] *= factor
    rings, supports = math.exp(RINGS * rng.standard_normal()), math.exp(SUPPORTS * rng.standard_normal())
    bench.ring_stiffness *= [rings, 1.0 / rings]
    bench.support_stiffness *= [supports, 1.0 / supports]
    return {**factors, "ring_1_over_mean": rings, "support_1_over_mean": supports}
