"""Dry friction at the bodies and in the mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.withheld.case import Cause
from benchmarks.withheld.draws import log_uniform
from benchmarks.withheld.plant.drive_causes import Entry, Put
from benchmarks.withheld.plant.drive_train import friction as laws
from benchmarks.withheld.plant.drive_train.banks import LOAD_BANK, MESH_BANK, MOTOR_BANK, WAVE_BANK, with_bank
from benchmarks.withheld.plant.drive_train.specimen import Specimen

LAW_NAMES = {laws.SMOOTH: "smooth", laws.DAHL: "dahl", laws.BANK: "sliders"}


def _body(
    part: str, bank: int, torque: tuple[float, float], drop_speed: tuple[float, float], presliding: tuple[float, float], step: float
) -> Put:
    """Friction of one body; ranges of the sliding torque, of the speed of the Stribeck drop and of the presliding angle."""

    def put(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
        law = (laws.SMOOTH, laws.DAHL, laws.BANK)[rng.integers(3)]
        coulomb, yield_angle = strength * log_uniform(rng, *torque), log_uniform(rng, *presliding)
        sizes = {
            "coulomb": coulomb,
            "drop": rng.uniform(0.0, 0.8),
            "drop_speed": log_uniform(rng, *drop_speed),
            "drop_exponent": rng.uniform(0.8, 1.6),
            "asymmetry": rng.uniform(-0.06, 0.06),
            "smooth_speed": step * log_uniform(rng, 0.5, 2.0),
            "stiffness": coulomb / yield_angle,
            "sharpness": rng.uniform(1.2, 2.0),
        }
        changed = specimen.part(part, kind=law, **sizes)
        if law == laws.BANK:
            banks = with_bank(changed.tables.banks, bank, coulomb, yield_angle, rng.uniform(1.5, 4.0))
            changed = replace(changed, tables=changed.tables._replace(banks=banks))
        symbols = {f"{part}_{name}": value for name, value in sizes.items()} | {f"{part}_law": LAW_NAMES[law], f"{part}_yield": yield_angle}
        return changed.told(f"friction_{at}", at, symbols=symbols, coulomb=coulomb)

    return put


def _mesh(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    law = (laws.SMOOTH, laws.BANK)[rng.integers(2)]
    sizes = {
        "loss": strength * log_uniform(rng, 0.01, 0.3),
        "round_torque": rng.uniform(0.5, 4.0),
        "rise": rng.uniform(0.0, 0.4),
        "rise_speed": log_uniform(rng, 5.0, 50.0),
        "smooth_speed": log_uniform(rng, 0.1, 0.5),
    }
    changed = specimen.part("mesh", kind=law, **sizes)
    symbols = {f"mesh_{name}": value for name, value in sizes.items()} | {"mesh_law": LAW_NAMES[law]}
    if law == laws.BANK:
        symbols["mesh_yield"] = log_uniform(rng, 0.003, 0.02)
        banks = with_bank(changed.tables.banks, MESH_BANK, 1.0, symbols["mesh_yield"], rng.uniform(1.5, 4.0))  # limits times the mesh level
        changed = replace(changed, tables=changed.tables._replace(banks=banks))
    return changed.told("friction_mesh_load", at, symbols=symbols, coefficient=sizes["loss"])


CAUSES: tuple[Entry, ...] = (
    (Cause(name="friction_motor", places=("motor",)), _body("motor_friction", MOTOR_BANK, (0.004, 0.3), (2.0, 20.0), (0.003, 0.02), 0.2)),
    (
        Cause(name="friction_wave_generator", places=("wave_generator",)),
        _body("wave_friction", WAVE_BANK, (0.004, 0.3), (2.0, 20.0), (0.003, 0.02), 0.2),
    ),
    (Cause(name="friction_load", places=("load",)), _body("load_friction", LOAD_BANK, (0.1, 10.0), (0.02, 0.3), (2e-4, 2e-3), 0.004)),
    (Cause(name="friction_mesh_load", places=("mesh",)), _mesh),
)
