"""A connection that is stiffer in one sense of twist than in the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import LawEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class StiffnessAsymmetry(LawEffect):
    """The elastic torque of a connection, scaled by the sense of twist.

    tau = T(x, v) + a tanh(x/x_0) T(x, 0)

    with the law T(twist, rate) as it is without the effect: 1 + a times the elastic torque when
    driving, 1 - a when driven back, smooth over x_0.  Damping stays.  The elastic torque still depends
    on the twist alone, so no energy is made; up to |a| = 0.8 a law that rises goes on rising.

    Source: catalogues and tests of harmonic drives report loops of different slope in both senses,
    e.g. Tuttle, Seering, IEEE Trans. Robotics and Automation 12 (1996) 368; the form is our own.
    Leaves out that the two branches may differ in shape and in lost motion as well.
    """

    asymmetry: float = parameter("1", "a, share by which driving is stiffer", low=-0.8, high=0.8, typical=(-0.5, 0.5))
    smoothing_twist: float = parameter("rad", "twist x_0 of the smooth step through zero", default=1e-5, above=0.0, typical=(1e-6, 1e-3))

    family: ClassVar[str] = "stiffness_asymmetry"
    signature: ClassVar[str] = (
        "different slopes of the torque-twist curve in both senses; another mean twist and a resonance that moves with the sense of load"
    )

    def changed(self, law: Callable[[Value, Value], Value]) -> Callable[[Value, Value], Value]:
        def torque(twist: Value, rate: Value) -> Value:
            return law(twist, rate) + self.asymmetry * np.tanh(twist / self.smoothing_twist) * law(twist, 0.0)

        return torque
