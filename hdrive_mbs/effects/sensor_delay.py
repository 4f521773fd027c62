"""A sensor whose reading comes late."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.effects.sensor_effect import MemorySensorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SensorDelay(MemorySensorEffect):
    """Dead time of a sensor (transmission, sampling), as an all-pass of second order.

    seen = x - y_2,  t dy_1/dt = y_2,  t dy_2/dt = 12 (x - y_1) - 6 y_2

    which has the transfer function (1 - t s/2 + t^2 s^2/12)/(1 + t s/2 + t^2 s^2/12): amplitudes as they are, the
    phase of a delay t to within (w t)^5/720 rad.  A steady ramp comes exactly t late.

    Source: Pade approximation of exp(-t s), Golub, Van Loan, Matrix Computations, 11.3.  Leaves out steps (they are
    answered with an undershoot within t) and that it starts at zero whatever x is then.  A delay of zero changes
    nothing.  The states settle at sqrt(12)/t; where that is faster than f, too fast for fixed steps, t in their rates is
    held at t_f = sqrt(12)/f and, with q = t/t_f, seen = x - (3 q^2 - 2 q) y_2 - 6 q (1 - q) (x - y_1), which has the same
    first and second power of s as exp(-t s).
    """

    delay: float = parameter("s", "t", low=0.0, high=1.0, typical=(5e-5, 0.02))
    fastest_rate: float = parameter("1/s", "f, rate up to which the states are followed", default=FASTEST_RATE, above=0.0)

    family: ClassVar[str] = "sensor_delay"
    signature: ClassVar[str] = "one channel late against all others by the same time at every frequency"

    def states(self) -> Mapping[str, str]:
        return {"late": "1", "slope": "1"} if self.delay > 0.0 else {}

    def state_rate(self, name: str, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        if name == "late":
            return state["slope"] / self._held
        return (12.0 * (value - state["late"]) - 6.0 * state["slope"]) / self._held

    @property
    def _held(self) -> float:
        return max(self.delay, math.sqrt(12.0) / self.fastest_rate)

    def reading(self, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        if self.delay == 0.0:
            return value
        q = self.delay / self._held
        if q == 1.0:
            return value - state["slope"]
        return value - (3.0 * q * q - 2.0 * q) * state["slope"] - 6.0 * q * (1.0 - q) * (value - state["late"])
