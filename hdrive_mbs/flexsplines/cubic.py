"""Odd cubic polynomial without a gap: seed F, Fig. 6."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.fitting import Curve, fit_pair, one_side
from hdrive_mbs.flexsplines.law import StiffnessLaw
from hdrive_mbs.flexsplines.polynomial import check_rising, continued
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class CubicStiffness(StiffnessLaw):
    """A cubic through the whole stiffness curve, the gap smoothed over.

    M(phi) = a phi + d phi^3  for |phi| <= largest_twist, along its tangent beyond.

    Source: seed F, Folega et al. 2014, Fig. 6 (after Hidaka et al. 1990), which does not print its
    coefficients; odd, so that both senses are alike.  Leaves out the lost motion: near zero twist
    it is only soft, for the catalogue curve of Table 1 it gives up to 7 N m inside the gap.
    """

    linear: float = parameter("N m/rad", "coefficient a", low=0.0)
    cubic: float = parameter("N m/rad^3", "coefficient d")
    largest_twist: float | None = parameter("rad", "twist up to which the cubic holds; everywhere if not given", default=None, above=0.0)

    def check(self) -> None:
        check_rising(type(self).__name__, self.coefficients, 0.0, self.largest_twist)

    @property
    def coefficients(self) -> tuple[float, float, float, float]:
        """Of phi^0 .. phi^3, for phi >= 0."""
        return 0.0, self.linear, 0.0, self.cubic

    @classmethod
    def fitted_to(cls, curve: Curve, *, largest_torque: float | None = None) -> Self:
        """Least squares through a law (gap included) or through measured (twists, torques).

        largest_torque : N m, where the fit ends (of points: all of them if not given).  The
        coefficients are held where the torque rises and does not pull away from zero.
        """
        twist, torque = one_side(curve, largest_torque, 0.0, 0)
        linear, cubic = fit_pair(twist, torque, 1, 0.0)
        return cls(linear=linear, cubic=cubic, largest_twist=float(np.max(twist)))

    def torque(self, twist: Value) -> Value:
        if self.largest_twist is None:
            return continued(twist, self.coefficients, None)
        inside = np.clip(twist, -self.largest_twist, self.largest_twist)
        beyond = self.linear + 3.0 * self.cubic * self.largest_twist**2
        return continued(inside, self.coefficients, None) + beyond * (twist - inside)
