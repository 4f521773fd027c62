"""Motor torque from a table over speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.expression import Value
from hdrive_mbs.motors.characteristic import MotorCharacteristic
from hdrive_mbs.quantities import option, table
from hdrive_mbs.tables import check_table, lines


@dataclass(frozen=True, kw_only=True)
class TorqueSpeedTable(MotorCharacteristic):
    """Straight lines between measured points (speed, torque): seed F, M_s(n) of Fig. 4.

    Beyond the table the torque keeps its first and last value, or, with ``extrapolate``, goes on
    along the first and last line: choose it for a motor that brakes above its no-load speed.
    Leaves out everything transient in the motor.
    """

    speeds: tuple[float, ...] = table("rad/s", "speeds, rising")
    torques: tuple[float, ...] = table("N m", "torques at these speeds")
    extrapolate: bool = option("whether the end lines go on beyond the table (else the end values hold)", default=False)

    def check(self) -> None:
        check_table(self, "speeds", "torques")

    def torque(self, time: Value, speed: Value) -> Value:
        if self.extrapolate:
            return lines(speed, self.speeds, self.torques)
        return np.interp(speed, self.speeds, self.torques)
