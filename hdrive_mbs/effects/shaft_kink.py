"""A shaft with a kink."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.bow_load import add_bow, load_of
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import parameter
from hdrive_mbs.tracked_arrays import array_of


@dataclass(frozen=True, kw_only=True)
class ShaftKink(Effect):
    """A free shaft that is straight but for a kink in one section.

    F = K R(f + p) q_0,  q_0 = 0 at end a,  ((1 - s) L, 1) A at end b

    with the bending stiffness K of the section of length L, the kink by the angle A at the share s of it, and the
    rotation R about the axis by the twisted spin angle f of end a.  The forces on the section are in balance and turn;
    with positive A the part beyond bends towards p at larger z.  The torque on the spin that belongs to it is there too.

    Source: a bow is a force K q_0 that turns, Nicholas, Gunter, Allaire, ASME J. Eng. Power 98 (1976) 171.  Leaves out
    the softness of a shaft that was bent so sharply.
    """

    angle: float = parameter("rad", "A, kink", low=0.0, high=0.1, typical=(1e-7, 5e-3))
    phase: float = parameter(
        "rad", "p, side to which it leans beyond, from x towards y at spin angle 0", default=0.0, typical=(-np.pi, np.pi)
    )
    share: float = parameter("1", "s, where it is, from 0 at end a to 1 at end b", default=0.5, low=0.0, high=1.0, typical=(0.0, 1.0))

    acts_on: ClassVar[str] = "shaft"
    kind: ClassVar[str] = "kinematic"
    family: ClassVar[str] = "bow"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("angle", "phase"),)
    signature: ClassVar[str] = "vibration once per turn that is there at the lowest speed already and does not grow with its square"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        piece = draft.shaft(place, type(self).__name__)
        moved, turned = self.angle * ((1.0 - self.share) * piece.length), self.angle
        in_x = array_of([0.0] * 6 + [moved, 0.0, 0.0, 0.0, turned, 0.0])
        in_y = array_of([0.0] * 6 + [0.0, moved, 0.0, -turned, 0.0, 0.0])
        spin = next(end for end in piece.ends if not end.held)
        add_bow(self, draft, name, spin, (load_of(piece, in_x), load_of(piece, in_y)), self.phase)
