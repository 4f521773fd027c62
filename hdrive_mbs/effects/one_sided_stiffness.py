"""A connection that is stiffer or softer than known in one sense of twist only."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.gap_law_effect import GapLawEffect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class OneSidedStiffness(GapLawEffect):
    """The elastic torque of a connection, scaled in one sense and as known in the other.

    tau = T(x, v) + a s T(x, 0),  s = y/(y + x_0),  y = max(x - g/2, 0) if forward, max(-x - g/2, 0) if reverse

    with the law T(twist, rate) as it is without the effect and its gap g: lost motion of the gear, or 0.  The change comes in
    slowly beyond it, half of it at x_0.  Damping stays.  The elastic torque depends on the twist alone, so no energy is made.

    Source: catalogues and tests of harmonic drives report loops of different slope in both senses, e.g. Tuttle, Seering,
    IEEE Trans. Robotics and Automation 12 (1996) 368; the form is our own.  It is StiffnessAsymmetry for a data sheet
    that was measured in one sense.  Leaves out that lost motion may differ as well.
    """

    change: float = parameter("1", "a, share by which that sense is stiffer", low=-0.8, high=2.0, typical=(-0.5, 0.5))
    onset_twist: float = parameter("rad", "x_0, twist that brings half of the change", default=1e-5, above=0.0, typical=(1e-6, 1e-3))
    side: str = option("'forward' (driving) or 'reverse' (driven back): the sense that is changed", default="reverse")

    family: ClassVar[str] = "stiffness_asymmetry"
    signature: ClassVar[str] = "twist and resonance as expected in one sense of load, off in the other"
    starts: ClassVar[Mapping[str, tuple[str, ...]]] = {"side": ("forward", "reverse")}

    def check(self) -> None:
        if self.side not in ("forward", "reverse"):
            raise ParameterError(f"OneSidedStiffness.side = {self.side!r}: must be 'forward' or 'reverse'.")

    def changed_beyond(self, law: Callable[[Value, Value], Value], gap: float) -> Callable[[Value, Value], Value]:
        sense = 1.0 if self.side == "forward" else -1.0

        def torque(twist: Value, rate: Value) -> Value:
            beyond = np.maximum(sense * twist - 0.5 * gap, 0.0)
            return law(twist, rate) + self.change * beyond / (beyond + self.onset_twist) * law(twist, 0.0)

        return torque
