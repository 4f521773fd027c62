"""A sensor that reads a quantity of the scene."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.components.component import Component
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class Sensor(Component):
    """reading = gain x + offset, rounded to whole steps of the resolution.

    x is a quantity of the scene (``load.speed``, ``gear.torque``, another sensor); the reading is the
    channel that has the sensor's name.  The part has no flange and does not act on the train.
    Leaves out bandwidth, sampling and noise: add noise to a record where it is studied.
    """

    quantity: str = option("name of the channel that is read")
    gain: float = parameter("1", "reading per quantity", default=1.0)
    offset: float = parameter("1", "reading at zero, in units of the reading", default=0.0)
    resolution: float = parameter("1", "step of the reading, in units of the reading; 0 for none", default=0.0, low=0.0)
    unit: str | None = option("unit of the reading where the gain changes it (that of the quantity if not given)", default=None)

    def check(self) -> None:
        if self.gain == 0.0:
            raise ParameterError(f"Sensor.gain = 0 reads nothing of {self.quantity!r}; give the reading per quantity.")

    def reading(self, value: Value) -> Value:
        """The reading for a value of the quantity."""
        raw = self.gain * value + self.offset
        if self.resolution == 0.0:
            return raw
        return self.resolution * np.floor(raw / self.resolution + 0.5)

    def build(self, name: str, draft: Draft) -> None:
        draft.add_reading(name, self.quantity, self.reading, unit=self.unit, scaled=self.gain != 1.0)
