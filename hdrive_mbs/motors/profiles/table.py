"""Speed table over time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hdrive_mbs.expression import Pieces, Value
from hdrive_mbs.motors.profiles.profile import SpeedProfile
from hdrive_mbs.quantities import table
from hdrive_mbs.tables import check_table


@dataclass(frozen=True, kw_only=True)
class SpeedTable(SpeedProfile):
    """Straight lines between (time, speed); before the first and after the last point constant.

    The angle is the exact integral from t = 0: a parabola in each piece.
    """

    times: tuple[float, ...] = table("s", "times, rising")
    speeds: tuple[float, ...] = table("rad/s", "speeds at these times")

    def check(self) -> None:
        check_table(self, "times", "speeds")

    def speed(self, time: Value) -> Value:
        return np.interp(time, self.times, self.speeds)

    def angle(self, time: Value) -> Value:
        angle = self._angle
        return angle(time) - float(angle(0.0))

    @cached_property
    def _angle(self) -> Pieces:
        """Angle from the first time on: before the table, its intervals, after it."""
        times, speeds = np.array(self.times), np.array(self.speeds)
        turned = np.concatenate(([0.0], np.cumsum(np.diff(times) * (speeds[1:] + speeds[:-1]) / 2.0)))
        accelerations = np.concatenate(([0.0], np.diff(speeds) / np.diff(times), [0.0]))
        coefficients = (np.concatenate(([0.0], turned)), np.concatenate(([speeds[0]], speeds)), accelerations / 2.0)
        return Pieces(times, np.concatenate(([times[0]], times)), np.column_stack(coefficients))
