"""Angle table over time: a measured motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hdrive_mbs.expression import Pieces, Value
from hdrive_mbs.motors.profiles.profile import SpeedProfile
from hdrive_mbs.quantities import option, table
from hdrive_mbs.tables import check_table


@dataclass(frozen=True, kw_only=True)
class AngleTable(SpeedProfile):
    """Cubic spline through (time, angle), counted from t = 0 unless they are absolute: angle, speed and acceleration are continuous.

    Beyond the table the speed stays as it is at its ends, where the acceleration is zero.

    A spline goes through every point, and its acceleration magnifies what is wrong there by up to 12 over the square
    of the step: smooth a measured angle before.
    """

    times: tuple[float, ...] = table("s", "times, rising")
    angles: tuple[float, ...] = table("rad", "angles at these times")
    absolute: bool = option(
        "whether the angles count as given, from a mark on the shaft, and a train starts turned to the first", default=False
    )

    def check(self) -> None:
        check_table(self, "times", "angles")

    def angle(self, time: Value) -> Value:
        pieces = self._pieces
        return pieces(time) if self.absolute else pieces(time) - float(pieces(0.0))

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
