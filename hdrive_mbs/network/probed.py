"""What a displacement probe looks at: a place of a rotor line, along a direction across the axis."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

DIRECTIONS: Mapping[str, tuple[float, bool]] = {
    "x": (0.0, False),
    "y": (0.5 * math.pi, False),
    "across_x": (0.0, True),
    "across_y": (0.5 * math.pi, True),
}
"""Last part of a channel's name -> direction of that displacement, from x towards y [rad], and whether a housing is taken off."""


@dataclass(frozen=True)
class Probed:
    """What a probe looks at.

    place : whose displacement is seen;  direction : along which, from x towards y [rad]
    relative : whether it is that of the ring of a bearing against its housing
    """

    place: str
    direction: float
    relative: bool = False

    @property
    def channels(self) -> tuple[str, str]:
        """The displacements in x and y that it is made of."""
        across = "across_" if self.relative else ""
        return f"{self.place}.{across}x", f"{self.place}.{across}y"

    def __str__(self) -> str:
        at = f"{math.degrees(self.direction):g} deg from x towards y"
        return f"{self.place}{' against its housing' if self.relative else ''} at {at}"


def probed(quantity: str, places: Collection[str], others: Mapping[str, Probed]) -> Probed | None:
    """What a channel looks at; None for one that is no displacement of a place across the axis.

    places : that there are;  others : channels that are displacements along a direction of their own
    """
    place, _, name = quantity.rpartition(".")
    if name in DIRECTIONS and place in places:
        return Probed(place, *DIRECTIONS[name])
    found = others.get(quantity)
    return found if found is not None and found.place in places else None
