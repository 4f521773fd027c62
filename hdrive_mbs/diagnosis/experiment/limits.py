"""How fast and how hard a bench may be driven."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.experiment.drives import load_of, motor_of
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.records.record import Record

MARGIN = 0.9
"""Of a motor's torque limit: at the limit itself a record tells of the limit and not of the train."""


@dataclass(frozen=True, kw_only=True)
class Limits:
    """Largest sizes in both senses.

    speed : of the motor and its reference [rad/s];  torque : of the motor [N m]
    load : torque on the load [N m]; 0 where it must stay unloaded
    """

    speed: float
    torque: float
    load: float = 0.0

    def __post_init__(self) -> None:
        if not (self.speed > 0.0 and self.torque > 0.0 and self.load >= 0.0 and math.isfinite(self.speed + self.torque + self.load)):
            raise ParameterError(
                f"Limits of {self.speed:g} rad/s, {self.torque:g} N m and a load of {self.load:g} N m: speed and torque must be greater"
                " than 0, the load at least 0, all finite."
            )


def limits_of(bench: Bench, records: Sequence[Record]) -> Limits:
    """Limits that a bench has kept so far: the largest inputs of its records, and MARGIN of its motor's torque limit.

    Raises ParameterError where scene and records do not say them.
    """
    motor, load = motor_of(bench), load_of(bench)
    if motor is None:
        raise ParameterError(f"Bench {bench.scene.name!r} has no speed reference or motor torque among its inputs; give your own plans.")
    part = bench.scene.parts[motor.place]
    limit = getattr(getattr(part, "characteristic", None), "torque_limit", math.nan)
    if motor.role == "speed":
        speed, torque = _largest(records, motor.column), MARGIN * float(limit)
    else:
        measured = [name for name, item in bench.measured.items() if item.channel == f"{motor.place}.speed"]
        speed, torque = (_largest(records, measured[0]) if measured else math.nan), _largest(records, motor.column)
    if not (speed > 0.0 and torque > 0.0):
        raise ParameterError(
            f"Neither the records nor motor {motor.place!r} say how fast and how hard it may be driven (found {speed:g} rad/s and"
            f" {torque:g} N m); give limits=Limits(speed=..., torque=..., load=...)."
        )
    return Limits(speed=speed, torque=torque, load=0.0 if load is None else max(_largest(records, load.column), 0.0))


def _largest(records: Sequence[Record], column: str) -> float:
    values = [np.asarray(record.channels[column].values, float) for record in records if column in record.channels]
    return max((float(np.nanmax(np.abs(item))) for item in values), default=-1.0)
