"""The torsion spring of the flexspline: three stiffnesses, lost motion, and what may differ from that."""

from __future__ import annotations

import math
from typing import NamedTuple

from benchmarks.withheld.plant.compiled import compiled


class GearSpring(NamedTuple):
    """T(twist) = B(ahead) - B(behind) (1 + a (behind/(behind + x_a))^p), ahead = r(twist - g/2), behind = r(-twist - g/2)

    B(x) = K1 z + (K2 - K1) r(z - x1) + (K3 - K2) r(z - x2) + q K1 z exp(-(z / x_q)^2),  z = x^2/(x + x_e)

    r is a ramp, sharp or a hyperbola of the given width.  All but K and the gap is zero at the nominal bench.
    """

    first: float  # N m/rad, K1
    second: float
    third: float
    first_end: float  # rad beyond the gap, x1
    second_end: float
    half_gap: float  # rad, g/2
    corner: float = 0.0  # rad, width of the ramps at x1 and x2
    edge: float = 0.0  # rad, width of the ramps at the gap
    entry: float = 0.0  # rad, x_e: contact that builds up like a soft layer
    asymmetry: float = 0.0  # 1, a
    asymmetry_twist: float = 1.0  # rad, x_a
    asymmetry_power: float = 1.0  # 1, p
    bulge: float = 0.0  # 1, q
    bulge_twist: float = 1.0  # rad, x_q
    modulation: float = 0.0  # 1, part of K1 that changes with the angle of the wave generator
    modulation_order: float = 0.0
    modulation_phase: float = 0.0


def gear_spring(values: dict[str, float]) -> GearSpring:
    """The spring of the data sheet: T1 and T2 are torques, so the corners follow from the stiffnesses."""
    first = values["T1"] / values["K1"]
    second = first + (values["T2"] - values["T1"]) / values["K2"]
    return GearSpring(values["K1"], values["K2"], values["K3"], first, second, 0.5 * values["lost_motion"])


@compiled
def ramp(x, width):
    """max(x, 0), or the hyperbola (x + sqrt(x^2 + width^2))/2 beside it."""
    if width == 0.0:
        return max(x, 0.0)
    return 0.5 * (x + math.sqrt(x * x + width * width))


@compiled
def branch(x, s):
    """Torque of one sense at the twist x >= 0 beyond the gap."""
    if s.entry > 0.0:
        x = x * x / (x + s.entry)
    torque = s.first * x
    torque += (s.second - s.first) * (ramp(x - s.first_end, s.corner) - ramp(-s.first_end, s.corner))
    torque += (s.third - s.second) * (ramp(x - s.second_end, s.corner) - ramp(-s.second_end, s.corner))
    if s.bulge != 0.0:
        torque += s.bulge * s.first * x * math.exp(-((x / s.bulge_twist) ** 2))
    return torque


@compiled
def spring_torque(twist, s):
    """T without the part that changes with the angle."""
    ahead = ramp(twist - s.half_gap, s.edge)
    behind = ramp(-twist - s.half_gap, s.edge)
    back = branch(behind, s)
    if s.asymmetry != 0.0:
        back *= 1.0 + s.asymmetry * (behind / (behind + s.asymmetry_twist)) ** s.asymmetry_power
    return branch(ahead, s) - back


@compiled
def modulated(twist, angle, s):
    """(torque, dV/d angle) of the stored energy V = m K1 sin(n angle + p) x^2/2 with x the twist beyond the gap."""
    if s.modulation == 0.0:
        return 0.0, 0.0
    x = max(twist - s.half_gap, 0.0) - max(-twist - s.half_gap, 0.0)
    size = s.modulation * s.first
    inside = s.modulation_order * angle + s.modulation_phase
    return size * math.sin(inside) * x, 0.5 * size * s.modulation_order * math.cos(inside) * x * x
