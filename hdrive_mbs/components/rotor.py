"""A rigid rotor with static and dynamic unbalance."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Self

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.quantities import parameter
from hdrive_mbs.quantity import Quantity
from hdrive_mbs.usual_values import DENSITY, DIAMETER

_DIAMETER, _DENSITY = Quantity(unit="m", doc="of a disc", **DIAMETER), Quantity(unit="kg/m^3", doc="density", **DENSITY)


@dataclass(frozen=True, kw_only=True)
class Rotor(Component):
    """Rigid body with six degrees of freedom, its geometric centre on the shaft (seed M (2)-(4)).

    Static unbalance is mass times eccentricity; dynamic unbalance is a lean of the principal axis, with the
    moment (Jt - Jp) tilt w^2 about the axis at tilt_angle + 90 degrees.  Angles count from x towards y at
    spin angle 0 and turn with the rotor.  All couplings of bending, torsion and axial motion are kept.
    Leaves out its own elasticity.
    """

    mass: float = parameter("kg", "mass", above=0.0)
    polar_inertia: float = parameter("kg m^2", "moment of inertia about the axis, Jp", above=0.0)
    transverse_inertia: float = parameter("kg m^2", "moment of inertia about a diameter, Jt", above=0.0)
    eccentricity: float = parameter("m", "distance of the centre of mass from the axis (static unbalance)", default=0.0, low=0.0)
    angle: float = parameter("rad", "direction of the eccentricity from x towards y", default=0.0)
    tilt: float = parameter("rad", "lean of the principal axis (dynamic unbalance)", default=0.0, low=0.0, high=0.1)
    tilt_angle: float = parameter("rad", "direction towards which the principal axis leans at +z", default=0.0)

    def check(self) -> None:
        if self.polar_inertia > 2.0 * self.transverse_inertia * (1.0 + 1e-9):
            raise ParameterError(
                f"Rotor.polar_inertia = {self.polar_inertia:g} kg m^2 is more than twice transverse_inertia = "
                f"{self.transverse_inertia:g} kg m^2, which no body has (Jx + Jy >= Jz). Were the two exchanged?"
            )

    @classmethod
    def disc(cls, *, diameter: float, thickness: float, density: float, bore: float = 0.0, **unbalance: Any) -> Self:
        """A (bored) disc: m = pi rho h (D^2 - d^2)/4, Jp = m (D^2 + d^2)/8, Jt = Jp/2 + m h^2/12.  Lengths in m, density in kg/m^3.

        On a shaft with density give its diameter as the bore: else the shaft in the disc counts twice.

        Raises ParameterError for an eccentricity of more than the radius: no centre of mass lies outside of its disc.
        """
        for name, value in (("diameter", diameter), ("thickness", thickness), ("density", density)):
            if not value > 0.0:
                raise ParameterError(f"Rotor.disc {name} = {value:g}: must be greater than 0.")
        if not 0.0 <= bore < diameter:
            raise ParameterError(f"Rotor.disc bore = {bore:g} m: must be at least 0 and less than the diameter of {diameter:g} m.")
        _DIAMETER.check("Rotor.disc diameter", diameter, stacklevel=2)
        _DIAMETER.check("Rotor.disc thickness", thickness, stacklevel=2)
        _DENSITY.check("Rotor.disc density", density, stacklevel=2)
        rotor = cls._solid_disc(diameter, thickness, density, bore, unbalance)
        if rotor.eccentricity > 0.5 * diameter:
            raise ParameterError(
                f"Rotor.disc eccentricity = {rotor.eccentricity:g} m: must be at most the radius of the disc, {0.5 * diameter:g} m. "
                "It is given in m; 20 um are 20e-6 m."
            )
        return rotor

    @classmethod
    def _solid_disc(cls, diameter: float, thickness: float, density: float, bore: float, unbalance: dict[str, Any]) -> Self:
        mass = math.pi * density * thickness * (diameter**2 - bore**2) / 4.0
        polar = mass * (diameter**2 + bore**2) / 8.0
        return cls(mass=mass, polar_inertia=polar, transverse_inertia=polar / 2.0 + mass * thickness**2 / 12.0, **unbalance)

    @property
    def body(self) -> RigidMass:
        """Mass, centre of mass and inertia tensor in the frame that turns with the rotor."""
        return RigidMass.rotor(
            self.mass,
            self.polar_inertia,
            self.transverse_inertia,
            eccentricity=self.eccentricity,
            angle=self.angle,
            tilt=self.tilt,
            tilt_angle=self.tilt_angle,
        )

    def flanges(self) -> tuple[Flange, ...]:
        return (Flange(name="", lateral=True, mass=self.body, is_rotor=True),)
