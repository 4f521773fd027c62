"""A rotor whose principal axis leans."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.added_unbalance import add_unbalance
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import parameter
from hdrive_mbs.tracked import cosine, sine


@dataclass(frozen=True, kw_only=True)
class DynamicUnbalance(Effect):
    """Couple unbalance of a rotor on top of the one it has: a product of inertia.

    M = C (w^2 - i a) exp(i (f + p)),  M = M_y - i M_x

    with the rotor's own twisted spin angle f, its speed w and acceleration a.  A principal axis that leans by a small
    tilt towards p is C = (Jt - Jp) tilt; two masses m at the distance r from the axis, on opposite sides and b apart,
    the upper one (at +z) at p, are C = m r b.  It changes the inertia tensor, so run-ups are exact.

    Source: ISO 21940-2 (couple unbalance); rigid-body mechanics.  Leaves out what a lean does to the moments of
    inertia, of second order in it.
    """

    couple: float = parameter("kg m^2", "C, product of inertia", low=0.0, high=10.0, typical=(1e-8, 1e-2))
    phase: float = parameter(
        "rad", "p, side of the heavy end at +z, from x towards y at spin angle 0", default=0.0, typical=(-np.pi, np.pi)
    )

    acts_on: ClassVar[str] = "rotor"
    family: ClassVar[str] = "unbalance"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("couple", "phase"),)
    signature: ClassVar[str] = "vibration once per turn that grows with the square of speed, strongest where a rotor tilts"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        couple = self.couple * cosine(self.phase), self.couple * sine(self.phase)
        add_unbalance(self, draft, place, static=(0.0, 0.0), couple=couple)
