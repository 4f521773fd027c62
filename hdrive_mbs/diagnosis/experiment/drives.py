"""What the inputs of a bench are, by the parts that they make."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.loads.law import LoadLaw
from hdrive_mbs.motors.characteristic import MotorCharacteristic
from hdrive_mbs.motors.profiles.profile import SpeedProfile

Role = Literal["speed", "torque", "load"]


@dataclass(frozen=True, kw_only=True)
class Drive:
    """An input that a plan can use.

    column : of a record;  place : part of the scene that it drives
    role : "speed": reference of a motor [rad/s];  "torque": of a motor [N m];  "load": torque on a load [N m]
    """

    column: str
    place: str
    role: Role


def drives(bench: Bench) -> tuple[Drive, ...]:
    """Inputs whose meaning is known by what their law makes: a SpeedProfile, a MotorCharacteristic or a LoadLaw."""
    found = []
    for column, item in bench.inputs.items():
        made = item.law(np.array([0.0, 1.0]), np.zeros(2))
        kinds: tuple[tuple[type, Role], ...] = ((SpeedProfile, "speed"), (MotorCharacteristic, "torque"), (LoadLaw, "load"))
        for kind, role in kinds:
            if isinstance(made, kind):
                found.append(Drive(column=column, place=item.path.partition(".")[0], role=role))
    return tuple(found)


def motor_of(bench: Bench) -> Drive | None:
    """The input that drives the motor."""
    return next((item for item in drives(bench) if item.role != "load"), None)


def load_of(bench: Bench) -> Drive | None:
    """The input that loads the train."""
    return next((item for item in drives(bench) if item.role == "load"), None)
