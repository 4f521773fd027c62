"""A sensor that follows with a lag."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.sensor_effect import MemorySensorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SensorLag(MemorySensorEffect):
    """A filter of first order in front of a sensor.

    seen = y,  dy/dt = (x - y)/t

    Source: low-pass of first order; its cut-off frequency is 1/t.  Leaves out that it starts at y = 0 whatever x is
    then, and filters of higher order.  A time constant of zero changes nothing.
    """

    time_constant: float = parameter("s", "t", low=0.0, high=10.0, typical=(5e-4, 0.05))

    family: ClassVar[str] = "sensor_delay"
    signature: ClassVar[str] = "one channel late against all others, and smoother: fast motion comes out smaller"

    def states(self) -> Mapping[str, str]:
        return {"lagged": "1"} if self.time_constant > 0.0 else {}

    def state_rate(self, name: str, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        return (value - state["lagged"]) / self.time_constant

    def reading(self, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        return state["lagged"] if self.time_constant > 0.0 else value
