"""What sensors of all kinds do with the quantity that they see."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.components.component import Component
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class Reader(Component, ABC):
    """reading = gain x + offset, rounded to whole steps of the resolution.

    The reading is the channel that has the sensor's name.  The part has no flange and does not act on the train.
    Leaves out bandwidth, sampling and noise: add noise to a record where it is studied.
    """

    gain: float = parameter("1", "reading per quantity", default=1.0)
    offset: float = parameter("1", "reading at zero, in units of the reading", default=0.0)
    resolution: float = parameter("1", "step of the reading, in units of the reading; 0 for none", default=0.0, low=0.0)
    unit: str | None = option("unit of the reading where the gain changes it (that of the quantity if not given)", default=None)

    @property
    @abstractmethod
    def seen(self) -> str:
        """What it looks at, for messages."""

    def check(self) -> None:
        if self.gain == 0.0:
            raise ParameterError(f"{type(self).__name__}.gain = 0 reads nothing of {self.seen!r}; give the reading per quantity.")

    def reading(self, value: Value) -> Value:
        """The reading for a value of the quantity."""
        raw = self.gain * value + self.offset
        if self.resolution == 0.0:
            return raw
        return self.resolution * np.floor(raw / self.resolution + 0.5)

    def read(self, name: str, quantity: str, draft: Draft) -> None:
        """Add the reading of a channel to the network."""
        draft.add_reading(name, quantity, self.reading, unit=self.unit, scaled=self.gain != 1.0)
