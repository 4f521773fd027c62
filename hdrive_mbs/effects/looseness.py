"""A foot that lifts off its foundation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.support_effect import SupportEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.bearing_draft import SupportDraft
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class Looseness(SupportEffect):
    """A support that is softer when its housing is lifted beyond a point, up to where the bolt's head holds it again.

    F = S(y) - a (S(b) - S(y_0)),  b = min(max(y, y_0), y_0 + g)

    with the spring S of the foundation, so the stiffness is 1 - a of it for y_0 < y < y_0 + g and all of it elsewhere.
    y counts from where the housing sits without load: gravity has it start at y_s = -weight/stiffness, below y_0 = 0.
    With y_0 = 0 a foot that only stands lifts when the motion about y_s exceeds |y_s|; y_0 < y_s is a foot whose bolt
    has let go, y_0 > 0 one with preload left.

    Source: bilinear stiffness of loose pedestals, e.g. A. Muszynska, P. Goldman, Chaos, Solitons and Fractals 5 (1995) 1683.
    Leaves out impacts' own damping, the tilt of the foot and friction under it.  The force has corners: a fixed step has to be short
    against the period of the housing on its foundation, 1/30 or less.
    """

    share: float = parameter("1", "a, share of the stiffness that is lost", low=0.0, high=0.999, typical=(0.005, 0.95))
    lift_off: float = parameter(
        "m", "y_0, displacement from the place without load at which it sets in", default=0.0, low=-0.01, high=0.01, typical=(-5e-5, 5e-5)
    )
    play: float | None = parameter("m", "g, way until the bolt's head holds it; none: it never does", default=None, above=0.0, high=0.1)
    direction: str = option("'y' (up), 'x' or 'both'", default="y")

    family: ClassVar[str] = "looseness"
    signature: ClassVar[str] = "even harmonics and a mean shift in the direction of lifting, subharmonics of the spin at large amplitude"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"share": (0.1, 0.5), "lift_off": (-5e-6, 0.0)}

    def added(self, direction: str, x: Value, rate: Value, support: SupportDraft) -> Value:
        lifted = np.maximum(x, self.lift_off)
        if self.play is not None:
            lifted = np.minimum(lifted, self.lift_off + self.play)
        return -self.share * (support.spring(direction, lifted) - support.spring(direction, self.lift_off))
