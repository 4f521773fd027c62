"""The continuous law with a cubic on each side of the gap: seed F, (15)-(17)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.fitting import Curve, fit_side, gap_of, one_side
from hdrive_mbs.flexsplines.law import StiffnessLaw
from hdrive_mbs.flexsplines.polynomial import check_rising, continued
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ContinuousStiffness(StiffnessLaw):
    """Zero torque inside the gap, a cubic that starts from zero at its edge on each side.

    M(phi) =  k1 s + k2 s^2 + k3 s^3,   s =  phi - phi0/2   for phi >  phi0/2
    M(phi) = -(the same with the coefficients of the negative side, s = -phi - phi0/2) for phi < -phi0/2
    M(phi) = 0 inside the gap; beyond largest_twist along the tangent.

    Source: seed F, Folega et al. 2014, (15)-(17), whose a + b phi + c phi^2 + d phi^3 is written here
    about the edge of the gap.  The paper prints no coefficients and does not say that the law must
    be continuous at the edge, which is its whole point; in this form it cannot be otherwise.
    ``from_polynomial`` takes a, b, c, d; ``polynomial`` gives them back.  Leaves out hysteresis.
    """

    lost_motion: float = parameter("rad", "full width phi0 of the gap", low=0.0, high=0.05)
    edge_stiffness: float = parameter("N m/rad", "k1, slope at the edge of the gap", low=0.0)
    quadratic: float = parameter("N m/rad^2", "k2")
    cubic: float = parameter("N m/rad^3", "k3")
    largest_twist: float | None = parameter("rad", "twist up to which the cubics hold; everywhere if not given", default=None, above=0.0)
    negative_edge_stiffness: float | None = parameter("N m/rad", "k1 of the negative side (as positive)", default=None, low=0.0)
    negative_quadratic: float | None = parameter("N m/rad^2", "k2 of the negative side (as positive)", default=None)
    negative_cubic: float | None = parameter("N m/rad^3", "k3 of the negative side (as positive)", default=None)

    def check(self) -> None:
        owner = type(self).__name__
        if self.largest_twist is not None and self.largest_twist <= self.half_gap:
            raise ParameterError(
                f"{owner}.largest_twist = {self.largest_twist:g} rad lies inside the gap of +-{self.half_gap:g} rad; give a larger one."
            )
        given = [value is not None for value in (self.negative_edge_stiffness, self.negative_quadratic, self.negative_cubic)]
        if any(given) and not all(given):
            raise ParameterError(
                f"{owner}: give all of negative_edge_stiffness, negative_quadratic, negative_cubic, or none (mirror image)."
            )
        for side in (self.positive_side, self.negative_side):
            check_rising(owner, side, 0.0, self._reach, offset=self.half_gap)

    @property
    def half_gap(self) -> float:
        return self.lost_motion / 2.0

    @property
    def _reach(self) -> float | None:
        return None if self.largest_twist is None else self.largest_twist - self.half_gap

    @property
    def positive_side(self) -> tuple[float, ...]:
        """Coefficients of s^0 .. s^3 of the positive side."""
        return 0.0, self.edge_stiffness, self.quadratic, self.cubic

    @property
    def negative_side(self) -> tuple[float, ...]:
        """Coefficients of s^0 .. s^3 of the negative side, as positive numbers."""
        k1, k2, k3 = self.negative_edge_stiffness, self.negative_quadratic, self.negative_cubic
        if k1 is None or k2 is None or k3 is None:
            return self.positive_side
        return 0.0, k1, k2, k3

    @property
    def odd(self) -> bool:
        """Whether both sides are alike."""
        return self.positive_side == self.negative_side

    def torque(self, twist: Value) -> Value:
        if self.odd:
            distance = np.maximum(np.abs(twist) - self.half_gap, 0.0)
            return np.sign(twist) * continued(distance, self.positive_side, self._reach)
        up = continued(np.maximum(twist - self.half_gap, 0.0), self.positive_side, self._reach)
        down = continued(np.maximum(-twist - self.half_gap, 0.0), self.negative_side, self._reach)
        return up - down

    # -- the coefficients of the paper ----------------------------------------------------------
    @classmethod
    def from_polynomial(
        cls,
        positive: Sequence[float],
        negative: Sequence[float] | None = None,
        *,
        lost_motion: float,
        largest_twist: float | None = None,
    ) -> Self:
        """From (a_p, b_p, c_p, d_p) of (17) and (a_m, b_m, c_m, d_m) of (15); mirror image if not given.

        Raises ParameterError where a side does not start from zero at the edge of the gap (to
        1e-6 of its terms: six printed digits).
        """
        values = dict(zip(_POSITIVE, _about_edge(positive, lost_motion / 2.0), strict=True))
        if negative is not None:
            values |= zip(_NEGATIVE, _about_edge(negative, -lost_motion / 2.0), strict=True)
        return cls(lost_motion=lost_motion, largest_twist=largest_twist, **values)

    def polynomial(self, sign: int = 1) -> tuple[float, float, float, float]:
        """a, b, c, d of (17) for sign = +1, of (15) for sign = -1 [N m/rad^k]."""
        _, k1, k2, k3 = self.positive_side if sign > 0 else self.negative_side
        e = self.half_gap
        a, b, c, d = -k1 * e + k2 * e**2 - k3 * e**3, k1 - 2.0 * k2 * e + 3.0 * k3 * e**2, k2 - 3.0 * k3 * e, k3
        return (a, b, c, d) if sign > 0 else (-a, b, -c, d)

    @classmethod
    def fitted_to(cls, curve: Curve, *, largest_torque: float | None = None, lost_motion: float | None = None) -> Self:
        """Least squares of the torque outside the gap, rising, each side for itself.

        curve : a law, or measured (twists, torques), which are folded on to one side
        largest_torque : N m, where the fit ends (of points: all of them if not given)
        lost_motion : rad, the gap; that of the law if not given
        """
        gap = gap_of(curve, lost_motion)
        sides = [one_side(curve, largest_torque, gap / 2.0, sign) for sign in (1, -1)]
        positive, negative = (fit_side(twist - gap / 2.0, torque) for twist, torque in sides)
        values = dict(zip(_POSITIVE, positive, strict=True))
        if not np.allclose(positive, negative, rtol=1e-9, atol=0.0):
            values |= zip(_NEGATIVE, negative, strict=True)
        return cls(lost_motion=gap, largest_twist=float(np.max(sides[0][0])), **values)


_POSITIVE = ("edge_stiffness", "quadratic", "cubic")
_NEGATIVE = ("negative_edge_stiffness", "negative_quadratic", "negative_cubic")


def _about_edge(coefficients: Sequence[float], edge: float) -> tuple[float, float, float]:
    """k1, k2, k3 of the side that starts at this edge of the gap; refuses a jump there.

    With phi = edge + sign(edge) s:  M = sign(edge) (k1 s + k2 s^2 + k3 s^3).
    """
    a, b, c, d = coefficients
    terms = (a, b * edge, c * edge**2, d * edge**3)
    if abs(sum(terms)) > 1e-6 * max(map(abs, terms)):
        raise ParameterError(
            f"ContinuousStiffness: coefficients {tuple(coefficients)} give {sum(terms):.4g} N m at the edge of the gap "
            f"({edge:.6g} rad); the law must start from 0 N m there. With the same b, c, d take a = {a - sum(terms):.9g} N m."
        )
    sign = -1.0 if edge < 0.0 else 1.0
    return b + 2.0 * c * edge + 3.0 * d * edge**2, sign * (c + 3.0 * d * edge), d
