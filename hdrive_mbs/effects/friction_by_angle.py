"""Dry friction that changes over a turn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.angle_friction import AngleFriction
from hdrive_mbs.effects.harmonics import harmonics
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class FrictionByAngle(AngleFriction):
    """Dry friction of a body whose size depends on its angle, by up to three harmonics of the turn.

    tau = -tanh(w/w_0) (T + sum(A_k sin(k a + p_k))),  k = 1, 2, 3

    with the true angle a of the body and its speed w in the same sense.

    Source: friction of robot joints by position, e.g. Armstrong-Helouvry, Control of Machines with Friction (1991).
    Leaves out presliding and the load.  Where the sum is below zero the effect drives, which the friction of the model must outweigh.
    """

    mean: float = parameter("N m", "T", default=0.0, low=0.0, high=1e3, typical=(1e-4, 20.0))
    once: float = parameter("N m", "A_1, once per turn, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 20.0))
    once_phase: float = parameter("rad", "p_1, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    twice: float = parameter("N m", "A_2, twice per turn, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 20.0))
    twice_phase: float = parameter("rad", "p_2, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    thrice: float = parameter("N m", "A_3, thrice per turn, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 20.0))
    thrice_phase: float = parameter("rad", "p_3, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))

    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("once", "once_phase"), ("twice", "twice_phase"), ("thrice", "thrice_phase"))
    signature: ClassVar[str] = "torque against the motion that comes and goes with the angle, at every speed and in both senses"

    def size(self, angle: Value) -> Value:
        parts = (self.once, self.once_phase), (self.twice, self.twice_phase), (self.thrice, self.thrice_phase)
        return self.mean + harmonics(angle, 1.0, parts)
