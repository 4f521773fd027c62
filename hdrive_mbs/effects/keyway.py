"""A spot of a shaft that bends more easily one way than across: a keyway, a flat, a slot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.crack_effect import CrackEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class Keyway(CrackEffect):
    """A short keyway, flat or slot: a hinge that turns with the shaft and never shuts, CrackEffect with

    g = 1,   a_1 = c M_1 in the plane that bends more easily,   a_2 = e c M_2 across

    Turned by half a turn it is the same hinge.  Where a whole section bends more easily one way, take ShaftStiffnessAsymmetry, whose
    angle is that of the stiffer plane: a quarter of a turn on.

    Source: the hinge of R. Gasch, J. Sound and Vibration 160 (1993) 313, without the breathing; R. Gasch et al., Rotordynamik
    (2006), ch. 12, for what it does: 2x alone.  Leaves out that torsion and tension couple in, and the mass that was cut away.
    """

    cross_share: float = parameter(
        "1", "e, compliance across over that in the softer plane", default=0.0, low=0.0, high=1.0, typical=(0.0, 0.5)
    )
    angle: float = parameter(
        "rad",
        "direction of the plane that bends more easily, from x towards y at spin angle 0",
        default=0.0,
        low=-math.tau,
        high=math.tau,
        typical=(-1.6, 1.6),
    )

    family: ClassVar[str] = "shaft_asymmetry"
    signature: ClassVar[str] = "2x that peaks at half the critical speed, no 1x of its own; slightly lower resonances"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {**CrackEffect.starts, "angle": (-0.78, 0.0, 0.78, 1.57)}
    half_turn: ClassVar[frozenset[str]] = frozenset({"angle"})

    def opening(self, moment: Value, cosine: Value, sine: Value, gravity: tuple[float, float]) -> tuple[Value, Value]:
        return 1.0, 0.0
