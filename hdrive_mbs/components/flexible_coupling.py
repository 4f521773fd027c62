"""A flexible coupling between two shaft ends."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.errors import SceneError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class FlexibleCoupling(Component):
    """Springs and dampers between two hubs at the same place: radial, axial, tilting and torsional.

    F = k (d_a - d_b) + c (d_a' - d_b') for each of x, y, z, psi, theta and phi; each hub has half of the mass and of the
    moments of inertia.  Torsion is a connection (twist, torque), which effects can change.  Leaves out the misalignment
    of the shafts and the angle error of a joint.  For a coupling that transmits torque only use Shaft.
    """

    torsional_stiffness: float = parameter("N m/rad", "about the axis", above=0.0)
    torsional_damping: float = parameter("N m s/rad", "about the axis", default=0.0, low=0.0)
    radial_stiffness: float = parameter("N/m", "in x and y", default=0.0, low=0.0)
    radial_damping: float = parameter("N s/m", "in x and y", default=0.0, low=0.0)
    axial_stiffness: float = parameter("N/m", "along the axis", default=0.0, low=0.0)
    axial_damping: float = parameter("N s/m", "along the axis", default=0.0, low=0.0)
    tilt_stiffness: float = parameter("N m/rad", "about x and y", default=0.0, low=0.0)
    tilt_damping: float = parameter("N m s/rad", "about x and y", default=0.0, low=0.0)
    mass: float = parameter("kg", "of the whole coupling", default=0.0, low=0.0)
    polar_inertia: float = parameter("kg m^2", "of the whole coupling about the axis", default=0.0, low=0.0)
    transverse_inertia: float = parameter(
        "kg m^2", "of the whole coupling about a diameter, as half of it at each hub", default=0.0, low=0.0
    )

    entry = "a"
    exit = "b"

    def flanges(self) -> tuple[Flange, ...]:
        hub = RigidMass.rotor(0.5 * self.mass, 0.5 * self.polar_inertia, 0.5 * self.transverse_inertia)
        return (Flange(name="a", lateral=True, mass=hub), Flange(name="b", lateral=True, mass=hub))

    def relations(self) -> tuple[dict[str, float], ...]:
        return ({"a": 1.0, "b": -1.0},)

    def build(self, name: str, draft: Draft) -> None:
        a, b = draft.station(f"{name}.a"), draft.station(f"{name}.b")
        if a.node == b.node:
            raise SceneError(f"Both ends of {name!r} are joined to {a.node!r}, so it can never stretch. Connect one end elsewhere.")
        across = np.hstack([np.eye(6), -np.eye(6)])
        radial, tilt = self.radial_stiffness, self.tilt_stiffness
        stiffness = np.diag([radial, radial, self.axial_stiffness, tilt, tilt, 0.0])
        damping = np.diag([self.radial_damping] * 2 + [self.axial_damping] + [self.tilt_damping] * 2 + [0.0])
        draft.add_matrix(f"{name}.springs", (a, b), stiffness=across.T @ stiffness @ across, damping=across.T @ damping @ across)
        sense = b.sense if not b.held else a.sense
        twisting, damper = self.torsional_stiffness, self.torsional_damping

        def torque(moment: Moment, twist: Value, rate: Value) -> Value:
            return twisting * twist + damper * rate

        factors = {a.node: float(sense * a.sense), b.node: -float(sense * b.sense)}
        draft.add_connection(name, factors, torque, bodies={"a": a.node, "b": b.node})
