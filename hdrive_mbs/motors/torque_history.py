"""Motor torque from a table over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.expression import Value
from hdrive_mbs.motors.characteristic import MotorCharacteristic
from hdrive_mbs.quantities import option, table
from hdrive_mbs.tables import check_table, held


@dataclass(frozen=True, kw_only=True)
class TorqueHistory(MotorCharacteristic):
    """A torque M(t) as it was recorded, whatever the speed.

    Straight lines between the points, or each value held until the next time (a sampled command); before the first
    and after the last point constant.  Nothing corrects the speed: noise of the record adds up in it.
    """

    times: tuple[float, ...] = table("s", "times, rising")
    torques: tuple[float, ...] = table("N m", "torques at these times")
    held: bool = option("whether each value is held until the next time", default=False)

    def check(self) -> None:
        check_table(self, "times", "torques")

    def torque(self, time: Value, speed: Value) -> Value:
        return held(time, self.times, self.torques) if self.held else np.interp(time, self.times, self.torques)
