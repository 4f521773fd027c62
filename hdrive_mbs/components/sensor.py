"""A sensor that reads a quantity of the scene."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.components.reader import Reader
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import option


@dataclass(frozen=True, kw_only=True)
class Sensor(Reader):
    """reading = gain x + offset, rounded to whole steps of the resolution.

    x is a quantity of the scene (``load.speed``, ``gear.torque``, another sensor); the reading is the
    channel that has the sensor's name.  The part has no flange and does not act on the train.
    Leaves out bandwidth, sampling and noise: add noise to a record where it is studied.
    """

    quantity: str = option("name of the channel that is read")

    @property
    def seen(self) -> str:
        return self.quantity

    def build(self, name: str, draft: Draft) -> None:
        self.read(name, self.quantity, draft)
