"""Causes that have no name in the answer format: the right answer is ``unknown``, with the place."""

from __future__ import annotations

import numpy as np

from benchmarks.withheld.draws import log_uniform, phase
from benchmarks.withheld.plant.drive_causes import Entry
from benchmarks.withheld.plant.drive_causes.nameless import entry, in_plant, in_sensor
from benchmarks.withheld.plant.drive_train.specimen import Specimen


def _shaking(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    return {
        "shaking": strength * log_uniform(rng, 0.2, 6.0),
        "shaking_frequency": 2 * np.pi * log_uniform(rng, 4.0, 60.0),
        "shaking_phase": phase(rng),
    }


def _inertia_by_angle(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    return {"inertia_depth": strength * log_uniform(rng, 0.004, 0.3), "inertia_phase": phase(rng)}


def _brake_lag(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    return {"brake_time": strength * log_uniform(rng, 5e-5, 8e-3)}


def _modulation(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    return {"modulation": strength * log_uniform(rng, 0.008, 0.2), "modulation_order": 2.0, "modulation_phase": phase(rng)}


def _bulge(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    """Softer or stiffer about a middle torque: another shape of the stiffness curve."""
    return {
        "bulge": float(strength * log_uniform(rng, 0.03, 0.35) * rng.choice([-1.0, 1.0])),
        "bulge_twist": log_uniform(rng, 4e-4, 1.2e-3),
    }


def _fade(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    return {"fade": strength * log_uniform(rng, 0.004, 0.2), "fade_time": log_uniform(rng, 0.7, 6.0)}


def _relaxing(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    return {
        "branch_stiffness": specimen.values["k_out"] * strength * log_uniform(rng, 0.02, 0.6),
        "branch_time": log_uniform(rng, 4e-3, 0.2),
    }


def _slipping(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    return {"slip_torque": rng.uniform(80.0, 260.0), "slip_damping": log_uniform(rng, 2e4, 5e5) / strength}


def _rub(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    torque = strength * log_uniform(rng, 0.02, 0.8) * (60.0 if at == "load" else 1.0)
    return {"rub": torque, "rub_angle": phase(rng), "rub_width": rng.uniform(0.15, 0.4), "smooth_speed": 0.004 if at == "load" else 0.2}


def _one_way(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    viscous = specimen.values[{"motor": "b_m", "wave_generator": "b_wg", "load": "b_l"}[at]]
    return {"one_way": strength * viscous * log_uniform(rng, 0.2, 4.0)}


def _warming(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    viscous = specimen.values[{"motor": "b_m", "wave_generator": "b_wg", "load": "b_l"}[at]]
    return {"warming": strength * viscous * log_uniform(rng, 0.3, 6.0), "warming_time": log_uniform(rng, 1.0, 5.0)}


def _grip(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    """A brake pad that touches for a while."""
    start = rng.uniform(1.0, 5.0)
    torque = strength * log_uniform(rng, 0.008, 0.3) * (60.0 if at == "load" else 1.0)
    smooth = 0.004 if at == "load" else 0.2
    return {"grip": torque, "grip_start": start, "grip_end": start + rng.uniform(0.8, 3.0), "smooth_speed": smooth}


def _torque_lag(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    return {"torque_lag": strength * log_uniform(rng, 2e-4, 6e-3)}


def _jump(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    """The encoder slips once in each record."""
    return {
        "load_encoder_jump": float(strength * log_uniform(rng, 2e-6, 5e-5) * rng.choice([-1.0, 1.0])),
        "load_encoder_jump_time": rng.uniform(2.0, 7.0),
    }


_DRAGS = {"motor": "motor_drag", "wave_generator": "wave_drag", "load": "load_drag"}


CAUSES: tuple[Entry, ...] = (
    entry("shaking_neighbour", ("load",), in_plant("load", _shaking)),
    entry("inertia_by_angle", ("load",), in_plant("load", _inertia_by_angle)),
    entry("brake_lag", ("load",), in_plant("load", _brake_lag)),
    entry("stiffness_by_position", ("flexspline",), in_plant("spring", _modulation)),
    entry("stiffness_curve", ("flexspline",), in_plant("spring", _bulge)),
    entry("torque_fade", ("motor",), in_plant("motor", _fade)),
    entry("relaxing_shaft", ("output_shaft",), in_plant("shaft", _relaxing)),
    entry("slipping_clamp", ("output_shaft",), in_plant("shaft", _slipping)),
    entry("rub_at_an_angle", ("motor", "wave_generator", "load"), in_plant(_DRAGS, _rub)),
    entry("one_way_drag", ("motor", "wave_generator", "load"), in_plant(_DRAGS, _one_way)),
    entry("warming_drag", ("motor", "wave_generator"), in_plant(_DRAGS, _warming)),
    entry("brake_touches", ("motor", "wave_generator", "load"), in_plant(_DRAGS, _grip)),
    entry("torque_sensor_lag", ("torque_sensor",), in_sensor(_torque_lag)),
    entry("encoder_jump", ("load_encoder",), in_sensor(_jump)),
)
