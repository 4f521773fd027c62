"""A sensor with coarse steps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.sensor_effect import SensorEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class SensorQuantisation(SensorEffect):
    """A reading in whole steps.

    seen = r floor(x/r + 1/2)

    Source: rounding to the nearest step, as of an ideal converter; its error is at most r/2 and r/sqrt(12) rms.
    Leaves out missing codes and hysteresis of the converter.  A step of zero changes nothing.
    A search does not try it: its steps show in the readings themselves, and no slope leads to their height.
    """

    resolution: float = parameter("1", "r, step in the unit of the quantity", low=0.0, high=1e9)

    family: ClassVar[str] = "sensor_quantisation"
    signature: ClassVar[str] = "one channel stands on steps of equal height; noise that does not fall with filtering when at rest"

    def reading(self, time: Value, value: Value) -> Value:
        return value if self.resolution == 0.0 else self.resolution * np.floor(value / self.resolution + 0.5)
