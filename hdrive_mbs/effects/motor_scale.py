"""A motor that delivers more or less than its characteristic says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.motor_effect import MotorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class MotorScale(MotorEffect):
    """A wrong torque constant, weak magnets, a motor curve that is off by a factor.

    tau = (1 + a) M

    with the torque M of the motor's characteristic.

    Source: torque in proportion to current, with a torque constant that is off.  Leaves out saturation, which lowers
    the factor at high torque (MotorSaturation), and its change with temperature.
    """

    error: float = parameter("1", "a, share of the torque that is delivered in excess", low=-0.9, high=2.0, typical=(-0.3, 0.3))

    family: ClassVar[str] = "motor_curve"
    signature: ClassVar[str] = "all torques seen behind the motor are off by one factor against its command, at every speed"

    def delivered(self, time: Value, speed: Value, torque: Value) -> Value:
        return (1.0 + self.error) * torque
