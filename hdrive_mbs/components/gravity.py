"""Gravity on everything that moves laterally."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.components.component import Component
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class Gravity(Component):
    """Weight of rotors, rings, housings and shafts with mass; by default along -y, which is down.

    An eccentric rotor also feels m g e cos(phi) about its axis.  First order in tilts and eccentricity; of gravity
    along the axis only the force is kept, not the moments it has on what tilts or is eccentric.
    """

    x: float = parameter("m/s^2", "acceleration in x", default=0.0)
    y: float = parameter("m/s^2", "acceleration in y", default=-9.80665)
    z: float = parameter("m/s^2", "acceleration along the axis", default=0.0)

    def build(self, name: str, draft: Draft) -> None:
        draft.set_gravity((self.x, self.y, self.z))
