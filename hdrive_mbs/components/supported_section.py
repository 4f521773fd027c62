"""A piece of shaft with the bearing that holds it, as one element between the next two stations."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.components.bearing import Bearing
from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.network.station import GROUND, LATERAL, UNITS, WORDS, Station
from hdrive_mbs.quantities import option
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


@dataclass(frozen=True, kw_only=True)
class SupportedSection(Component):
    """Shaft from flange a over a bearing to flange b, the bearing not a station of its own.

    Made of the same parts as the full model, so that both come from the same data.  In torsion the two pieces are
    in series and the ring follows them, which is exact but for (frequency / torsional frequency of the ring)^4.
    """

    _kind = "supported shaft section"

    left: ShaftSection = option("shaft from flange a to the bearing")
    bearing: Bearing = option("the bearing, with its ring and housing")
    right: ShaftSection = option("shaft from the bearing to flange b")

    entry = "a"
    exit = "b"

    def check(self) -> None:
        for name, kind in (("left", ShaftSection), ("bearing", Bearing), ("right", ShaftSection)):
            if not isinstance(getattr(self, name), kind):
                raise ParameterError(f"{type(self).__name__}.{name} = {getattr(self, name)!r}: must be a {kind.__name__}(...).")

    @property
    def length(self) -> float:
        """Distance from a to b [m]."""
        return self.left.length + self.right.length

    @cached_property
    def torsion(self) -> Torsion:
        """The two pieces in series, with the ring and the mass of the shaft condensed to the ends."""
        elements = [(part, part.beam(part.length / part.elements)) for part in (self.left, self.right) for _ in range(int(part.elements))]
        size, ring = len(elements) + 1, int(self.left.elements)
        inertia, damping, stiffness = (np.zeros((size, size)) for _ in range(3))
        inertia[ring, ring] = self.bearing.polar_inertia
        for (a, b), (part, beam) in zip(itertools.pairwise(range(size)), elements, strict=True):
            spring = beam.shear_modulus * beam.polar_moment / beam.length * np.array([[1.0, -1.0], [-1.0, 1.0]])
            at = np.ix_([a, b], [a, b])
            stiffness[at] += spring
            damping[at] += (part.damping + part.rotating_damping) * spring
            inertia[[a, b], [a, b]] += beam.end_polar_inertia()
        ends = guyan(inertia, damping, stiffness, (0, size - 1), range(1, size - 1))
        return Torsion(float(ends.stiffness[0, 0]), float(ends.damping[0, 0]), ends.mass, ends.recovery(ring))

    def flanges(self) -> tuple[Flange, ...]:
        shares = self.torsion.shares
        ends = (("a", 0.0, self.left), ("b", self.length, self.right))
        return tuple(
            Flange(name=name, lateral=True, mass=turning(share), axial=axial, free=part.density > 0.0)
            for (name, axial, part), share in zip(ends, shares, strict=True)
        )

    def relations(self) -> tuple[Mapping[str, float], ...]:
        return ({"a": 1.0, "b": -1.0},)

    # -- what the models share when they are built ----------------------------------------------------
    def stations(self, name: str, draft: Draft) -> tuple[Station, Station]:
        """The two ends."""
        a, b = draft.station(f"{name}.a", asked_by=repr(name)), draft.station(f"{name}.b", asked_by=repr(name))
        if a.held and b.held:
            raise ParameterError(f"{name!r}: both ends are held by the ground, so the section does nothing; remove it.")
        return a, b

    def add_twist(self, name: str, draft: Draft, a: Station, b: Station) -> None:
        """The connection ``name`` that carries torque from a to b, and the spin of the ring as channels."""
        torsion = self.torsion
        add_spring(name, draft, a, b, torsion.stiffness, torsion.damping)
        parts = [(float(share * s.sense), s.node) for share, s in zip(torsion.ring, (a, b), strict=True) if not s.held]
        draft.add_channel(
            f"{name}.angle", "rad", f"angle of {name}, true sense", lambda m: sum(f * m.angle(c) for f, c in parts), slope=f"{name}.speed"
        )
        draft.add_channel(f"{name}.speed", "rad/s", f"speed of {name}, true sense", lambda m: sum(f * m.speed(c) for f, c in parts))

    def with_coupled_spins(self, mass: FloatArray) -> FloatArray:
        """The 12x12... matrix of mass with what couples the spins: J = diag(shares) + J_ab [[-1, 1], [1, -1]]."""
        coupling = float(self.torsion.inertia[0, 1])
        whole = mass.copy()
        whole[np.ix_((5, 11), (5, 11))] = coupling * np.array([[-1.0, 1.0], [1.0, -1.0]])
        return whole


def turning(polar: float) -> RigidMass:
    """What has inertia about the axis only."""
    return RigidMass(0.0, (0.0, 0.0, 0.0), ((0.0,) * 3, (0.0,) * 3, (0.0, 0.0, polar)))


def add_spring(name: str, draft: Draft, a: Station | Node, b: Station | Node, stiffness: float, damping: float) -> None:
    """A torsion spring and damper from a to b, as the connection ``name``."""
    (first, last), (sense_a, sense_b) = (_spin(a), _spin(b)), (a.sense, b.sense)
    sense = sense_b if last != GROUND else sense_a
    factors: dict[str, float] = {first: float(sense * sense_a)}
    factors[last] = factors.get(last, 0.0) - float(sense * sense_b)

    def torque(moment: Moment, twist: Value, rate: Value) -> Value:
        return stiffness * twist + damping * rate

    draft.add_connection(name, factors, torque, bodies={"a": first, "b": last})


def _spin(place: Station | Node) -> str:
    return place.node if isinstance(place, Station) else place.name


def factors_of(row: FloatArray, a: Station, b: Station, own: tuple[str, ...]) -> dict[str, float]:
    """A row over the 6-vectors of a and b and own coordinates as factors of coordinates."""
    values = np.concatenate([row[:6] @ a.arm(), row[6:12] @ b.arm(), row[12:]])
    factors: dict[str, float] = {}
    for coordinate, value in zip((*a.names, *b.names, *own), values, strict=True):
        if coordinate != GROUND and value != 0.0:
            factors[coordinate] = factors.get(coordinate, 0.0) + float(value)
    return factors


def add_place(name: str, draft: Draft, rows: Mapping[str, Mapping[str, float]], sag: FloatArray | None = None) -> None:
    """Channels of a place that is no station, as the full model has them: x ... theta and radial.

    rows : direction -> factors of coordinates;  sag : offset per gravity in x, y and z, (5, 3)
    """

    def offset(row: int) -> float:
        return 0.0 if sag is None else float(sag[row] @ np.array(draft.gravity))

    for row, key in enumerate(LATERAL):
        draft.add_displacement(f"{name}.{key}", rows[key], UNITS[key], f"{WORDS[key]} of {name}", lambda row=row: offset(row))

    def radial(moment: Moment) -> Value:
        x, y = (sum((f * moment.angle(c) for c, f in rows[key].items()), offset(row)) for row, key in enumerate("xy"))
        return np.hypot(x, y)

    draft.add_channel(f"{name}.radial", "m", f"distance of the centre of {name} from the axis", radial)
