"""The shaft from a station over a bearing to the next station, with nothing left out."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.components.bearing import Bearing
from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.network.station import LATERAL
from hdrive_mbs.shafts.beam import Beam

FloatArray = npt.NDArray[np.float64]

ENDS = [*range(5), *range(6, 11)]
"""Places of the lateral coordinates of two stations in their 12-vector."""


def _beams(section: ShaftSection) -> Iterator[tuple[ShaftSection, Beam]]:
    """The elements of a section, from a to b."""
    beam = section.beam(section.length / section.elements)
    return itertools.repeat((section, beam), int(section.elements))


@dataclass(frozen=True, kw_only=True, eq=False)
class SupportedLine:
    """Lateral matrices over x, y, z, psi, theta of the stations a, b, ring and those between, then housing x and y.

    names : of the coordinates, ``ring.x`` or ``housing.x``; the ring's may be counted across the bearing (see ``across``)
    circulatory, rotating : C and B of damping that turns with the shaft (see Circulation); B is part of ``damping``
    place : what the coordinates are of: places = place @ coordinates, in the order of the names before ``across``
    """

    names: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    circulatory: FloatArray
    rotating: FloatArray
    place: FloatArray

    def at(self, *names: str) -> list[int]:
        """Places of coordinates."""
        return [self.names.index(name) for name in names]

    def across(self, keys: Sequence[str]) -> SupportedLine:
        """The same with ring.x (and ring.y) counted from the housing: what a bearing law looks at is one coordinate then."""
        turn = np.eye(len(self.names))
        for key in keys:
            if f"housing.{key}" in self.names:
                turn[self.names.index(f"ring.{key}"), self.names.index(f"housing.{key}")] = 1.0
        made = [turn.T @ m @ turn for m in (self.mass, self.damping, self.stiffness, self.circulatory, self.rotating)]
        return SupportedLine(
            names=self.names,
            mass=made[0],
            damping=made[1],
            stiffness=made[2],
            circulatory=made[3],
            rotating=made[4],
            place=self.place @ turn,
        )

    @property
    def falling(self) -> FloatArray:
        """Force on each coordinate per acceleration of gravity in x, y and z [kg], (n, 3)."""
        rigid = np.array([[float(name.endswith(f".{key}")) for key in "xyz"] for name in self.names])
        back = np.linalg.solve(self.place, rigid)
        return np.asarray(self.mass @ back)


def supported_line(left: ShaftSection, bearing: Bearing, right: ShaftSection) -> SupportedLine:
    """All matrices of sections, ring, bearing law (its constant part) and housing."""
    inner = [f"left_{k}" for k in range(1, int(left.elements))], [f"right_{k}" for k in range(1, int(right.elements))]
    stations = ["a", *inner[0], "ring", *inner[1], "b"]
    order = ["a", "b", "ring", *inner[0], *inner[1]]
    housing = ["housing.x", "housing.y"] if bearing.housing is not None else []
    names = tuple([f"{station}.{key}" for station in order for key in LATERAL] + housing)
    size = len(names)
    mass, damping, stiffness, circulatory, rotating = (np.zeros((size, size)) for _ in range(5))
    elements = itertools.chain(_beams(left), _beams(right))
    for (a, b), (section, beam) in zip(itertools.pairwise(stations), elements, strict=True):
        at = np.ix_(*[[names.index(f"{station}.{key}") for station in (a, b) for key in LATERAL]] * 2)
        ends = np.ix_(ENDS, ENDS)
        elastic, turning = beam.stiffness()[ends], section.rotating_damping * beam.bending_stiffness()[ends]
        stiffness[at] += elastic
        damping[at] += section.damping * elastic + turning
        rotating[at] += turning
        circulatory[at] += section.rotating_damping * beam.circulatory()[ends]
        mass[at] += beam.mass(rotary_inertia=section.rotary_inertia)[ends]
    ring = [names.index(f"ring.{key}") for key in LATERAL]
    mass[ring, ring] += [bearing.mass] * 3 + [bearing.transverse_inertia] * 2
    between = np.zeros((5, size))
    between[range(5), ring] = 1.0
    if bearing.housing is not None:
        base = bearing.housing
        at_housing = [names.index(name) for name in housing]
        between[[0, 1], at_housing] = -1.0
        mass[at_housing, at_housing] += base.mass
        stiffness[at_housing, at_housing] += [base.stiffness_x, base.stiffness_y]
        damping[at_housing, at_housing] += [base.damping_x, base.damping_y]
    stiffness += between.T @ np.asarray(bearing.law.stiffness_matrix(), float)[:5, :5] @ between
    damping += between.T @ np.asarray(bearing.law.damping_matrix(), float)[:5, :5] @ between
    return SupportedLine(
        names=names,
        mass=mass,
        damping=damping,
        stiffness=stiffness,
        circulatory=circulatory,
        rotating=rotating,
        place=np.eye(size),
    )
