"""A place where flanges are rigidly connected."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.network.rigid_mass import NOTHING, RigidMass


@dataclass(frozen=True)
class Node:
    """A place where flanges are rigidly connected.

    inertia : about the axis, of all parts there [kg m^2]
    lateral : whether it moves across the axis too; then ``mass`` is its body and ``position`` [m] lies on the axis
    is_rotor : a rigid body with all its couplings, not a station with small tilts
    """

    name: str
    inertia: float
    sense: int
    ratio: float
    lateral: bool = False
    mass: RigidMass = NOTHING
    is_rotor: bool = False
    position: float = 0.0
