"""A motor whose iron saturates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.motor_effect import MotorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class MotorSaturation(MotorEffect):
    """What is left of a motor's torque when its iron saturates: the torque constant falls as the current grows.

    tau = M_s tanh(M/M_s),  M_s = 1/sqrt(3 s)

    with the torque M of the motor's characteristic, which counts the current by the torque constant of a small one.  At small
    torques a share s M^2 of it is missing; more than M_s is never delivered.  s = 0 leaves M as it is.

    Source: torque in proportion to the flux linkage of an iron circuit, which is odd in the current and levels off; the hyperbolic tangent
    for it is our choice, s the first term of its series.  Where a motor works far beyond its knee the curve decides, and another one
    may be due.  Leaves out field weakening, the second axis of a salient rotor, hysteresis of the iron and heat.
    """

    saturation: float = parameter(
        "1/(N m)^2", "s, share of the torque that is missing, over its square", low=0.0, high=1e6, typical=(1e-4, 0.3)
    )

    family: ClassVar[str] = "motor_saturation"
    signature: ClassVar[str] = "torque falls short of its command the more, the larger it is, at any speed and in both senses alike"

    def delivered(self, time: Value, speed: Value, torque: Value) -> Value:
        if self.saturation == 0.0:
            return torque
        inverse = (3.0 * self.saturation) ** 0.5
        return np.tanh(inverse * torque) / inverse
