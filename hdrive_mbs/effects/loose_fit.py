"""A housing that sits with play in its foundation."""

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
class LooseFit(SupportEffect):
    """A support that is softer within a play on both sides.

    F = S(x) - a S(b),  b = min(max(x, -g), g)

    with the spring S of the foundation: 1 - a of its stiffness within |x| < g, all of it beyond, -a S(g) behind.  x counts from where
    the housing sits without load, so in y a heavy rotor rests on one side of the play.

    Source: a bilinear spring, symmetric (see Looseness for one-sided).  Leaves out impacts' own damping and friction in the fit.
    The force has corners at +-g: steps as for Looseness.
    """

    share: float = parameter("1", "a, share of the stiffness that is lost within the play", low=0.0, high=0.999, typical=(0.005, 0.95))
    half_play: float = parameter("m", "g", above=0.0, high=0.01, typical=(1e-7, 1e-4))
    direction: str = option("'x' (sideways), 'y' or 'both'", default="x")

    family: ClassVar[str] = "looseness"
    signature: ClassVar[str] = "softer at small amplitude in that direction alone; odd harmonics, resonances that rise with the amplitude"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"share": (0.1, 0.5), "half_play": (1e-6, 5e-6), "direction": ("x", "y")}

    def added(self, direction: str, x: Value, rate: Value, support: SupportDraft) -> Value:
        return -self.share * support.spring(direction, np.clip(x, -self.half_play, self.half_play))
