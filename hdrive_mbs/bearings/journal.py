"""Plain journal bearing: short-bearing theory."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.bearings.law import RelativeMotion
from hdrive_mbs.bearings.radial import RadialBearing
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter

_REST = 1e-15
"""Drift over clearance [1/s] below which the film is that of a journal at rest (keeps derivatives finite)."""


@dataclass(frozen=True, kw_only=True)
class JournalBearing(RadialBearing):
    """Oil film of a short plain bearing, half of it cavitated; exact for any motion of the journal.

    F = C/w^3 [(A + u/(1 + u^2)) s + (|s|/w) (3 (1 + A u) - 1/(1 + u^2)) (x, y)/c],  C = mu R L^3/(2 c^3)

    with the drift s = (2 vx + W y, 2 vy - W x) at the spin speed W, w^2 = 1 - (x^2 + y^2)/c^2,
    u = s.(x, y)/(|s| c w) and A = pi/2 + atan(u).  It is the integral, over the half circle about s
    where the pressure is positive, of the short-bearing solution of Reynolds's equation,
    C c^3 (s.n)/(c - x cos - y sin)^3 n dtheta.

    Source: Ocvirk (NACA TN 2808, 1952) for the pressure, Guembel's condition (no negative pressure);
    the closed form was derived for this package (one of its kind: Capone, L'Energia Elettrica 3 (1991)
    105).  Steady values as in Friswell et al., Dynamics of Rotating Machines (2010), 5.5.1.

    Leaves out the length (good for L/D up to about 0.5, far too stiff for L/D > 1), inertia, turbulence,
    heating of the oil, feed pressure and tilt, and the drag on the spin.  Beyond ``largest_eccentricity``
    the film is held as it is there and, if given, ``wall_stiffness`` carries the rest: at standstill a
    film carries nothing, and a loaded journal rests on that wall.
    """

    diameter: float = parameter("m", "journal diameter 2 R", above=0.0)
    length: float = parameter("m", "bearing length L", above=0.0)
    radial_clearance: float = parameter("m", "radial clearance c: bore radius less journal radius", above=0.0)
    viscosity: float = parameter("Pa s", "dynamic viscosity mu", above=0.0)
    largest_eccentricity: float = parameter(
        "1", "eccentricity over clearance that the film can follow", default=0.99, above=0.0, high=0.9999
    )
    wall_stiffness: float = parameter("N/m", "radial stiffness beyond it, where metal touches", default=0.0, low=0.0)

    def load_number(self, load: float, speed: float) -> float:
        """Ocvirk (modified Sommerfeld) number mu D W L^3/(8 F c^2) at a load [N] and spin speed [rad/s]."""
        return self.viscosity * self.diameter * abs(speed) * self.length**3 / (8.0 * load * self.radial_clearance**2)

    def forces(self, motion: RelativeMotion) -> Mapping[str, Value]:
        clearance, limit = self.radial_clearance, self.largest_eccentricity
        square = (motion.x**2 + motion.y**2) / clearance**2
        inside = limit / np.sqrt(np.maximum(square, limit * limit))  # 1 below the limit, then the part of x that the film sees
        drift_x = 2.0 * motion.vx + motion.speed * inside * motion.y
        drift_y = 2.0 * motion.vy - motion.speed * inside * motion.x
        drift = np.sqrt(drift_x**2 + drift_y**2 + (_REST * clearance) ** 2)
        gap = np.sqrt(1.0 - np.minimum(square, limit * limit))
        u = (2.0 / clearance) * inside * (motion.vx * motion.x + motion.vy * motion.y) / (drift * gap)  # the spin drops out of s.(x, y)
        angle = np.arctan(u)
        along = math.pi / 2.0 + angle + 0.5 * np.sin(2.0 * angle)  # u/(1 + u^2) = sin(2 angle)/2
        outward = 3.0 * (1.0 + (math.pi / 2.0 + angle) * u) - 0.5 - 0.5 * np.cos(2.0 * angle)  # 1/(1 + u^2) = (1 + cos)/2
        scale = self.viscosity * self.diameter * self.length**3 / (4.0 * clearance**3) / gap**3
        push = inside * outward * drift / gap / clearance
        film_x, film_y = scale * (along * drift_x + push * motion.x), scale * (along * drift_y + push * motion.y)
        if not self.wall_stiffness:
            return {"x": film_x, "y": film_y}
        wall = self.wall_stiffness * (1.0 - inside)
        return {"x": film_x + wall * motion.x, "y": film_y + wall * motion.y}
