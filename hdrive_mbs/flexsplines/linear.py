"""A flexspline of constant stiffness."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.law import StiffnessLaw
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LinearStiffness(StiffnessLaw):
    """M(phi) = k phi: what a data sheet's single number says.

    Leaves out the lost motion and the soft beginning of every real flexspline (seed F, Folega et al. 2014, Table 1: two
    thirds of the stiffness at small torque, none inside the gap).
    """

    constant: float = parameter("N m/rad", "stiffness k", above=0.0)

    def torque(self, twist: Value) -> Value:
        return self.constant * twist
