"""Dry friction in one law: Stribeck drop, unequal senses, torque that builds up over an angle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.build_up import secant
from hdrive_mbs.effects.effect import MemoryTorqueEffect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE, followed_share, mixed
from hdrive_mbs.effects.hess_soom import SPEED_STARTS, HessSoomSliding
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class PreslidingFriction(HessSoomSliding, MemoryTorqueEffect):
    """Dahl's build-up of the torque towards a sliding torque of Stribeck's shape that may differ in both senses.

    tau = -y,  dy/dt = (T_C/x_p) w D,  D = |1 - u|^n sign(1 - u),  u = y sign(w)/L(w),
    L(w) = T_C (1 + a tanh(w/w_a)) (1 + d/(1 + |w/w_S|^p))

    y runs to L sign(w) over an angle of about x_p.  A small x_p is sliding friction without presliding, n = 1 LuGre's
    law without damping.  With the stored energy y^2 x_p/(2 T_C) the heat is |w| L u (1 - D), which is never negative.
    Sliding by x_p faster than at the rate f is as in fast_sliding.py.

    Source: Dahl, AIAA Journal 14 (1976) 1675, with the drop of Hess, Soom, J. Tribology 112 (1990) 147 (there p = 2),
    which fades more slowly than the Gauss curve of CoulombStribeckFriction.  Leaves out the damping of the bristles
    (LuGreFriction), load, temperature, and a lag of the sliding torque behind the speed.
    """

    presliding: float = parameter("rad", "x_p, angle over which the torque builds up", above=0.0, typical=(1e-4, 0.1))
    exponent: float = parameter("1", "n, shape of the build-up", default=1.0, low=0.5, high=4.0, typical=(1.0, 2.5))
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    family: ClassVar[str] = "friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = (
        "torque against the motion that turns over within a small angle after each reversal, larger at low speed and in one sense"
    )
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"presliding": (5e-4, 5e-3), **SPEED_STARTS}

    def states(self) -> Mapping[str, str]:
        return {"torque": "N m"} if self.coulomb > 0.0 else {}

    def state_rate(self, name: str, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        left = 1.0 - state[name] * np.sign(speed) / self.sliding_torque(speed)
        share = self._share(speed, state[name])
        return share * self.coulomb / self.presliding * speed * left * secant(left, self.exponent)

    def _share(self, speed: Value, torque: Value) -> Value:
        sliding = self.sliding_torque(speed)
        slope = self.exponent * secant(1.0 - torque * np.sign(speed) / sliding, self.exponent)
        return followed_share(slope * np.abs(speed) * (self.coulomb / self.presliding) / sliding, self.fastest_rate)

    def torque(self, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return -sum(mixed(self._share(speed, state[name]), state[name], self.sliding_torque(speed), speed) for name in self.states())

    def stored(self, state: Mapping[str, Value]) -> Value:
        return sum(0.5 * self.presliding / self.coulomb * state[name] * state[name] for name in self.states())
