"""Listed effects outside the gear: drag, ripple, lag, weight, play, a hidden mode."""

from __future__ import annotations

import numpy as np

from benchmarks.withheld.case import Cause
from benchmarks.withheld.draws import log_uniform, phase
from benchmarks.withheld.plant.drive_causes import Entry
from benchmarks.withheld.plant.drive_train.specimen import Specimen


def _quadratic_drag(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """A power of speed near 2, from laminar-turbulent to fully rough; the torque is that at the top speed of the records."""
    part, top, torque = {
        "motor": ("motor_drag", 314.0, (0.02, 1.0)),
        "wave_generator": ("wave_drag", 314.0, (0.02, 1.0)),
        "load": ("load_drag", 3.14, (0.4, 25.0)),
    }[at]
    sizes = {"power": strength * log_uniform(rng, *torque), "power_speed": top, "exponent": rng.uniform(1.75, 2.25)}
    symbols = {f"{part}_{name}": value for name, value in sizes.items()}
    return specimen.part(part, **sizes).told("quadratic_drag", at, symbols=symbols, coefficient=sizes["power"] / top**2)


def _torque_ripple(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """A main order with its double and a share that grows with the torque, or cogging; each with the other in small."""
    amplitude = strength * log_uniform(rng, 0.005, 0.12)
    ripple = bool(rng.random() < 0.6)
    order, other = float(rng.choice([6, 12, 18])), float(rng.choice([24, 30, 36]))
    sizes = {
        "ripple": amplitude * (1.0 if ripple else rng.uniform(0.0, 0.2)),
        "ripple_share": rng.uniform(0.0, 0.3) * amplitude,  # per N m
        "ripple_order": order,
        "ripple_phase": phase(rng),
        "second": rng.uniform(0.0, 0.35),
        "second_phase": phase(rng),
        "cogging": amplitude * (rng.uniform(0.0, 0.2) if ripple else 1.0),
        "cogging_order": other,
        "cogging_phase": phase(rng),
    }
    symbols = {f"motor_{name}": value for name, value in sizes.items()}
    told = order if ripple else other
    return specimen.part("motor", **sizes).told("torque_ripple", at, symbols=symbols, amplitude=amplitude, order=told)


def _actuator_lag(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """Second order; its delay at low frequency is 2 z/w_n."""
    delay, damping = strength * log_uniform(rng, 5e-5, 6e-3), rng.uniform(0.7, 1.2)
    sizes = {"lag_frequency": 2.0 * damping / delay, "lag_damping": damping}
    symbols = {f"motor_{name}": value for name, value in sizes.items()}
    return specimen.part("motor", **sizes).told("actuator_lag", at, symbols=symbols, delay=delay)


def _gravity_load(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """Weight with a second harmonic, as of a linkage or a counter spring."""
    torque = strength * log_uniform(rng, 0.3, 12.0)
    sizes = {"weight": torque, "weight_phase": phase(rng), "weight_second": rng.uniform(0.0, 0.15), "weight_second_phase": phase(rng)}
    symbols = {f"load_{name}": value for name, value in sizes.items()}
    return specimen.part("load", **sizes).told("gravity_load", at, symbols=symbols, torque=torque)


def _coupling_backlash(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """Play with soft edges and a film."""
    line = specimen.plant.line
    part, width, damping = {
        "input_shaft": ("input_play", (1e-3, 0.03), line.input_damping),
        "output_shaft": ("output_play", (3e-5, 1e-3), line.output_damping),
    }[at]
    gap = strength * log_uniform(rng, *width)
    sizes = {
        "half_gap": 0.5 * gap,
        "edge": rng.uniform(0.03, 0.1) * gap,
        "engage": rng.uniform(0.03, 0.1) * gap,
        "film": rng.uniform(0.05, 0.4) * damping,
    }
    symbols = {f"{part}_{name}": value for name, value in sizes.items()}
    return specimen.part(part, **sizes).told("coupling_backlash", at, symbols=symbols, backlash=gap)


def _hidden_mode(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """Part of the load's inertia behind a hardening spring with damping that grows with the rate."""
    share, frequency, damping = strength * log_uniform(rng, 0.01, 0.25), 2.0 * np.pi * log_uniform(rng, 7.0, 50.0), rng.uniform(0.01, 0.06)
    inertia = share * specimen.values["J_l"]
    stiffness = inertia * frequency**2
    sizes = {
        "hidden_share": share,
        "hidden_stiffness": stiffness,
        "hidden_cubic": stiffness * log_uniform(rng, 1.0, 1e3),  # 1/rad2
        "hidden_damping": 2.0 * damping * inertia * frequency,
        "hidden_square": inertia * rng.uniform(0.0, 3.0),
    }
    symbols = {f"load_{name}": value for name, value in sizes.items()}
    told = {"inertia": inertia, "frequency": float(frequency), "damping_ratio": damping}
    return specimen.part("load", **sizes).told("hidden_mode_load", at, symbols=symbols, **told)


CAUSES: tuple[Entry, ...] = (
    (Cause(name="quadratic_drag", places=("motor", "wave_generator", "load")), _quadratic_drag),
    (Cause(name="torque_ripple", places=("motor",)), _torque_ripple),
    (Cause(name="actuator_lag", places=("motor",)), _actuator_lag),
    (Cause(name="gravity_load", places=("load",)), _gravity_load),
    (Cause(name="coupling_backlash", places=("input_shaft", "output_shaft")), _coupling_backlash),
    (Cause(name="hidden_mode_load", places=("load",)), _hidden_mode),
)
