"""Torsion of a shaft over a bearing, condensed to its ends."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.network.station import GROUND, Station
from hdrive_mbs.shafts.condensation import guyan

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Torsion:
    """Torsion of a shaft between its ends, what sits on it following them statically.

    stiffness, damping : of the twist between the ends [N m/rad, N m s/rad]
    inertia : over the two spins [kg m^2], 2x2;  ring : spin of the ring as part of those of the ends, (2,)
    """

    stiffness: float
    damping: float
    inertia: FloatArray
    ring: FloatArray

    @property
    def shares(self) -> tuple[float, float]:
        """Inertia that each end carries when both turn alike [kg m^2]."""
        a, b = self.inertia.sum(axis=1)
        return float(a), float(b)


def torsion_over(left: ShaftSection, right: ShaftSection, ring: float) -> Torsion:
    """Two pieces in series with a ring of that polar inertia [kg m^2] between them."""
    elements = [(part, part.beam(part.length / part.elements)) for part in (left, right) for _ in range(int(part.elements))]
    size, middle = len(elements) + 1, int(left.elements)
    inertia, damping, stiffness = (np.zeros((size, size)) for _ in range(3))
    inertia[middle, middle] = ring
    for (a, b), (part, beam) in zip(itertools.pairwise(range(size)), elements, strict=True):
        spring = beam.shear_modulus * beam.polar_moment / beam.length * np.array([[1.0, -1.0], [-1.0, 1.0]])
        at = np.ix_([a, b], [a, b])
        stiffness[at] += spring
        damping[at] += (part.damping + part.rotating_damping) * spring
        inertia[[a, b], [a, b]] += beam.end_polar_inertia()
    ends = guyan(inertia, damping, stiffness, (0, size - 1), range(1, size - 1))
    return Torsion(float(ends.stiffness[0, 0]), float(ends.damping[0, 0]), ends.mass, ends.recovery(middle))


def turning(polar: float) -> RigidMass:
    """What has inertia about the axis only."""
    return RigidMass(0.0, (0.0, 0.0, 0.0), ((0.0,) * 3, (0.0,) * 3, (0.0, 0.0, polar)))


def add_spring(name: str, draft: Draft, a: Station | Node, b: Station | Node, stiffness: float, damping: float) -> None:
    """A torsion spring and damper from a to b, as the connection ``name``."""
    first, last = (place.node if isinstance(place, Station) else place.name for place in (a, b))
    sense = a.sense if last == GROUND else b.sense
    factors: dict[str, float] = {first: float(sense * a.sense)}
    factors[last] = factors.get(last, 0.0) - float(sense * b.sense)

    def torque(moment: Moment, twist: Value, rate: Value) -> Value:
        return stiffness * twist + damping * rate

    draft.add_connection(name, factors, torque, bodies={"a": first, "b": last})
