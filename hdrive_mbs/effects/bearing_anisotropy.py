"""A bearing that is stiffer one way than across."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.bearing_effect import BearingEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import Across, BearingDraft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class BearingAnisotropy(BearingEffect):
    """The spring of a bearing, 1 + a times as stiff along one direction and 1 - a across it.

    F = S(u) + a R S(u),   R = [[cos 2b, sin 2b], [sin 2b, -cos 2b]]

    for the displacement u of the ring against the housing; R mirrors at the direction b, fixed in space.

    Source: principal axes of a symmetric stiffness; a > 0 splits each critical speed into two, with backward whirl between them
    (R. Gasch et al., Rotordynamik (2006), ch. 6).  Leaves out that damping differs too.
    """

    asymmetry: float = parameter("1", "a, share by which the spring is stiffer along b", low=-0.95, high=0.95, typical=(-0.5, 0.5))
    angle: float = parameter("rad", "b, direction from x towards y", default=0.0, low=-math.pi, high=math.pi)

    family: ClassVar[str] = "bearing_anisotropy"
    signature: ClassVar[str] = "elliptic orbits, resonances that part in x and y, backward whirl between two critical speeds"

    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        x, y = law.spring("x", s, v), law.spring("y", s, v)
        c, d = self.asymmetry * math.cos(2.0 * self.angle), self.asymmetry * math.sin(2.0 * self.angle)
        return {"x": c * x + d * y, "y": d * x - c * y}
