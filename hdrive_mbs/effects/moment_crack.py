"""A crack that opens and closes with the bending moment across it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.crack_effect import CrackEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class MomentCrack(CrackEffect):
    """A crack that is open where the bending moment pulls at it: CrackEffect with

    g = (1 - tanh(M_1/M_c))/2

    for the moment M_1 that presses it shut, of weight, unbalance and vibration alike.  Small M_c: it switches.

    Source: R. Gasch, J. Sound and Vibration 160 (1993) 313, with his switch made smooth.  Leaves out that the compliance across
    opens by more than M_1, the coupling of bending with torsion and tension, and damping in the crack.  As g follows M_1
    and not a potential, a turn of the shaft may gain or lose a little work.
    """

    closing_moment: float = parameter("N m", "M_c, moment over which it opens and shuts", above=0.0, high=1e5, typical=(3.0, 100.0))

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {**CrackEffect.starts, "closing_moment": (15.0,)}

    def opening(self, moment: Value, cosine: Value, sine: Value, gravity: tuple[float, float]) -> tuple[Value, Value]:
        return 0.5 * (1.0 - np.tanh(moment / self.closing_moment)), 0.0
