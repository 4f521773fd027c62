"""Friction of Dahl: torque that builds up over an angle after each reversal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.build_up import secant
from hdrive_mbs.effects.effect import MemoryTorqueEffect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE, followed_share, mixed
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class DahlFriction(MemoryTorqueEffect):
    """Dry friction without a Stribeck drop that stores the presliding angle.

    tau = -T_C z,  dz/dt = (w / x_p) |1 - z sign(w)|^n sign(1 - z sign(w))

    z runs to sign(w); for n = 1 it does so as 1 - exp(-|angle|/x_p) from z = 0.  With the stored
    energy T_C x_p z^2/2 the heat is T_C |w| u (1 - |1 - u|^n sign(1 - u)), u = z sign(w), which is
    never negative for any n > 0.

    Source: Dahl, AIAA Journal 14 (1976) 1675.  Leaves out the Stribeck drop and every dependence on
    the size of the speed, and it creeps under small vibration (LuGreFriction has the drop).  Where the
    body turns by x_p faster than at the rate f the torque is that of steady sliding (fast_sliding.py).
    """

    coulomb: float = parameter("N m", "sliding torque T_C", low=0.0, high=1e3, typical=(5e-3, 50.0))
    presliding: float = parameter("rad", "x_p, angle over which it builds up", above=0.0, typical=(1e-4, 1.0))
    exponent: float = parameter("1", "n, shape of the build-up", default=1.0, low=0.5, high=4.0, typical=(1.0, 2.5))
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    family: ClassVar[str] = "friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = (
        "constant torque against the motion that turns over within a small angle after each reversal; hysteresis against angle"
    )
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"presliding": (5e-4, 5e-3)}

    def states(self) -> Mapping[str, str]:
        return {"z": "1"}

    def state_rate(self, name: str, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        share = self._share(speed, state["z"])
        if self.exponent == 1.0:
            return share * (speed - np.abs(speed) * state["z"]) / self.presliding
        left = 1.0 - state["z"] * np.sign(speed)
        return share * speed / self.presliding * left * secant(left, self.exponent)

    def _share(self, speed: Value, z: Value) -> Value:
        if self.exponent == 1.0:
            return followed_share(np.abs(speed) / self.presliding, self.fastest_rate)
        slope = self.exponent * secant(1.0 - z * np.sign(speed), self.exponent)
        return followed_share(slope * np.abs(speed) / self.presliding, self.fastest_rate)

    def torque(self, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return -self.coulomb * mixed(self._share(speed, state["z"]), state["z"], 1.0, speed)

    def stored(self, state: Mapping[str, Value]) -> Value:
        return 0.5 * self.coulomb * self.presliding * state["z"] * state["z"]
