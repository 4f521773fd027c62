"""Friction of lubricated contacts, smooth through zero speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.effects.hess_soom import SPEED_STARTS, HessSoomSliding
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LubricatedFriction(HessSoomSliding, TorqueEffect):
    """Sliding torque with a slow Stribeck drop and unequal senses, without presliding: it rises with the speed from zero.

    tau = -tanh(w/w_0) L(w),  L(w) = T_C (1 + a tanh(w/w_a)) (1 + d/(1 + |w/w_S|^p))

    Source: the drop of Hess, Soom, J. Tribology 112 (1990) 147 (there p = 2), with sign(w) regularised by tanh as in
    CoulombStribeckFriction.  Leaves out true sticking and presliding (PreslidingFriction), and that the friction of a film
    lags behind the speed, which those authors measured.
    """

    smoothing_speed: float = parameter("rad/s", "speed w_0 of the smooth step through zero", default=0.01, above=0.0, typical=(1e-3, 3.0))

    family: ClassVar[str] = "friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "torque against the motion that turns over with the speed, larger at low speed and in one sense"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"smoothing_speed": (0.01, 0.3), **SPEED_STARTS}

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -np.tanh(speed / self.smoothing_speed) * self.sliding_torque(speed)
