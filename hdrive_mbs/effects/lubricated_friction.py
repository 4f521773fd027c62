"""Friction of lubricated contacts, smooth through zero speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.effects.hess_soom import hess_soom
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LubricatedFriction(TorqueEffect):
    """Sliding torque with a slow Stribeck drop and unequal senses, without presliding: it rises with the speed from zero.

    tau = -tanh(w/w_0) L(w),  L(w) = T_C (1 + a sign(w)) (1 + d/(1 + |w/w_S|^p))

    Source: Hess, Soom, J. Tribology 112 (1990) 147, who measured no hysteresis over the angle in lubricated line contacts, with sign(w)
    regularised by tanh.  Leaves out true sticking and presliding (PreslidingFriction), and the lag of the film behind the speed.
    """

    coulomb: float = parameter("N m", "sliding torque T_C", low=0.0, high=1e3, typical=(5e-3, 50.0))
    drop: float = parameter("1", "d, share by which breaking away takes more", default=0.0, low=0.0, high=10.0, typical=(0.02, 2.0))
    stribeck_speed: float = parameter("rad/s", "speed w_S of the drop", default=1.0, above=0.0, typical=(0.01, 20.0))
    stribeck_exponent: float = parameter("1", "p, shape of the drop", default=1.5, low=0.25, high=4.0, typical=(0.5, 2.5))
    asymmetry: float = parameter("1", "a, share by which forward friction is larger", default=0.0, low=-0.9, high=0.9, typical=(-0.3, 0.3))
    smoothing_speed: float = parameter("rad/s", "speed w_0 of the smooth step through zero", default=0.01, above=0.0, typical=(1e-3, 3.0))

    family: ClassVar[str] = "friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "torque against the motion that turns over with the speed, larger at low speed and in one sense"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"smoothing_speed": (0.01, 0.3), "stribeck_speed": (0.1, 5.0)}

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        size = hess_soom(
            speed,
            coulomb=self.coulomb,
            drop=self.drop,
            stribeck_speed=self.stribeck_speed,
            exponent=self.stribeck_exponent,
            asymmetry=self.asymmetry,
        )
        return -np.tanh(speed / self.smoothing_speed) * size
