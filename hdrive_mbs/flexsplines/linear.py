"""A flexspline of constant stiffness."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.law import StiffnessLaw
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LinearStiffness(StiffnessLaw):
    """M(phi) = k phi: what a data sheet's single number says.

    Leaves out the lost motion and that a flexspline stiffens with torque (seed F, Folega et al. 2014, Table 1: no stiffness
    in a gap of 9', then 3.2e4, 6.4e4 and 11e4 N m/rad).
    """

    constant: float = parameter("N m/rad", "stiffness k", above=0.0)

    def torque(self, twist: Value) -> Value:
        return self.constant * twist
