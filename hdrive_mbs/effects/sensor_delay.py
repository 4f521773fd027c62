"""A sensor whose reading comes late."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

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
    nothing; one much shorter than the step of a solver with fixed steps makes it unstable.
    """

    delay: float = parameter("s", "t", low=0.0, high=1.0, typical=(5e-4, 0.02))

    family: ClassVar[str] = "sensor_delay"
    signature: ClassVar[str] = "one channel late against all others by the same time at every frequency"

    def states(self) -> Mapping[str, str]:
        return {"late": "1", "slope": "1"} if self.delay > 0.0 else {}

    def state_rate(self, name: str, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        if name == "late":
            return state["slope"] / self.delay
        return (12.0 * (value - state["late"]) - 6.0 * state["slope"]) / self.delay

    def reading(self, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        return value - state["slope"] if self.delay > 0.0 else value
