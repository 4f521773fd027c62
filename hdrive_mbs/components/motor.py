"""A motor: rotor inertia and characteristic."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.components.inertia import add_viscous
from hdrive_mbs.expression import Value
from hdrive_mbs.motors.characteristic import MotorCharacteristic, MotorFunction
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class Motor(Component):
    """Rotor with an air-gap torque:  J_s dw/dt = M_s(w) - viscous * w - torque of the shaft.

    Source: seed F (1) with M_s(n) on the right (see MotorCharacteristic about its (5)).
    """

    inertia: float = parameter("kg m^2", "rotor inertia J_s", above=0.0)
    characteristic: MotorCharacteristic | Callable[..., Value] = option(
        "torque law: a characteristic, or a function of (speed) or (time, speed)", called_with=(("speed",), ("time", "speed"))
    )
    viscous: float = parameter("N m s/rad", "viscous drag on the absolute speed", default=0.0, low=0.0)

    def check(self) -> None:
        if not isinstance(self.characteristic, MotorCharacteristic):
            object.__setattr__(self, "characteristic", MotorFunction(function=self.characteristic))

    def flanges(self) -> tuple[Flange, ...]:
        return (Flange(name="", inertia=self.inertia),)

    def build(self, name: str, draft: Draft) -> None:
        assert isinstance(self.characteristic, MotorCharacteristic)
        self.characteristic.drive(name, draft.body(name), draft)
        add_viscous(name, self.viscous, draft)
