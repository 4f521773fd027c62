"""A rotating inertia."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class Inertia(Component):
    """A rigid rotating mass with viscous drag:  J dw/dt = sum of torques - viscous * w.

    It only turns.  Joined to a rotor it adds to the inertia of the spin and leaves out its mass, tilt and gyroscopic
    moment, as do ``Motor`` and ``Load``; a disc that tilts with the shaft is a ``Rotor``.
    """

    inertia: float = parameter("kg m^2", "moment of inertia about the axis", above=0.0)
    viscous: float = parameter("N m s/rad", "viscous drag on the absolute speed", default=0.0, low=0.0)

    @classmethod
    def disc(cls, *, diameter: float, thickness: float, density: float, bore: float = 0.0) -> Self:
        """A (bored) disc:  J = pi rho h (D^4 - d^4) / 32.  Lengths in m, density in kg/m^3."""
        return cls(inertia=math.pi * density * thickness * (diameter**4 - bore**4) / 32.0)

    def flanges(self) -> tuple[Flange, ...]:
        return (Flange(name="", inertia=self.inertia),)

    def build(self, name: str, draft: Draft) -> None:
        add_viscous(name, self.viscous, draft)


def add_viscous(name: str, viscous: float, draft: Draft) -> None:
    """Drag -viscous * w on the body of a part (nothing for zero)."""
    if viscous == 0.0:
        return
    body = draft.body(name).name

    def drag(moment: Moment) -> object:
        return -viscous * moment.speed(body)

    draft.add_torque(f"{name}.viscous", body, drag, dissipative=True)
