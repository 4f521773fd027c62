"""What every part of a scene offers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.rigid_mass import NOTHING, RigidMass
from hdrive_mbs.quantities import Described


@dataclass(frozen=True, kw_only=True)
class Flange:
    """A place of a part that can be connected.

    name : "" for the only flange of a part, else its name ("a", "wave_generator")
    inertia : what the part adds there [kg m^2]
    optional : held by the ground when nothing is connected to it
    lateral : whether the place moves across the axis too; then ``mass`` is what the part adds there
    is_rotor : whether that mass makes the place a rigid body with all its couplings (unbalance)
    axial : distance from the part's first flange along the shaft [m]
    free : may stay unconnected (the end of a shaft that has mass)
    """

    name: str
    inertia: float = 0.0
    optional: bool = False
    lateral: bool = False
    mass: RigidMass = NOTHING
    is_rotor: bool = False
    axial: float = 0.0
    free: bool = False


@dataclass(frozen=True, kw_only=True)
class Component(Described):
    """A part of a scene.  A user's own part subclasses it and overrides what it needs."""

    _kind: ClassVar[str] = "part"
    entry: ClassVar[str] = ""
    """Flange that a chain enters by."""
    exit: ClassVar[str] = ""
    """Flange that a chain leaves by."""
    rigid: ClassVar[bool] = False
    """Whether all flanges of the part turn as one."""

    def flanges(self) -> tuple[Flange, ...]:
        """Places that can be connected."""
        return ()

    def relations(self) -> tuple[Mapping[str, float], ...]:
        """Ideal speed relations between flanges, each as  sum(c_f * speed_f) = 0  in true sense."""
        return ()

    def build(self, name: str, draft: Draft) -> None:
        """Add connections, torques, states and channels to the network."""
