"""A displacement probe that looks at a shaft from any side."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hdrive_mbs.components.reader import Reader
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.probed import Probed
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class Probe(Reader):
    """reading = gain r + offset, rounded to whole steps of the resolution;  r = x cos(a) + y sin(a)

    with the displacement x, y of the place and the direction a from the shaft to the probe, from x towards y: of two probes 45
    degrees to either side of the vertical, y up, the one towards +x has 45 degrees and the other 135.  The channel
    ``<probe>.displacement`` is r, the one with the probe's name the reading; a gap, which shrinks when the shaft comes
    nearer, is read with a negative gain.  Effects on sensors, probes and surfaces take it like a ``Sensor`` of x or y.

    Source: geometry; probes in pairs at right angles, API Standard 670.  Leaves out the curvature of the surface.
    Raises ParameterError for a gain of 0.
    """

    at: str = option("place whose displacement is read, of a rotor line")
    angle: float = parameter("rad", "a, direction from the shaft to the probe, from x towards y", low=-2.0 * math.pi, high=2.0 * math.pi)
    relative: bool = option(
        "whether it sits on the housing of the bearing there: r is then that of the ring less the housing", default=False
    )

    @property
    def seen(self) -> str:
        return self.at

    def build(self, name: str, draft: Draft) -> None:
        quantity = f"{name}.displacement"
        draft.add_probed(quantity, Probed(self.at, self.angle, self.relative), asked_by=repr(name))
        self.read(name, quantity, draft)
