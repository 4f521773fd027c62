"""A shaft with play: smooth penetration, damping that grows with contact, a film in the gap."""

from __future__ import annotations

from typing import NamedTuple

from benchmarks.withheld.plant.compiled import compiled
from benchmarks.withheld.plant.drive_train.springs import ramp


class Play(NamedTuple):
    """T = k (r(x - b/2) - r(-x - b/2)) + (d c + f (1 - c)) dx/dt,  c = x_c/(x_c + x_d)

    x_c is the penetration on either side, x_d the one at which half of the damping acts, f the film's
    damping.  The stored energy is that of the ramps, the rest is a positive damping: passive.
    """

    half_gap: float = 0.0  # rad, b/2
    edge: float = 0.0  # rad, width of the ramps
    engage: float = 1.0  # rad, x_d
    film: float = 0.0  # N m s/rad, f


@compiled
def shaft_torque(twist, rate, stiffness, damping, p):
    """Torque of a shaft, linear without play."""
    if p.half_gap == 0.0:
        return stiffness * twist + damping * rate
    ahead = ramp(twist - p.half_gap, p.edge)
    behind = ramp(-twist - p.half_gap, p.edge)
    contact = (ahead + behind) / (ahead + behind + p.engage)
    return stiffness * (ahead - behind) + (damping * contact + p.film * (1.0 - contact)) * rate
