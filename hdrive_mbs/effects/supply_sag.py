"""A motor whose torque limit falls with its speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.motor_effect import MotorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SupplySag(MotorEffect):
    """What is left of a motor's torque when the supply gives way.

    tau = clip(M, -L, L),  L = max(T_L - s |w|, 0) where M w > 0 (driving), else T_L

    with the torque M of the motor's characteristic.  s = 0 leaves M as it is.  A supply with inner resistance has
    less voltage left the more power is drawn, and the back voltage of the motor takes its share in proportion to
    the speed, so the current that can still be driven falls with the speed, in the first order along a line.

    Source: torque-speed line of a motor at the limit of its voltage, as in any text on electrical drives.  Leaves out
    field weakening, the charge of the capacitors (the limit follows at once) and the rise of voltage when braking.
    """

    sag: float = parameter("N m s/rad", "s, fall of the limit per speed", low=0.0, high=1e3, typical=(1e-4, 0.5))
    torque_limit: float = parameter("N m", "limit T_L at standstill", above=0.0, typical=(0.5, 2e3))

    family: ClassVar[str] = "supply_sag"
    signature: ClassVar[str] = "torque stays below its command at high speed and torque only; run-ups that fall behind near full speed"

    def delivered(self, time: Value, speed: Value, torque: Value) -> Value:
        if self.sag == 0.0:
            return torque
        driving = np.maximum(self.torque_limit - self.sag * np.abs(speed), 0.0)
        limit = np.where(torque * speed > 0.0, driving, self.torque_limit)
        return np.clip(torque, -limit, limit)
