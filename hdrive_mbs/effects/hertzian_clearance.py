"""Radial play of a bearing whose contact stiffens with the load."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.bearing_clearance import BearingClearance
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class HertzianClearance(BearingClearance):
    """BearingClearance with a contact force that grows with a power of the approach.

    N = F_0 (S/(n F_0))^n (1 + (1 - d) D_n p'/F_0),  S = (1 - a) S_n(p)

    in place of N: the power law that has the bearing's own stiffness at the force F_0 (N = A p^n with n N/p = k there), with
    a damping in proportion to the force that is the bearing's own at F_0, never pulling.

    Source: n = 3/2 for balls (Hertz, see BallBearing), 10/9 for rollers (Palmgren); damping after K. H. Hunt, F. R. E. Crossley,
    J. Applied Mechanics 42 (1975) 440.  Leaves out how the load spreads over the rolling elements, and the rest of what
    BearingClearance leaves out.
    """

    exponent: float = parameter("1", "power n: 10/9 for rollers, 3/2 for balls", default=10.0 / 9.0, low=1.0, high=3.0)
    reference_force: float = parameter("N", "F_0, at which the stiffness is that of the bearing", above=0.0, high=1e6, typical=(50.0, 5e3))

    leads: ClassVar[bool] = False

    def normal(self, spring: Value, damping: Value) -> Value:
        contact = self.reference_force * (np.maximum(spring, 0.0) / (self.exponent * self.reference_force)) ** self.exponent
        return contact * (1.0 + (1.0 - self.film_damping) * damping / self.reference_force)
