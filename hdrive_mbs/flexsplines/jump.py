"""What the two readings of the jump law share: seed F, (11)-(14)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.fitting import Curve, fit_pair, gap_of, one_side
from hdrive_mbs.flexsplines.law import StiffnessLaw
from hdrive_mbs.flexsplines.polynomial import check_rising, continued
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class JumpStiffness(StiffnessLaw):
    """Zero torque inside the gap, an odd polynomial outside it, a jump by M_A at the edge.

    A subclass gives the ``coefficients`` of the torque outside the gap.  Beyond largest_twist the
    torque goes on along its tangent.
    """

    lost_motion: float = parameter("rad", "full width phi0 of the gap", low=0.0, high=0.05)
    largest_twist: float | None = parameter("rad", "twist up to which it holds; everywhere if not given", default=None, above=0.0)

    first_power: ClassVar[int]
    """Power of the twist in the first of the two terms of (14)."""

    @property
    def coefficients(self) -> tuple[float, ...]:
        """Coefficients of the torque in rising powers of phi, for phi > phi0/2."""
        raise NotImplementedError

    def check(self) -> None:
        owner = type(self).__name__
        if self.largest_twist is not None and self.largest_twist <= self.half_gap:
            raise ParameterError(
                f"{owner}.largest_twist = {self.largest_twist:g} rad lies inside the gap of +-{self.half_gap:g} rad; give a larger one."
            )
        if self.edge_torque < 0.0:
            raise ParameterError(
                f"{owner}: the torque at the edge of the gap, M_A = {self.edge_torque:.4g} N m, pulls away from zero twist; "
                "it must be at least 0 N m. Change the coefficients or the lost motion."
            )
        check_rising(owner, self.coefficients, self.half_gap, self.largest_twist)

    @property
    def half_gap(self) -> float:
        return self.lost_motion / 2.0

    @property
    def edge_torque(self) -> float:
        """M_A [N m]: the torque just outside the gap, by which the law jumps."""
        return float(continued(self.half_gap, self.coefficients, None))

    @classmethod
    def fitted_to(cls, curve: Curve, *, largest_torque: float | None = None, lost_motion: float | None = None) -> Self:
        """b and d of (14), a = c = 0, by least squares of the torque outside the gap.

        curve : a law, or measured (twists, torques)
        largest_torque : N m, where the fit ends (of points: all of them if not given)
        lost_motion : rad, the gap; that of the law if not given
        """
        gap = gap_of(curve, lost_motion)
        twist, torque = one_side(curve, largest_torque, gap / 2.0, 0)
        linear, cubic = fit_pair(twist, torque, cls.first_power, gap / 2.0)
        values = {"linear": linear, "cubic": cubic, "largest_twist": float(np.max(twist))}
        return cls(lost_motion=gap, **values)

    def torque(self, twist: Value) -> Value:
        size = np.abs(twist)
        outside = np.sign(twist) * continued(size, self.coefficients, self.largest_twist)
        return np.where(size > self.half_gap, outside, 0.0)
