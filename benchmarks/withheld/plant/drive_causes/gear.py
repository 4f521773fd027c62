"""Kinematic error, hysteresis, lost motion and asymmetry of the gear."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.withheld.case import Cause
from benchmarks.withheld.draws import log_uniform, phase
from benchmarks.withheld.plant.drive_causes import Entry
from benchmarks.withheld.plant.drive_train.banks import FLEX_BANK, with_bank
from benchmarks.withheld.plant.drive_train.gear_error import orders, with_side_bands
from benchmarks.withheld.plant.drive_train.specimen import Specimen


def _kinematic_error(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """A main order with side harmonics; of the wave generator (with side bands once per turn of the output) or, rarer, of the output."""
    of_output = rng.random() < 0.25
    order = float(rng.choice([1, 2, 3]) if of_output else rng.choice([1, 2, 2, 2, 4, 6]))
    amplitude = strength * log_uniform(rng, *((4e-6, 5e-4) if of_output else (1.5e-6, 2e-4) if order <= 2 else (1e-6, 5e-5)))
    start, depth = phase(rng), rng.uniform(0.0, 0.25)
    terms = with_side_bands(amplitude, order, start, 0.0 if of_output else depth, 1.0 / specimen.plant.line.ratio)
    sides = [(rng.uniform(0.05, 0.35) * amplitude, order * factor, phase(rng)) for factor in (2.0, 3.0)]
    table = orders(*terms, *sides)
    symbols = {
        "error_follows": "output" if of_output else "wave_generator",
        "error_amplitudes": table.amplitude.tolist(),
        "error_orders": table.order.tolist(),
        "error_phases": table.phase.tolist(),
    }
    changed = replace(specimen, tables=specimen.tables._replace(**{"output_error" if of_output else "wave_error": table}))
    return changed.told("kinematic_error", at, symbols=symbols, amplitude=amplitude, order=order, follows=symbols["error_follows"])


def _hysteresis(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """Iwan sliders with spread yields, or Dahl's rate law with an exponent above 1."""
    torque, twist = strength * log_uniform(rng, 0.3, 10.0), log_uniform(rng, 1e-4, 8e-4)
    if rng.random() < 0.5:
        spread = rng.uniform(2.0, 8.0)
        banks = with_bank(specimen.tables.banks, FLEX_BANK, torque, twist, spread)
        changed = replace(specimen, tables=specimen.tables._replace(banks=banks))
        symbols = {"hysteresis_law": "sliders", "hysteresis_spread": spread}
    else:
        sharpness = rng.uniform(1.4, 2.5)
        changed = specimen.part("hysteresis", torque=torque, stiffness=torque / twist, sharpness=sharpness)
        symbols = {"hysteresis_law": "dahl", "hysteresis_sharpness": sharpness}
    symbols |= {"hysteresis_torque": torque, "hysteresis_yield": twist}
    return changed.told("hysteresis_flexspline", at, symbols=symbols, torque=torque)


def _lost_motion(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """A wider gap with rounded edges, or one that closes like a soft layer."""
    extra = strength * log_uniform(rng, 0.3, 4.0) * specimen.values["lost_motion"]  # the width is known to 5 %, so never faint
    sizes = {"half_gap": 0.5 * (specimen.values["lost_motion"] + extra)}
    sizes |= {"edge": rng.uniform(0.05, 0.2) * extra} if rng.random() < 0.5 else {"entry": rng.uniform(0.05, 0.2) * extra}
    symbols = {"spring_" + name: value for name, value in sizes.items()}
    return specimen.part("spring", **sizes).told("lost_motion", at, symbols=symbols, extra=extra)


def _asymmetry(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    """The reverse sense is stiffer or softer, from small twists on."""
    size = strength * log_uniform(rng, 0.02, 0.4) * rng.choice([-1.0, 1.0])
    sizes = {"asymmetry": float(size), "asymmetry_twist": log_uniform(rng, 5e-5, 4e-4), "asymmetry_power": rng.uniform(0.6, 2.0)}
    symbols = {"spring_" + name: value for name, value in sizes.items()}
    return specimen.part("spring", **sizes).told("stiffness_asymmetry", at, symbols=symbols, relative=float(size))


CAUSES: tuple[Entry, ...] = (
    (Cause(name="kinematic_error", places=("mesh",)), _kinematic_error),
    (Cause(name="hysteresis_flexspline", places=("flexspline",)), _hysteresis),
    (Cause(name="lost_motion", places=("flexspline",)), _lost_motion),
    (Cause(name="stiffness_asymmetry", places=("flexspline",)), _asymmetry),
)
