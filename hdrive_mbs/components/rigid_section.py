"""A rigid piece of shaft: joins a bearing to a rotor that lies close to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class RigidSection(Component):
    """Two places that move as one body, a length apart: x_b = x_a + L theta, y_b = y_a - L psi.

    Source: seed M Fig. 2(b), the bearing merged with a rotor.  Good while L^2/(E I) times the stiffness of
    what sits at its ends is small.
    """

    length: float = parameter("m", "distance from a to b along the axis", above=0.0)

    entry: ClassVar[str] = "a"
    exit: ClassVar[str] = "b"
    rigid: ClassVar[bool] = True

    def flanges(self) -> tuple[Flange, ...]:
        return (Flange(name="a", lateral=True), Flange(name="b", lateral=True, axial=self.length))

    def relations(self) -> tuple[dict[str, float], ...]:
        return ({"a": 1.0, "b": -1.0},)
