"""Parameters of the drive bench as its data sheet states them, and draws within their uncertainty.

Source: drive_bench.toml of withheld round 1 (a test compares the numbers).
"""

from __future__ import annotations

import numpy as np

from benchmarks.withheld.draws import log_normal

NOMINAL: dict[str, float] = {
    "J_m": 2.1e-3,  # kg m2, motor
    "J_wg": 4.5e-4,  # wave generator
    "J_fs": 0.012,  # flexspline and output flange
    "J_l": 1.8,  # load
    "k_in": 400.0,  # N m/rad, input shaft
    "d_in": 0.05,  # N m s/rad
    "k_out": 5.19e4,  # output shaft
    "d_out": 6.0,
    "d_fs": 12.0,  # flexspline
    "b_m": 2.0e-3,  # N m s/rad, viscous
    "b_wg": 1.5e-3,
    "b_l": 0.4,
    "u": 100.0,
    "K1": 3.2e4,
    "K2": 6.4e4,
    "K3": 1.1e5,
    "T1": 23.5,  # N m
    "T2": 98.0,
    "lost_motion": 2.9e-4,  # rad, full width
    "kp": 0.35,  # N m s/rad
    "ki": 4.0,  # N m/rad
    "tau_max": 9.0,  # N m
}

# standard deviation of ln(true/nominal); what is not named is exact
UNCERTAINTY: dict[str, float] = {
    **dict.fromkeys(("J_m", "J_l", "k_in", "k_out", "K1", "K2", "K3"), 0.03),
    **dict.fromkeys(("d_in", "d_out", "d_fs", "b_m", "b_wg", "b_l"), 0.09),
    "lost_motion": 0.05,
}


def drawn(rng: np.random.Generator) -> dict[str, float]:
    """The parameters of one specimen."""
    return {name: log_normal(rng, value, UNCERTAINTY[name]) if name in UNCERTAINTY else value for name, value in NOMINAL.items()}
