"""Causes that have no name in the answer format: the right answer is ``unknown``, with the place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.withheld.case import Cause
from benchmarks.withheld.draws import log_uniform, phase
from benchmarks.withheld.plant.drive_causes import Entry, Put
from benchmarks.withheld.plant.drive_train.specimen import Specimen

Sizes = Callable[[np.random.Generator, str, Specimen, float], dict[str, float]]


def _in_plant(part: str | dict[str, str], sizes: Sizes) -> Put:
    """A cause that changes numbers of one part of the plant; a dictionary gives the part by place."""

    def put(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
        name = part if isinstance(part, str) else part[at]
        changes = sizes(rng, at, specimen, strength)
        return specimen.part(name, **changes).told("unknown", at, symbols={f"{name}_{key}": value for key, value in changes.items()})

    return put


def _in_sensor(sizes: Sizes) -> Put:
    def put(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
        changes: dict[str, Any] = sizes(rng, at, specimen, strength)
        return replace(specimen, sensors=replace(specimen.sensors, **changes)).told("unknown", at, "sensor", changes)

    return put


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


def _entry(name: str, places: tuple[str, ...], put: Put) -> Entry:
    return Cause(name=name, places=places, kind="unlisted"), put


CAUSES: tuple[Entry, ...] = (
    _entry("shaking_neighbour", ("load",), _in_plant("load", _shaking)),
    _entry("inertia_by_angle", ("load",), _in_plant("load", _inertia_by_angle)),
    _entry("brake_lag", ("load",), _in_plant("load", _brake_lag)),
    _entry("stiffness_by_position", ("flexspline",), _in_plant("spring", _modulation)),
    _entry("stiffness_curve", ("flexspline",), _in_plant("spring", _bulge)),
    _entry("torque_fade", ("motor",), _in_plant("motor", _fade)),
    _entry("relaxing_shaft", ("output_shaft",), _in_plant("shaft", _relaxing)),
    _entry("slipping_clamp", ("output_shaft",), _in_plant("shaft", _slipping)),
    _entry("rub_at_an_angle", ("motor", "wave_generator", "load"), _in_plant(_DRAGS, _rub)),
    _entry("one_way_drag", ("motor", "wave_generator", "load"), _in_plant(_DRAGS, _one_way)),
    _entry("warming_drag", ("motor", "wave_generator"), _in_plant(_DRAGS, _warming)),
    _entry("brake_touches", ("motor", "wave_generator", "load"), _in_plant(_DRAGS, _grip)),
    _entry("torque_sensor_lag", ("torque_sensor",), _in_sensor(_torque_lag)),
    _entry("encoder_jump", ("load_encoder",), _in_sensor(_jump)),
)
