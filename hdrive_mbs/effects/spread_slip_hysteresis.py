"""Hysteresis from sliders whose slip twists are spread over a ratio."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.effects.maxwell_slip_hysteresis import MaxwellSlipHysteresis
from hdrive_mbs.effects.slider import spread_places
from hdrive_mbs.effects.slider_hysteresis import ELEMENTS, SliderHysteresis
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SpreadSlipHysteresis(SliderHysteresis):
    """Four Maxwell-slip elements of equal limit whose slip twists grow by a constant factor.

    tau = sum(T_i),  L_i = T_h/4,  x_i = x_s q^((2 i - 5)/4),  k_i = L_i/x_i,  i = 1..4

    The slip twists reach from about x_s/q to x_s q: small sliders slip at once, others only at large twists.  Masing's
    rules hold; the law of an element is in MaxwellSlipHysteresis.

    Source: Iwan, J. Applied Mechanics 33 (1966) 893, with a density of slip twists that is even over their logarithm.
    Leaves out the dependence on speed and load.
    """

    torque_limit: float = parameter("N m", "T_h, torque at which everything slips", low=0.0, high=1e3, typical=(0.05, 50.0))
    slip_twist: float = parameter("rad", "x_s, slip twist in the middle", above=0.0, high=0.1, typical=(1e-5, 1e-2))
    spread: float = parameter(
        "1", "q, ratio of the largest slip twist to that in the middle", default=3.0, low=1.0, high=100.0, typical=(1.2, 10.0)
    )
    rounding: float = parameter("1", "part of each limit over which its corner is rounded", default=0.05, low=0.0, high=1.0)
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    signature: ClassVar[str] = "torque-twist loop that does not depend on speed, with closed inner loops and corners that are drawn out"

    @property
    def elements(self) -> MaxwellSlipHysteresis:
        limit = self.torque_limit / ELEMENTS
        places = spread_places(self.slip_twist, self.spread, ELEMENTS)
        return MaxwellSlipHysteresis(
            stiffness=tuple(limit / place for place in places),
            torque_limit=(limit,) * ELEMENTS,
            rounding=self.rounding,
            fastest_rate=self.fastest_rate,
        )
