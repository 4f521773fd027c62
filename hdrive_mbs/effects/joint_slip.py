"""A joint that slips under too much torque: a clamp, a shrink fit, a cone, a friction coupling."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.series_effect import SeriesEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class JointSlip(SeriesEffect):
    """Twist that stays: beyond a torque the halves of a joint turn against each other.

    tau = T(x - y, v - dy/dt),  dy/dt = r sign(tau) max(|tau| - T_s, 0)/T_s

    which, with the damping d of the connection, is  dy/dt = r sign(A) max(|A| - T_s, 0)/(T_s + r d),  A = T(x - y, v).  r is the rate
    at twice the torque T_s: a large one holds the torque at T_s like a safety clutch, a small one lets it creep on.  r = 0 never slips.

    Source: Bingham's body in line with the connection (viscoplastic flow beyond a yield stress), Perzyna, Advances in Applied Mechanics 9
    (1966) 243.  Leaves out wear, static above sliding friction, and what heat does.  Behind a spring k the state settles with the time
    constant T_s/(r k) + d/k: a solver with fixed steps needs shorter ones.  One at a connection; other elements in line sit inside it.
    """

    slip_torque: float = parameter("N m", "T_s above which it slips", above=0.0, high=1e6, typical=(0.3, 300.0))
    slip_rate: float = parameter("rad/s", "r at twice that torque", low=0.0, high=1e4, typical=(1e-6, 1.0))

    acts_on: ClassVar[str] = "coupling"
    yields: ClassVar[bool] = True
    family: ClassVar[str] = "joint_slip"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"slip_torque": (0.5, 3.0, 15.0, 60.0, 200.0)}
    decisive: ClassVar[tuple[str, ...]] = ("slip_torque",)
    signature: ClassVar[str] = "twist that jumps on at peaks of torque and does not come back, while the torque itself returns"

    def at_rest(self) -> bool:
        return self.slip_rate == 0.0

    def deflection_rate(self, deflection: Value, torque: Value, damping: Value) -> Value:
        beyond = np.maximum(torque - self.slip_torque, 0.0) + np.minimum(torque + self.slip_torque, 0.0)
        return self.slip_rate * beyond / (self.slip_torque + self.slip_rate * damping)
