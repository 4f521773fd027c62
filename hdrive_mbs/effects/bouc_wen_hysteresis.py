"""Hysteresis of a flexspline or coupling, smooth (Bouc-Wen)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import MemoryTwistEffect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE, followed_share, mixed
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class BoucWenHysteresis(MemoryTwistEffect):
    """Rate-independent hysteresis beside the elastic torque of a connection.

    tau = T_h z,  dz/dt = (v / x_y) (1 - |z|^n (b sign(v z) + 1 - b))

    with the rate of twist v.  The torque saturates at T_h; after each reversal from
    there it adds 2 b T_h/x_y to the stiffness.

    Source: Bouc 1967; Wen, J. Engineering Mechanics Division ASCE 102 (1976) 249, normalised as in
    Ikhouane, Rodellar, Systems with Hysteresis (Wiley 2007).  For b >= 1/2 it is passive with the
    stored energy T_h x_y z^2/2 (heat T_h |z|^n (b |v z| + (1 - b) v z)); below it is not, so it is refused.
    Leaves out the dependence on load and speed; small inner loops do not close (Maxwell slip does).
    Where the twist passes x_y faster than at the rate f it slides steadily (fast_sliding.py).
    """

    torque_limit: float = parameter("N m", "T_h, largest hysteresis torque", low=0.0, high=1e3, typical=(0.05, 50.0))
    yield_twist: float = parameter("rad", "x_y, twist over which it builds up", above=0.0, high=0.1, typical=(1e-5, 1e-2))
    exponent: float = parameter("1", "n, sharpness of the yield", default=1.0, low=1.0, high=20.0)
    shape: float = parameter("1", "b, share of the sign term (1/2: straight unloading)", default=0.5, low=0.5, high=1.0)
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    family: ClassVar[str] = "hysteresis"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "torque-twist loop of a width that does not depend on speed; loss per cycle, stiffer after each reversal"

    def states(self) -> Mapping[str, str]:
        return {"z": "1"}

    def state_rate(self, name: str, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        z = state["z"]
        slip = np.abs(z) ** self.exponent * (self.shape * np.sign(rate * z) + (1.0 - self.shape))
        return self._share(rate) * rate / self.yield_twist * (1.0 - slip)

    def _share(self, rate: Value) -> Value:
        return followed_share(self.exponent * np.abs(rate) / self.yield_twist, self.fastest_rate)

    def torque(self, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        return self.torque_limit * mixed(self._share(rate), state["z"], 1.0, rate)

    def stored(self, state: Mapping[str, Value]) -> Value:
        return 0.5 * self.torque_limit * self.yield_twist * state["z"] * state["z"]
