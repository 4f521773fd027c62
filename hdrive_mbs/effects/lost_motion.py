"""Lost motion of a gear or coupling: a dead zone of the elastic torque."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.dead_zone import beyond, dead_zone
from hdrive_mbs.effects.gap_law_effect import GapLawEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LostMotion(GapLawEffect):
    """A dead zone in front of the law of a connection, in which its damping goes on.

    tau = T(r, 0) + T(s, v) - T(s, 0),  r = d + sign(d) g/2,  d(x) = x + (sqrt((x - h)^2 + e^2) - sqrt((x + h)^2 + e^2))/2,  h = (g + b)/2

    with the law T(twist, rate) as it is without the effect, its own gap g (lost motion of the gear, or 0), and s that is r for
    e = 0.  Then tau = T(s, v): the law counts from the edges of the whole gap.  e > 0 is a film or a soft flank that rounds the
    elastic torque over about e there; damping stays as the law has it, in the gap or beyond its edges.
    The elastic torque depends on x alone, so no energy is made.

    Source: dead-zone model, Nordin, Gutman, Automatica 38 (2002) 1633, with the damping of seed F
    (2)-(3), which acts inside the gap too; rounding as of a hyperbola.  Leaves out friction inside the
    gap (add hysteresis) and flanks that come apart without pulling (CouplingBacklash).
    """

    width: float = parameter("rad", "full width b of the gap", low=0.0, high=0.2, typical=(1e-5, 0.01))
    film: float = parameter(
        "rad", "twist e over which the corners are rounded; 0 for sharp ones", default=0.0, low=0.0, high=0.1, typical=(1e-6, 1e-3)
    )

    family: ClassVar[str] = "backlash"
    leads: ClassVar[bool] = True
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"width": (1e-5, 5e-5, 3e-4, 1.5e-3)}
    signature: ClassVar[str] = "no elastic torque over a range of twist; offset between both senses, a soft resonance at small torque"

    def changed_beyond(self, law: Callable[[Value, Value], Value], gap: float) -> Callable[[Value, Value], Value]:
        if self.width == 0.0:
            return law
        width = gap + self.width

        def torque(twist: Value, rate: Value) -> Value:
            sharp = beyond(dead_zone(twist, width, 0.0), gap)
            if self.film == 0.0:
                return law(sharp, rate)
            return law(beyond(dead_zone(twist, width, self.film), gap), 0.0) + law(sharp, rate) - law(sharp, 0.0)

        return torque
