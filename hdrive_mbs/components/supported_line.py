"""The shaft from a station over a bearing to the next station with nothing left out, and what condensing makes of it."""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.components.bearing import Bearing
from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.station import LATERAL
from hdrive_mbs.shafts.beam import Beam
from hdrive_mbs.shafts.condensation import Condensed, craig_bampton

FloatArray = npt.NDArray[np.float64]

_ENDS = [*range(5), *range(6, 11)]
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
        ends = np.ix_(_ENDS, _ENDS)
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


@dataclass(frozen=True, kw_only=True, eq=False)
class CondensedLine:
    """What is left over the ends a and b (6-vectors, phi without entries) and the coordinates kept between them.

    kept : names of the coordinates kept, then ``mode_1``...
    falling : forces per acceleration of gravity [kg], (n, 3)
    ring : rows of the ring's x, y, z, psi, theta, (5, n);  ring_sag : what its own weight adds, per gravity, (5, 3)
    frequencies : of the fixed-interface modes kept;  neglected : lowest one left out [rad/s]
    lag : longest relaxation time of what was eliminated, its damping over its stiffness [s]
    """

    kept: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    circulatory: FloatArray
    rotating: FloatArray
    falling: FloatArray
    ring: FloatArray
    ring_sag: FloatArray
    frequencies: FloatArray
    neglected: float
    lag: float


def condensed_line(line: SupportedLine, kept: Sequence[str], *, above: float = 0.0) -> CondensedLine:
    """Everything but the ends, the coordinates ``kept`` and the fixed-interface modes below ``above`` [rad/s] eliminated statically."""
    ends = [*range(10)]
    boundary = [*ends, *line.at(*kept)]
    interior = [k for k in range(len(line.names)) if k not in boundary]
    result = _with_modes(line, boundary, interior, above)
    count = len(result.frequencies)
    scale = _scales(line, result, len(boundary))
    shapes = result.transformation * scale

    wide = np.zeros((12 + len(kept) + count, len(scale)))
    wide[[*_ENDS, *range(12, len(wide))], range(len(scale))] = 1.0

    def spread(matrix: FloatArray) -> FloatArray:
        return wide @ (shapes.T @ matrix @ shapes) @ wide.T

    inner_stiffness = line.stiffness[np.ix_(interior, interior)]
    flexibility = np.zeros_like(line.stiffness)
    flexibility[np.ix_(interior, interior)] = np.linalg.inv(inner_stiffness)
    modal = result.transformation[:, len(boundary) :]
    if count:
        flexibility -= (modal / result.frequencies**2) @ modal.T
    ring = line.place[[*range(10, 15)]]
    return CondensedLine(
        kept=(*kept, *(f"mode_{k}" for k in range(1, count + 1))),
        mass=spread(line.mass),
        damping=spread(line.damping),
        stiffness=spread(line.stiffness),
        circulatory=spread(line.circulatory),
        rotating=spread(line.rotating),
        falling=wide @ shapes.T @ line.falling,
        ring=ring @ shapes @ wide.T,
        ring_sag=ring @ flexibility @ line.falling,
        frequencies=result.frequencies,
        neglected=result.neglected,
        lag=_lag(line, interior),
    )


def _with_modes(line: SupportedLine, boundary: Sequence[int], interior: Sequence[int], above: float) -> Condensed:
    """Craig and Bampton's method with all modes below a frequency."""
    result = _projected(line, boundary, interior, 0)
    for modes in range(1, len(interior) + 1):
        if not result.neglected < above:
            break
        with contextlib.suppress(ParameterError):  # a cut through a pair of equal frequencies: take both
            result = _projected(line, boundary, interior, modes)
    return result


def _projected(line: SupportedLine, boundary: Sequence[int], interior: Sequence[int], modes: int) -> Condensed:
    return craig_bampton(line.mass, line.damping, line.stiffness, boundary, interior, modes=modes, names=line.names, galerkin=True)


def _scales(line: SupportedLine, result: Condensed, boundary: int) -> FloatArray:
    """Factors of the columns: 1 for coordinates; modes get a largest displacement of 1 (tilts times the spread of the line)."""
    modal = (line.place @ result.transformation)[:, boundary:]
    tilts = np.array([name.endswith((".psi", ".theta")) for name in line.names])
    lengths = np.where(tilts, _arm(line), 1.0)
    sizes = np.max(np.abs(modal) * lengths[:, None], axis=0, initial=0.0)
    return np.concatenate([np.ones(boundary), 1.0 / sizes])


def _arm(line: SupportedLine) -> float:
    """Length that makes a displacement of a tilt: root of tilt stiffness over radial stiffness at the ring."""
    radial, tilt = (line.stiffness[line.at(name)[0], line.at(name)[0]] for name in ("ring.x", "ring.theta"))
    return math.sqrt(tilt / radial)


def _lag(line: SupportedLine, interior: Sequence[int]) -> float:
    """Largest d/k of D v = (d/k) K v over the interior [s]; symmetric parts."""
    at = np.ix_(interior, interior)
    stiffness, damping = (0.5 * (m[at] + m[at].T) for m in (line.stiffness, line.damping))
    lower = np.linalg.cholesky(stiffness)
    half = np.linalg.solve(lower, damping)
    return float(np.max(np.linalg.eigvalsh(np.linalg.solve(lower, half.T)), initial=0.0))
