"""A sensor with an offset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.sensor_effect import SensorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SensorOffset(SensorEffect):
    """A reading with a constant added.

    seen = x + b

    Source: zero error of a sensor.  Leaves out its drift with temperature.
    """

    offset: float = parameter("1", "b, in the unit of the quantity", low=-1e9, high=1e9, typical=(-1.0, 1.0))

    family: ClassVar[str] = "sensor_offset"
    signature: ClassVar[str] = "one channel off by a constant while all others fit"

    def reading(self, time: Value, value: Value) -> Value:
        return value + self.offset
