"""Dry friction from sliders whose slip angles are spread over a ratio (generalised Maxwell slip)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import MemoryTorqueEffect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.effects.hess_soom import SPEED_STARTS, HessSoomSliding
from hdrive_mbs.effects.slider import Slider, spread_places
from hdrive_mbs.effects.slider_hysteresis import ELEMENTS
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SpreadSlipFriction(HessSoomSliding, MemoryTorqueEffect):
    """Four sliders in parallel that share the sliding torque and give way one after the other, the limits following the speed.

    tau = -sum(T_i),  L_i = L(w)/4,  x_i = x_p q^((2 i - 5)/4),  k_i = T_C/(4 x_i),  i = 1..4
    L(w) = T_C (1 + a tanh(w/w_a)) (1 + d/(1 + |w/w_S|^p))

    After a reversal the torque turns over in straight pieces, with inner loops that close (Masing's rules while L is constant): the
    reversal of one that stopped half way remembers where it began, which Dahl's law (PreslidingFriction) forgets.  The law
    of an element, with its stored energy and heat, is in slider.py; sliding faster than at the rate f is as in fast_sliding.py.

    Source: Lampaert, Swevers, Al-Bender, IEEE Trans. Automatic Control 47 (2002) 683 and Proc. American Control Conference (2003) 1639,
    with limits that follow the sliding torque at once; the drop of Hess, Soom, J. Tribology 112 (1990) 147.
    Leaves out that the sliding torque lags behind the speed, damping of the elements, load and temperature.
    """

    presliding: float = parameter("rad", "x_p, slip angle in the middle", above=0.0, typical=(1e-4, 0.1))
    spread: float = parameter(
        "1", "q, ratio of the largest slip angle to that in the middle", default=3.0, low=1.0, high=100.0, typical=(1.2, 10.0)
    )
    rounding: float = parameter("1", "part of each limit over which its corner is rounded", default=0.05, low=0.0, high=1.0)
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    family: ClassVar[str] = "friction"
    dissipative: ClassVar[bool] = True
    finer: ClassVar[bool] = True
    signature: ClassVar[str] = (
        "torque against the motion that turns over in pieces within a small angle after each reversal, with closed inner loops"
    )
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"presliding": (5e-4, 5e-3), **SPEED_STARTS, "spread": (2.5,)}

    def _sliders(self) -> dict[str, Slider]:
        if self.coulomb == 0.0:
            return {}
        stiffnesses = [self.coulomb / ELEMENTS / angle for angle in spread_places(self.presliding, self.spread, ELEMENTS)]
        return {f"torque_{k}": Slider(value, self.rounding, self.fastest_rate) for k, value in enumerate(stiffnesses, start=1)}

    def states(self) -> Mapping[str, str]:
        return dict.fromkeys(self._sliders(), "N m")

    def _limit(self, speed: Value) -> Value:
        return self.sliding_torque(speed) / ELEMENTS

    def state_rate(self, name: str, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return self._sliders()[name].state_rate(state[name], self._limit(speed), speed)

    def torque(self, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        limit = self._limit(speed)
        return -sum(slider.torque(state[name], limit, speed) for name, slider in self._sliders().items())

    def stored(self, state: Mapping[str, Value]) -> Value:
        return sum(slider.stored(state[name]) for name, slider in self._sliders().items())
