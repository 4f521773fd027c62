"""Lost motion of a gear behind which the teeth come into contact bit by bit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.dead_zone import beyond, dead_zone
from hdrive_mbs.effects.gap_law_effect import GapLawEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SoftWindup(GapLawEffect):
    """A dead zone in front of the law of a connection, and beyond its edges a stiffness that comes up from zero.

    tau = T(r, 0) + T(s, v) - T(s, 0),  r = z + sign(z) g/2,  z = sign(d) (sqrt(d^2 + e^2) - e),
    d = x - clip(x, -h, h),  h = (g + b)/2,  s = d + sign(d) g/2

    with the law T(twist, rate) as it is without the effect and its own gap g.  The slope of the twist that counts, dz/dx, comes up over
    about e beyond each edge, and far beyond z lags by e: there the gap is wider by 2 e.  There is no torque inside the gap, where
    LostMotion has some with its film.  Damping stays as the law has it.  The elastic torque depends on x alone, so no energy is made.

    Source: a maker's catalogue names it ("soft windup characteristics in the low torque region", Harmonic Drive, FR component sets); the
    hyperbola is our own.  Leaves out that the soft range moves with load and assembly.
    """

    width: float = parameter("rad", "full width b of the gap", low=0.0, high=0.2, typical=(1e-5, 0.01))
    soft_twist: float = parameter(
        "rad", "twist e beyond each edge over which the stiffness comes up", above=0.0, high=0.1, typical=(3e-6, 1e-3)
    )

    family: ClassVar[str] = "backlash"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"width": (1e-5, 5e-5, 3e-4, 1.5e-3)}
    signature: ClassVar[str] = "no elastic torque over a range of twist and little beyond it; a resonance that comes down at small torque"

    def changed_beyond(self, law: Callable[[Value, Value], Value], gap: float) -> Callable[[Value, Value], Value]:
        if self.width == 0.0:
            return law
        soft = self.soft_twist

        def torque(twist: Value, rate: Value) -> Value:
            past = dead_zone(twist, gap + self.width, 0.0)
            sharp = beyond(past, gap)
            wound = beyond(np.sign(past) * (np.sqrt(past**2 + soft**2) - soft), gap)
            return law(wound, 0.0) + law(sharp, rate) - law(sharp, 0.0)

        return torque
