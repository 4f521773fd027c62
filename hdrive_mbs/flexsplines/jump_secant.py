"""The jump law read literally, as a stiffness: seed F, (11)-(14)."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.flexsplines.jump import JumpStiffness
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class JumpSecantStiffness(JumpStiffness):
    """Zero stiffness inside the gap, a cubic secant stiffness outside it, and a jump by M_A at the edge.

    M(phi) = K(phi) phi,   K = a + b |phi| + c phi^2 + d |phi|^3   for |phi| > phi0/2,  0 inside;
    beyond largest_twist the torque goes on along its tangent.

    Source: seed F, Folega et al. 2014, (11)-(14) read literally: K_FS in N m/rad multiplies the
    twist in (2)-(3).  The torque is odd only if K is even.  As printed, (11) breaks that by its
    terms b and d, (12) by b, c and d, and (14), which has no others, gives an even torque: for
    negative twist it pulls away from zero; hence the absolute values here.  Leaves out the same
    as JumpTorqueStiffness: the jump at the edge is not physical.
    """

    linear: float = parameter("N m/rad^2", "coefficient b, of |phi|")
    cubic: float = parameter("N m/rad^4", "coefficient d, of |phi|^3")
    constant: float = parameter("N m/rad", "coefficient a", default=0.0)
    quadratic: float = parameter("N m/rad^3", "coefficient c, of phi^2", default=0.0)

    first_power = 2

    @property
    def coefficients(self) -> tuple[float, ...]:
        return 0.0, self.constant, self.linear, self.quadratic, self.cubic
