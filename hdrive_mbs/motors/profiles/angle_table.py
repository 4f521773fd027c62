"""Angle table over time: a measured motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hdrive_mbs.expression import Pieces, Value
from hdrive_mbs.motors.profiles.profile import SpeedProfile
from hdrive_mbs.quantities import table
from hdrive_mbs.tables import check_table


@dataclass(frozen=True, kw_only=True)
class AngleTable(SpeedProfile):
    """Cubic spline through (time, angle): angle, speed and acceleration are continuous.  Outside it the speed stays.

    For angles without noise: a spline goes through every point, and its second derivative multiplies what is wrong
    there by 12 over the square of the step.  Smooth a measured angle before.
    """

    times: tuple[float, ...] = table("s", "times, rising")
    angles: tuple[float, ...] = table("rad", "angles at these times")

    def check(self) -> None:
        check_table(self, "times", "angles")

    def angle(self, time: Value) -> Value:
        return self._pieces(time)

    @cached_property
    def _pieces(self) -> Pieces:
        """Before the table, its intervals, after it."""
        from scipy.interpolate import CubicSpline

        times, angles = np.array(self.times), np.array(self.angles)
        spline = CubicSpline(times, angles, bc_type="natural")
        inside = spline.c[::-1].T
        before = [angles[0], float(spline(times[0], 1)), 0.0, 0.0]
        after = [angles[-1], float(spline(times[-1], 1)), 0.0, 0.0]
        return Pieces(times, np.concatenate(([times[0]], times)), np.vstack((before, inside, after)))
