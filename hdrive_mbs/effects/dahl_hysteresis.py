"""Hysteresis of a flexspline or coupling after Dahl: the shape of its branches is free."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.build_up import secant
from hdrive_mbs.effects.effect import MemoryTwistEffect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE, followed_share, mixed
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class DahlHysteresis(MemoryTwistEffect):
    """Rate-independent hysteresis beside the elastic torque of a connection, with Dahl's exponent.

    tau = T_h z,  dz/dt = (v/x_y) D,  D = |1 - u|^n sign(1 - u),  u = z sign(v)

    with the rate of twist v.  n = 1 is Bouc and Wen's law with a sign term of 1; the larger n, the softer the way to the
    limit T_h, as of many sliders that slip one after the other.  With the stored energy T_h x_y z^2/2 the heat is
    T_h |v| u (1 - D), which is never negative.  Where the twist passes x_y faster than at the rate f it is as in
    fast_sliding.py.

    Source: Dahl, AIAA Journal 14 (1976) 1675, there for ball bearings; used for the torque-twist loop of harmonic drives
    by Taghirad, Belanger, ASME J. Dyn. Syst. Meas. Control 120 (1998) 439 as a hysteresis of first order.  Leaves out the
    dependence on load and speed; small inner loops do not close (Maxwell slip does).
    """

    torque_limit: float = parameter("N m", "T_h, largest hysteresis torque", low=0.0, high=1e3, typical=(0.05, 50.0))
    yield_twist: float = parameter(
        "rad", "x_y, T_h over the stiffness after a reversal from rest", above=0.0, high=0.1, typical=(1e-5, 1e-2)
    )
    exponent: float = parameter("1", "n, shape of the branches", default=1.5, low=0.5, high=4.0, typical=(1.0, 3.0))
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    family: ClassVar[str] = "hysteresis"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "torque-twist loop of a width that does not depend on speed, with branches that bend over a long way"

    def states(self) -> Mapping[str, str]:
        return {"z": "1"}

    def state_rate(self, name: str, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        left = 1.0 - state[name] * np.sign(rate)
        return self._share(rate, state[name]) * rate / self.yield_twist * left * secant(left, self.exponent)

    def _share(self, rate: Value, z: Value) -> Value:
        slope = self.exponent * secant(1.0 - z * np.sign(rate), self.exponent)
        return followed_share(slope * np.abs(rate) / self.yield_twist, self.fastest_rate)

    def torque(self, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        return self.torque_limit * mixed(self._share(rate, state["z"]), state["z"], 1.0, rate)

    def stored(self, state: Mapping[str, Value]) -> Value:
        return 0.5 * self.torque_limit * self.yield_twist * state["z"] * state["z"]
