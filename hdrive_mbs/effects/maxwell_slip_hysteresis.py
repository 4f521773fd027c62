"""Hysteresis of a flexspline or coupling from elements that stick and slip (Maxwell slip)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import MemoryTwistEffect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.effects.slider import Slider
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter, table


@dataclass(frozen=True, kw_only=True)
class MaxwellSlipHysteresis(MemoryTwistEffect):
    """Springs in parallel, each behind a dry slider, beside the elastic torque of a connection.

    tau = sum(T_i),  dT_i/dt = k_i v (1 - s_i),  s_i = max((|T_i| - (1 - r) L_i) / (r L_i), 0) where v T_i > 0, else 0

    with the rate of twist v, stiffness k_i and limit L_i of each element.  r = 0 is the sharp law: an
    element follows the twist until |T_i| = L_i and then slips; loops then obey Masing's rules
    exactly.  r > 0 rounds the corner (by less than r L_i), which costs adaptive solvers fewer
    rejected steps; multistep solvers can get stuck on the sharp corner.

    Source: Iwan, J. Applied Mechanics 33 (1966) 893; Al-Bender, Lampaert, Swevers, IEEE Trans.
    Automatic Control 50 (2005) 1883.  Leaves out the dependence on speed and load.  Up to four
    elements run without a Python callback.  Sliding faster than at the rate f is as
    in fast_sliding.py, with rounded corners that take 1/f or more; sharp ones are for solvers with error control.
    """

    stiffness: tuple[float, ...] = table("N m/rad", "stiffness k_i of each element", low=0.0, typical=(1e2, 1e5))
    torque_limit: tuple[float, ...] = table("N m", "torque L_i at which each element slips", low=0.0, high=1e3, typical=(0.05, 20.0))
    rounding: float = parameter("1", "r, part of the limit over which the corner is rounded", default=0.1, low=0.0, high=1.0)
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    family: ClassVar[str] = "hysteresis"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = (
        "torque-twist loop that does not depend on speed, with closed inner loops; return paths are the virgin curve doubled"
    )
    starts: ClassVar[Mapping[str, tuple[tuple[float, ...], ...]]] = {
        "stiffness": ((1e4, 3e3, 1e3),),
        "torque_limit": ((0.5, 0.5, 0.5),),
    }

    def check(self) -> None:
        if len(self.stiffness) != len(self.torque_limit) or not self.stiffness:
            raise ParameterError(
                f"MaxwellSlipHysteresis has {len(self.stiffness)} values of stiffness and {len(self.torque_limit)} of torque_limit; "
                "each element needs one of both, and there must be at least one."
            )

    def _elements(self) -> dict[str, tuple[Slider, float]]:
        """Each element that can carry torque, with its limit."""
        pairs = enumerate(zip(self.stiffness, self.torque_limit, strict=True), start=1)
        return {
            f"torque_{k}": (Slider(stiffness, self.rounding, self.fastest_rate), limit)
            for k, (stiffness, limit) in pairs
            if stiffness > 0.0 and limit > 0.0
        }

    def states(self) -> Mapping[str, str]:
        return dict.fromkeys(self._elements(), "N m")

    def state_rate(self, name: str, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        slider, limit = self._elements()[name]
        return slider.state_rate(state[name], limit, rate)

    def torque(self, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        return sum(slider.torque(state[name], limit, rate) for name, (slider, limit) in self._elements().items())

    def stored(self, state: Mapping[str, Value]) -> Value:
        return sum(slider.stored(state[name]) for name, (slider, _) in self._elements().items())
