"""A sensor that follows with a lag."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.effects.sensor_effect import MemorySensorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SensorLag(MemorySensorEffect):
    """A filter of first order in front of a sensor.

    seen = y,  dy/dt = (x - y)/t

    Source: low-pass of first order; its cut-off frequency is 1/t.  Leaves out that it starts at y = 0 whatever x is
    then, and filters of higher order.  A time constant of zero changes nothing.  One shorter than 1/f, too fast for fixed
    steps, is replaced by y with 1/f in place of t and seen = f t y + (1 - f t) x: slow motion comes late by t all the same.
    """

    time_constant: float = parameter("s", "t", low=0.0, high=10.0, typical=(5e-5, 0.05))
    fastest_rate: float = parameter("1/s", "f, rate up to which the lag is followed", default=FASTEST_RATE, above=0.0)

    family: ClassVar[str] = "sensor_delay"
    signature: ClassVar[str] = "one channel late against all others, and smoother: fast motion comes out smaller"

    def states(self) -> Mapping[str, str]:
        return {"lagged": "1"} if self.time_constant > 0.0 else {}

    def state_rate(self, name: str, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        return (value - state["lagged"]) * (self._share / self.time_constant)

    @property
    def _share(self) -> float:
        return min(1.0, self.time_constant * self.fastest_rate)

    def reading(self, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        if self.time_constant == 0.0:
            return value
        return state["lagged"] if self._share == 1.0 else self._share * state["lagged"] + (1.0 - self._share) * value
