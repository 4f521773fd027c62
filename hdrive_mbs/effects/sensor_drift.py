"""A sensor whose zero drifts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.sensor_effect import SensorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SensorDrift(SensorEffect):
    """A reading with an offset that comes in the course of a record.

    seen = x + b (1 - exp(-t/h))

    with the time t of the run.  For h far longer than the record it is a straight drift by b/h.

    Source: amplifier of one heat capacity that warms after it is switched on (Newton's law of cooling).  Leaves out a
    drift of the gain and the temperature of the place itself.
    """

    offset: float = parameter("1", "b, in the end, in the unit of the quantity", low=-1e9, high=1e9, typical=(-1.0, 1.0))
    time_constant: float = parameter("s", "h, time in which it warms up", default=10.0, above=0.0, typical=(0.5, 1e3))

    family: ClassVar[str] = "sensor_drift"
    signature: ClassVar[str] = "one channel that creeps away from all others, in speed and standstill alike"

    def reading(self, time: Value, value: Value) -> Value:
        return value + self.offset * (1.0 - np.exp(-time / self.time_constant))
