"""Faulty sensors that have a name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.withheld.case import Cause
from benchmarks.withheld.draws import either, log_uniform, phase
from benchmarks.withheld.plant.drive_causes import Entry
from benchmarks.withheld.plant.drive_train.sensors import Eccentricity
from benchmarks.withheld.plant.drive_train.specimen import Specimen


def _eccentricity(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    amplitude = strength * log_uniform(rng, *{"motor_encoder": (1e-4, 5e-3), "load_encoder": (5e-6, 2e-4)}[at])
    fault = Eccentricity(amplitude=amplitude, phase=phase(rng), second=rng.uniform(0.0, 0.15), second_phase=phase(rng))
    symbols = {
        f"{at}_amplitude": amplitude,
        f"{at}_phase": fault.phase,
        f"{at}_second": fault.second,
        f"{at}_second_phase": fault.second_phase,
    }
    changed = replace(specimen, sensors=replace(specimen.sensors, **{at: fault}))
    return changed.told("encoder_eccentricity", at, "sensor", symbols, amplitude=amplitude)


def _delay(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    delay = strength * log_uniform(rng, 1e-4, 5e-3)
    changed = replace(specimen, sensors=replace(specimen.sensors, load_encoder_delay=delay))
    return changed.told("load_encoder_delay", at, "sensor", {"load_encoder_delay": delay}, delay=delay)


def _gain(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
    gain, cubic = either(rng, 1.015, 1.15) ** strength, strength * rng.uniform(-1e-7, 1e-7)
    changed = replace(specimen, sensors=replace(specimen.sensors, torque_gain=gain, torque_cubic=cubic))
    return changed.told("torque_sensor_gain", at, "sensor", {"torque_gain": gain, "torque_cubic": cubic}, gain=gain)


CAUSES: tuple[Entry, ...] = (
    (Cause(name="encoder_eccentricity", places=("motor_encoder", "load_encoder"), kind="sensor"), _eccentricity),
    (Cause(name="load_encoder_delay", places=("load_encoder",), kind="sensor"), _delay),
    (Cause(name="torque_sensor_gain", places=("torque_sensor",), kind="sensor"), _gain),
)
