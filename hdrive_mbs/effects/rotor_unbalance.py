"""A mass that a rotor has too much on one side."""

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
class RotorUnbalance(Effect):
    """Static unbalance of a rotor on top of the one it has, in its own plane or beside it.

    F = U (w^2 - i a) exp(i (f + p)),  F = F_x + i F_y,  M_y - i M_x = l F

    with the rotor's own twisted spin angle f, its speed w and acceleration a.  It is no force in the equations but
    moves the centre of mass of the rigid body by U/m, with all couplings to spin and weight, so run-ups are exact.

    Source: ISO 21940-2 (static and quasi-static unbalance); rigid-body mechanics.  Leaves out the mass itself: the
    rotor gets no heavier.
    """

    unbalance: float = parameter("kg m", "U, mass times distance from the axis", low=0.0, high=1.0, typical=(1e-7, 5e-2))
    phase: float = parameter("rad", "p, from x towards y at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    lever: float = parameter("m", "l, how far its plane lies from that of the rotor along +z", default=0.0, typical=(-0.1, 0.1))

    acts_on: ClassVar[str] = "rotor"
    family: ClassVar[str] = "unbalance"
    leads: ClassVar[bool] = True
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("unbalance", "phase"),)
    signature: ClassVar[str] = "vibration once per turn that grows with the square of speed and turns its phase at critical speeds"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        x, y = self.unbalance * cosine(self.phase), self.unbalance * sine(self.phase)
        add_unbalance(self, draft, place, static=(x, y), couple=(self.lever * x, self.lever * y))
