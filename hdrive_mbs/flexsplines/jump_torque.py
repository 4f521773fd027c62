"""The jump law read as a torque: seed F, (11)-(14)."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.flexsplines.jump import JumpStiffness
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class JumpTorqueStiffness(JumpStiffness):
    """Zero inside the gap, a cubic torque outside it, and a jump by M_A at the edge.

    M(phi) = a sign(phi) + b phi + c phi |phi| + d phi^3   for |phi| > phi0/2,  0 inside;
    beyond largest_twist along its tangent.

    Source: seed F, Folega et al. 2014, (11)-(14) after Ostapski 1995, with K_FS read as the elastic
    torque that its figures show.  As printed (11) is odd only for a = c = 0, and (12) mends the
    term c but not a; here both carry the sign.  (14), which the paper uses, has a = c = 0 and is
    odd.  Leaves out what a real flexspline does at the edge: the jump is the fault that the paper
    finds with this law, it makes torque pulses between 0 and M_A and very small steps.
    """

    linear: float = parameter("N m/rad", "coefficient b")
    cubic: float = parameter("N m/rad^3", "coefficient d")
    constant: float = parameter("N m", "coefficient a, with the sign of the twist", default=0.0)
    quadratic: float = parameter("N m/rad^2", "coefficient c, with the sign of the twist", default=0.0)

    first_power = 1

    @property
    def coefficients(self) -> tuple[float, ...]:
        return self.constant, self.linear, self.quadratic, self.cubic
