"""More causes that have no name, written when most laws of the package under test stood, so that none of those was made for these."""

from __future__ import annotations

import numpy as np

from benchmarks.withheld.draws import log_uniform, phase
from benchmarks.withheld.plant.drive_causes import Entry
from benchmarks.withheld.plant.drive_causes.nameless import entry, in_plant, in_sensor
from benchmarks.withheld.plant.drive_train.specimen import Specimen


def _saturating(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    """Of the nominal motor's 0.8 to 1.3 N m (rms) 0.3 % and more are missing, and much of the 7 N m at starts."""
    return {"saturation": strength * log_uniform(rng, 0.003, 0.15)}


def _payload(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    """A part of the load falls off in each record."""
    return {"gone": min(strength * log_uniform(rng, 0.004, 0.4), 0.8), "gone_time": rng.uniform(1.5, 7.0)}


def _cable(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    """A cable or hose that is slack at first; the load turns to 8 rad and 14 rad in two of the records."""
    return {
        "cable": strength * log_uniform(rng, 0.05, 3.0),
        "cable_angle": rng.uniform(0.8, 4.0),
        "cable_width": log_uniform(rng, 0.02, 0.5),
    }


def _uneven_brake(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    return {
        "uneven": strength * log_uniform(rng, 0.003, 0.15),
        "uneven_order": float(rng.choice([2, 3, 4, 6, 8])),
        "uneven_phase": phase(rng),
    }


def _torque_loop(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    """Strain gauges that creep in their glue: a loop of 0.5 % to 8 %."""
    return {"torque_loop": strength * log_uniform(rng, 0.005, 0.08), "torque_loop_limit": rng.uniform(15.0, 60.0)}


def _lost_count(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> dict[str, float]:
    """A scratch on the disc: the encoder loses so much at each passage of one angle, one to four times in two of the records."""
    size = strength * log_uniform(rng, 2e-6, 5e-5) * rng.choice([-1.0, 1.0])
    return {"lost_count": float(size), "lost_count_angle": rng.uniform(0.6, 2.2)}


CAUSES: tuple[Entry, ...] = (
    entry("motor_saturates", ("motor",), in_plant("motor", _saturating)),
    entry("payload_falls_off", ("load",), in_plant("load", _payload)),
    entry("taut_cable", ("load",), in_plant("load", _cable)),
    entry("uneven_brake", ("load",), in_plant("load", _uneven_brake)),
    entry("torque_sensor_loop", ("torque_sensor",), in_sensor(_torque_loop)),
    entry("encoder_loses_counts", ("load_encoder",), in_sensor(_lost_count)),
)
