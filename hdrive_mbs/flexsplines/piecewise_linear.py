"""Catalogue stiffness in three straight pieces with lost motion: seed F, (7)-(10)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.law import FloatArray, StiffnessLaw
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class PiecewiseLinearStiffness(StiffnessLaw):
    """The manufacturers' three-piece law with lost motion.

    phi = phi0/2 + T/K1                                   (T <= T1)
    phi = phi0/2 + T1/K1 + (T - T1)/K2                    (T1 < T <= T2)
    phi = phi0/2 + T1/K1 + (T2 - T1)/K2 + (T - T2)/K3     (T > T2)

    and the odd mirror image for negative torque; zero torque inside the gap.

    Source: seed F, Folega et al. 2014, (7)-(10) with two misprints corrected: (9) prints T/K1 for
    T1/K1, (10) prints T/K1 and (T - T1)/K2; only the form above gives the values of its Table 1.
    Leaves out hysteresis, temperature and the dependence on the wave generator's angle.
    """

    lost_motion: float = parameter("rad", "full width phi0 of the gap", low=0.0, high=0.05)
    stiffness_1: float = parameter("N m/rad", "K1, up to torque_1", above=0.0)
    stiffness_2: float = parameter("N m/rad", "K2, between torque_1 and torque_2", above=0.0)
    stiffness_3: float = parameter("N m/rad", "K3, above torque_2", above=0.0)
    torque_1: float = parameter("N m", "T1, first corner", above=0.0)
    torque_2: float = parameter("N m", "T2, second corner", above=0.0)

    def check(self) -> None:
        if self.torque_2 < self.torque_1:
            raise ParameterError(
                f"PiecewiseLinearStiffness.torque_2 = {self.torque_2:g} N m is below torque_1 = "
                f"{self.torque_1:g} N m; the corners must be in rising order (T1 <= T2)."
            )

    @property
    def half_gap(self) -> float:
        return self.lost_motion / 2.0

    @property
    def corners(self) -> tuple[float, float, float]:
        """Twist [rad] at the gap edge and at the two corners."""
        first = self.half_gap + self.torque_1 / self.stiffness_1
        return self.half_gap, first, first + (self.torque_2 - self.torque_1) / self.stiffness_2

    def torque(self, twist: Value) -> Value:
        edge, first, second = self.corners
        size = np.abs(twist)
        value = (
            self.stiffness_1 * np.maximum(size - edge, 0.0)
            + (self.stiffness_2 - self.stiffness_1) * np.maximum(size - first, 0.0)
            + (self.stiffness_3 - self.stiffness_2) * np.maximum(size - second, 0.0)
        )
        return np.sign(twist) * value

    def twist(self, torque: npt.ArrayLike) -> FloatArray:
        edge, first, second = self.corners
        wanted = np.asarray(torque, float)
        size = np.abs(wanted)
        angle = np.where(
            size <= self.torque_1,
            edge + size / self.stiffness_1,
            np.where(
                size <= self.torque_2,
                first + (size - self.torque_1) / self.stiffness_2,
                second + (size - self.torque_2) / self.stiffness_3,
            ),
        )
        return np.asarray(np.sign(wanted) * angle, float)
