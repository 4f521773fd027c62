"""A torque on a place that brings no inertia of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.expression import Value
from hdrive_mbs.motors.characteristic import MotorCharacteristic, MotorFunction
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import option


@dataclass(frozen=True, kw_only=True)
class DriveTorque(Component):
    """A motor characteristic that acts on a rotor directly; for a motor with a rotor of its own use Motor."""

    characteristic: MotorCharacteristic | Callable[..., Value] = option(
        "torque law: a characteristic, or a function of (speed) or (time, speed)", called_with=(("speed",), ("time", "speed"))
    )

    def check(self) -> None:
        if not isinstance(self.characteristic, MotorCharacteristic):
            object.__setattr__(self, "characteristic", MotorFunction(function=self.characteristic))

    def flanges(self) -> tuple[Flange, ...]:
        return (Flange(name=""),)

    def build(self, name: str, draft: Draft) -> None:
        assert isinstance(self.characteristic, MotorCharacteristic)
        self.characteristic.drive(name, draft.body(name), draft)
