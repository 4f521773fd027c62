"""A sensor while the network is being built."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hdrive_mbs.expression import Value
from hdrive_mbs.network.channels import Reading
from hdrive_mbs.network.moment import Moment


@dataclass
class SensorDraft:
    """A sensor that effects may still disturb.

    ``source`` is the quantity that it reads, ``seen`` what reaches it of that (effects replace it),
    ``change`` makes the reading from what is seen.
    """

    name: str
    source: Reading
    change: Callable[[Value], Value]
    unit: str
    seen: Callable[[Moment], Value]

    def reading(self, moment: Moment) -> Value:
        """What the sensor shows."""
        return self.change(self.seen(moment))

    def true_reading(self, moment: Moment) -> Value:
        """What it would show undisturbed."""
        return self.change(self.source(moment))
