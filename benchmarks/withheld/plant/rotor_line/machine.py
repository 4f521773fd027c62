"""Parameters of the rotor bench: nominal values, one disturbed example, and their numbers for the equations.

The values are those of the bench's public data sheet (rotor_bench.toml of the withheld cases); the names of the true parameters
are those of its practice cases, so that a truth of either source reads alike.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from benchmarks.withheld.draws import log_normal
from benchmarks.withheld.plant.rotor_line.equations import Machine

GRAVITY = 9.81
NOMINAL: Mapping[str, float] = MappingProxyType({
    "E": 2.06e11, "G": 7.9e10, "d": 0.045, "z_b1": 0.0, "z_r1": 0.42, "z_b2": 0.78, "z_r2": 0.95,
    "m_r1": 24.0, "Jp_r1": 0.36, "Jt_r1": 0.21, "m_r2": 7.0, "Jp_r2": 0.055, "Jt_r2": 0.032,
    "m_b": 1.1, "Jp_b": 3e-3, "Jt_b": 2.5e-3, "k_b": 6.5e7, "k_bt": 2e4, "d_b": 2500.0, "d_bt": 4.0,
    "m_h": 9.0, "k_hx": 3.2e7, "k_hy": 4.1e7, "d_h": 6000.0, "d_shaft": 3e-5, "d_drag": 0.002,
    "e_r1": 8e-6, "a_r1": 0.6, "tau_r1": 2e-4, "b_r1": -1.1, "e_r2": 5e-6, "a_r2": 2.2, "tau_r2": 0.0, "b_r2": 0.0,
})  # fmt: skip
# standard deviation of the logarithm; one draw for both bearings and for both supports because they have one name
TOLERANCE: Mapping[str, float] = MappingProxyType({
    "k_b": 0.02, "k_hx": 0.02, "k_hy": 0.02,
    "E": 0.006, "m_r1": 0.006, "Jp_r1": 0.006, "Jt_r1": 0.006, "m_r2": 0.006, "Jp_r2": 0.006, "Jt_r2": 0.006,
    "d_b": 0.08, "d_h": 0.08, "d_shaft": 0.08,
    "e_r1": 0.05, "e_r2": 0.05,
})  # fmt: skip


def disturbed(rng: np.random.Generator) -> dict[str, float]:
    """One example of the bench within its tolerances."""
    return {name: log_normal(rng, value, TOLERANCE.get(name, 0.0)) for name, value in NOMINAL.items()}


def machine(values: Mapping[str, float], *, gravity: float = GRAVITY) -> Machine:
    """The numbers of the equations; both bearings and supports alike (change the arrays for one alone)."""
    p = values
    z = np.array([p["z_b1"], p["z_r1"], p["z_b2"], p["z_r2"]])
    length = np.diff(z)
    second = math.pi * p["d"] ** 4 / 64
    polar, transverse = np.array([p["Jp_b"], p["Jp_r1"], p["Jp_b"], p["Jp_r2"]]), np.array([p["Jt_b"], p["Jt_r1"], p["Jt_b"], p["Jt_r2"]])
    return Machine(
        length=length,
        bending=np.full(3, p["E"] * second),
        torsion=2 * p["G"] * second / length,
        shaft_damping=p["d_shaft"],
        mass=np.array([p["m_b"], p["m_r1"], p["m_b"], p["m_r2"]]),
        polar=polar,
        transverse=transverse,
        ring_stiffness=np.full(2, p["k_b"]),
        ring_damping=np.full(2, p["d_b"]),
        tilt_stiffness=p["k_bt"],
        tilt_damping=p["d_bt"],
        housing_mass=np.full(2, p["m_h"]),
        support_stiffness=np.array([[p["k_hx"], p["k_hy"]]] * 2),
        support_damping=np.full((2, 2), p["d_h"]),
        drag=np.full(4, p["d_drag"]),
        eccentricity=np.array([0.0, p["e_r1"], 0.0, p["e_r2"]]),
        eccentric_angle=np.array([0.0, p["a_r1"], 0.0, p["a_r2"]]),
        skew=(transverse - polar) * np.array([0.0, p["tau_r1"], 0.0, p["tau_r2"]]),
        skew_angle=np.array([0.0, p["b_r1"], 0.0, p["b_r2"]]),
        gravity=gravity,
    )
