"""A sensor with a wrong gain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.sensor_effect import SensorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SensorGain(SensorEffect):
    """A reading that is off by a factor.

    seen = (1 + g) x

    Source: calibration error of first order.  Leaves out a curved characteristic.
    """

    error: float = parameter("1", "g, share by which the reading is too large", low=-0.95, high=10.0, typical=(-0.2, 0.2))

    family: ClassVar[str] = "sensor_gain"
    signature: ClassVar[str] = "one channel off by a constant factor while all others fit"

    def reading(self, time: Value, value: Value) -> Value:
        return (1.0 + self.error) * value
