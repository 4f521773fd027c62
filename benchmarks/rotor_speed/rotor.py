"""The rotor of the comparison: data only, read by both sides, so that neither needs what the other imports.

Source: M. Friswell, J. Penny, S. Garvey, A. Lees, Dynamics of Rotating Machines (2010), example 5.9.1 (two discs on a
shaft, isotropic bearings); the bearing damping of the run-up is that of example 5.9.5.  The ramp and the unbalance are
this benchmark's own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

LENGTH = 1.5
"""m, from the bearing at one end to the bearing at the other."""
DIAMETER = 0.05
"""m, solid shaft."""
YOUNGS_MODULUS = 211e9
"""Pa."""
SHEAR_MODULUS = 81.2e9
"""Pa."""
DENSITY = 7810.0
"""kg/m^3, shaft and discs."""
BEARING_STIFFNESS = 1e6
"""N/m in each lateral direction, at both ends."""


@dataclass(frozen=True, kw_only=True)
class Disc:
    """A rigid disc bored to the shaft's diameter; position, width and diameter in m."""

    position: float
    width: float
    diameter: float

    @property
    def mass(self) -> float:
        """rho pi w (D^2 - d^2) / 4 [kg]."""
        return DENSITY * math.pi / 4.0 * self.width * (self.diameter**2 - DIAMETER**2)

    @property
    def polar_inertia(self) -> float:
        """m (D^2 + d^2) / 8 [kg m^2]."""
        return self.mass / 8.0 * (self.diameter**2 + DIAMETER**2)

    @property
    def transverse_inertia(self) -> float:
        """About a diameter through the centre: half the polar inertia + m w^2 / 12 [kg m^2]."""
        return self.polar_inertia / 2.0 + self.mass / 12.0 * self.width**2


DISCS = (Disc(position=0.5, width=0.07, diameter=0.28), Disc(position=1.0, width=0.07, diameter=0.35))

ELEMENTS = (6, 24, 48)
"""Numbers of equal elements that are compared; multiples of 3, so that both discs sit on a station."""
HIGHEST_SPEED = 4000.0 * math.pi / 30.0
"""rad/s, 4000 rpm: end of the Campbell diagram and of the ramp."""
SPEEDS = 101
"""Speeds of the Campbell diagram, from 0 in equal steps."""

RAMP_ELEMENTS = 6
RAMP_DURATION = 2.5
"""s, from rest at constant angular acceleration."""
RAMP_STEPS = 25_000
BEARING_DAMPING = 3e3
"""N s/m in each lateral direction, at both ends; in the run-up only."""
UNBALANCE = 1e-3
"""kg m, on the first disc, along x at rest."""


def disc_stations(elements: int) -> tuple[int, ...]:
    """Numbers of the stations that carry the discs, counted from 0."""
    if elements < 3 or elements % 3:
        raise ValueError(f"{elements} equal elements: the discs sit at thirds of the shaft, so use a multiple of 3.")
    return tuple(round(disc.position / LENGTH * elements) for disc in DISCS)
