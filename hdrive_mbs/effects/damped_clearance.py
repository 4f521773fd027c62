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

    F = S(p u/r) + (d + (1 - d) s) D u',   p = r - c, s = 1 beyond the gap,  p = s = 0 within it

    in place of S(u) + D u', for the displacement u of the ring, r = |u|; S and D are the spring and the damper that the
    bearing has.  d is the share of the film that is left in the gap.  Contact sets in from c - w to c + w, where
    s = (r - c + w)/(2 w) and p = w s^2: roughness and errors of form round the corner off; w counts up to c.  c = 0 is the
    bearing.

    Source: the bilinear spring of e.g. F. F. Ehrich, J. Vibration and Acoustics 110 (1988) 9; how it is damped is our choice.
    Unlike BearingClearance the lubricant of a contact damps sliding along the race too, and may pull for a moment while the
    contact opens.  Leaves out the single rolling elements and what a tilt does to the play.  With a short w the force has a corner,
    and with d < 1 a step, at r = c: a fixed step has to resolve the contact.
    """

    gap: float = parameter("m", "radial gap c, half of the play between the extreme positions", low=0.0, high=1e-2, typical=(5e-8, 5e-5))
    film_damping: float = parameter("1", "share d of the damping that acts in the gap", default=0.1, low=0.0, high=1.0, typical=(0.01, 1.0))
    rounding: float = parameter("m", "w, contact sets in over 2 w", default=1e-9, above=0.0, high=1e-3, typical=(1e-9, 1e-6))

    family: ClassVar[str] = "bearing_clearance"
    signature: ClassVar[str] = (
        "softer at small amplitude: resonances that rise with the amplitude, jumps, harmonics and subharmonics of the spin, "
        "a ring-down whose frequency falls"
    )
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"gap": (2e-7, 1e-6, 5e-6, 2e-5), "film_damping": (0.1,), "rounding": (2e-7,)}

    def added(self, s: Across, v: Across, law: BearingDraft) -> Mapping[str, Value]:
        x, y = s["x"], s["y"]
        square = x * x + y * y
        r = np.sqrt(np.maximum(square, _NOTHING**2))
        along = {"x": x / r, "y": y / r}
        w = min(self.rounding, self.gap)
        touching = np.clip((r - self.gap + w) / (2.0 * w), 0.0, 1.0) if w > 0.0 else 1.0
        approach = w * touching * touching + np.maximum(r - self.gap - w, 0.0)
        inside = {**s, **{key: approach * n for key, n in along.items()}}
        left = (1.0 - self.film_damping) * (1.0 - touching)
        return {key: law.spring(key, inside, v) - law.spring(key, s, v) - left * law.damper(key, v) for key in along}
