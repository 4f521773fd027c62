"""Hysteresis from evenly spread sliders, by two numbers (Iwan)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.effects.maxwell_slip_hysteresis import MaxwellSlipHysteresis
from hdrive_mbs.effects.slider_hysteresis import ELEMENTS, SliderHysteresis
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class IwanHysteresis(SliderHysteresis):
    """Four Maxwell-slip elements of equal stiffness that slip one after the other.

    tau = sum(T_i),  k_i = 2 T_h/(4 x_s),  L_i = k_i x_s (i - 1/2)/4,  i = 1..4

    On first loading the torque follows the parabola T_h (2 s - s^2), s = x/x_s, in straight pieces: to
    within T_h/64 for sharp corners, T_h from s = 7/8 on.  Masing's rules give the rest; the law of an
    element is in MaxwellSlipHysteresis.

    Source: Iwan, J. Applied Mechanics 33 (1966) 893, with a uniform density of slip twists.
    Leaves out the dependence on speed and load; slip twists are spread evenly, which no real joint does.
    """

    torque_limit: float = parameter("N m", "T_h, torque at which everything slips", low=0.0, high=1e3, typical=(0.05, 50.0))
    slip_twist: float = parameter("rad", "x_s, twist on first loading at which everything slips", above=0.0, high=0.1, typical=(1e-5, 1e-2))
    rounding: float = parameter("1", "part of each limit over which its corner is rounded", default=0.1, low=0.0, high=1.0)
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    signature: ClassVar[str] = "torque-twist loop that does not depend on speed, with closed inner loops and parabolic branches"

    @property
    def elements(self) -> MaxwellSlipHysteresis:
        stiffness = 2.0 * self.torque_limit / (ELEMENTS * self.slip_twist)
        limits = tuple(stiffness * self.slip_twist * (k + 0.5) / ELEMENTS for k in range(ELEMENTS))
        return MaxwellSlipHysteresis(
            stiffness=(stiffness,) * ELEMENTS, torque_limit=limits, rounding=self.rounding, fastest_rate=self.fastest_rate
        )
