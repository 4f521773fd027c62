"""Radial play of a bearing whose contact is damped along and across."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.bearing_effect import BearingEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import Across, BearingDraft
from hdrive_mbs.quantities import parameter

_NOTHING = 1e-15
"""m; keeps the direction of no displacement finite where there is no gap."""


@dataclass(frozen=True, kw_only=True)
class DampedClearance(BearingEffect):
    """The radial spring of a bearing acts beyond a gap; its damper acts fully in contact and with a share in the gap.

    F = S(p u/r) + D u'  where p = r - c > 0,  else  d D u'

    in place of S(u) + D u', for the displacement u of the ring, r = |u|; S and D are the spring and the damper that the
    bearing has.  d is the share of the film that is left in the gap.  c = 0 is the bearing.

    Source: the bilinear spring of e.g. F. F. Ehrich, J. Vibration and Acoustics 110 (1988) 9; how it is damped is our choice.
    Unlike BearingClearance the lubricant of a contact damps sliding along the race too, and may pull for a moment while the
    contact opens.  Leaves out the single rolling elements and what a tilt does to the play.  The force has a corner,
    and with d < 1 a step, at r = c: a fixed step has to resolve the contact.
    """

    gap: float = parameter("m", "radial gap c, half of the play between the extreme positions", low=0.0, high=1e-2, typical=(5e-8, 5e-5))
    film_damping: float = parameter("1", "share d of the damping that acts in the gap", default=0.1, low=0.0, high=1.0, typical=(0.01, 1.0))

    family: ClassVar[str] = "bearing_clearance"
    signature: ClassVar[str] = (
        "softer at small amplitude: resonances that rise with the amplitude, jumps, harmonics and subharmonics of the spin, "
        "a ring-down whose frequency falls"
    )
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"gap": (2e-7, 1e-6, 5e-6, 2e-5), "film_damping": (0.1,)}

    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        x, y = s["x"], s["y"]
        square = x * x + y * y
        r = np.sqrt(np.maximum(square, self.gap**2 + _NOTHING**2))
        along = {"x": x / r, "y": y / r}
        inside = {**s, **{key: (r - self.gap) * n for key, n in along.items()}}
        touching = np.where(square > self.gap**2, 1.0, 0.0)
        left = (1.0 - self.film_damping) * (1.0 - touching)
        return {key: touching * law.spring(key, inside, v) - law.spring(key, s, v) - left * law.damper(key, v) for key in along}
