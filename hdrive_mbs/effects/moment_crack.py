"""A crack that opens and closes with the bending moment across it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.crack_effect import CrackEffect
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.keyway import Keyway
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class MomentCrack(CrackEffect):
    """A crack that is open where the bending moment pulls at it: CrackEffect with

    g = (1 - tanh(M_0/M_c))/2

    for the moment M_0 that would press it shut were there no crack in its piece of shaft, of weight, unbalance and vibration alike.
    Small M_c: it switches.

    Source: R. Gasch, J. Sound and Vibration 160 (1993) 313, with his switch made smooth.  Leaves out that the compliance across
    opens by more than M_1, the coupling of bending with torsion and tension, and damping in the crack.  M_0 = M_1 (1 + h g c)
    is larger than the moment that the open crack feels, the more so the shorter its element is (h c = 0.28 for a shaft of 80 mm,
    c = 2.7e-7 rad/(N m) in the middle of 0.4 m): of one crack M_c goes with the mesh.  As g follows M_0 and not a potential, a turn
    of the shaft may gain or lose a little work.
    """

    cross_share: float = parameter(
        "1", "e, compliance across over that about the front", default=0.0, low=0.0, high=1.0, typical=(0.0, 0.5)
    )
    closing_moment: float = parameter("N m", "M_c, moment over which it opens and shuts", above=0.0, high=1e5, typical=(0.3, 200.0))

    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {**CrackEffect.starts, "closing_moment": (15.0,)}
    limits: ClassVar[tuple[type[Effect], ...]] = (Keyway,)  # with a large M_c, open by half whatever the moment

    def opening(self, moment: Value, cosine: Value, sine: Value, gravity: tuple[float, float]) -> tuple[Value, Value]:
        return 0.5 * (1.0 - np.tanh(moment / self.closing_moment)), 0.0
