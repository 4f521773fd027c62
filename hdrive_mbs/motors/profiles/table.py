"""Speed table over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.expression import Value
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
        times, speeds = np.array(self.times), np.array(self.speeds)
        turned = np.concatenate(([0.0], np.cumsum(np.diff(times) * (speeds[1:] + speeds[:-1]) / 2.0)))
        # pieces: before the table, its intervals, after it; (start time, angle and speed there, acceleration)
        starts = np.concatenate(([times[0]], times))
        angles = np.concatenate(([0.0], turned))
        rates = np.concatenate(([speeds[0]], speeds))
        accelerations = np.concatenate(([0.0], np.diff(speeds) / np.diff(times), [0.0]))

        def piece(i: int, t: Value) -> Value:
            passed = t - float(starts[i])
            return float(angles[i]) + passed * (float(rates[i]) + 0.5 * float(accelerations[i]) * passed)

        def chosen(first: int, last: int, t: Value) -> Value:
            if first == last:
                return piece(first, t)
            middle = (first + last) // 2
            return np.where(t < float(times[middle]), chosen(first, middle, t), chosen(middle + 1, last, t))

        return chosen(0, len(times), time) - float(chosen(0, len(times), 0.0))
