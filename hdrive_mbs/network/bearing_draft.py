"""Bearings, supports and pieces of shaft while the network is being built, as effects see them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from hdrive_mbs.expression import Value
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.station import Station

FloatArray = npt.NDArray[np.float64]

Across = Mapping[str, Value]
"""Direction (x, y, z, psi, theta, phi) -> displacement or rate of the ring against the housing."""

BearingForces = Callable[[Across, Across], Mapping[str, Value]]
"""Force of the ring on the housing in each direction [N, N m] from displacements and rates; positive when it resists."""


@dataclass
class BearingDraft:
    """The law of a bearing and what effects add to it.

    stretches : direction -> factors of coordinates that make the displacement of the ring against the housing
    stiffness, damping : constant part of the law over x, y, z, psi, theta, phi, 6x6
    law : what the law has beyond its constant part
    """

    name: str
    stretches: Mapping[str, Mapping[str, float]]
    stiffness: FloatArray
    damping: FloatArray
    law: BearingForces
    added: list[BearingForces] = field(default_factory=list)

    def across(self, moment: Moment) -> tuple[dict[str, Value], dict[str, Value]]:
        """Displacements and rates of the ring against the housing at a moment."""
        s = {key: sum(f * moment.angle(c) for c, f in factors.items()) for key, factors in self.stretches.items()}
        v = {key: sum(f * moment.speed(c) for c, f in factors.items()) for key, factors in self.stretches.items()}
        return s, v

    def _linear(self, matrix: FloatArray, direction: str, values: Across) -> Value:
        row = matrix[tuple(self.stretches).index(direction)].tolist()
        terms = [factor * values[key] for factor, key in zip(row, self.stretches, strict=True) if factor != 0.0]
        return sum(terms, 0.0 * values[direction])

    def damper(self, direction: str, v: Across) -> Value:
        """Force of the constant damping in one direction at these rates."""
        return self._linear(self.damping, direction, v)

    def spring(self, direction: str, s: Across, v: Across) -> Value:
        """Force of the law in one direction without its constant damping, as if the ring did not move in x and y."""
        return self._linear(self.stiffness, direction, s) + self.law(s, {**v, "x": 0.0, "y": 0.0}).get(direction, 0.0)

    def whole(self, direction: str, s: Across, v: Across) -> Value:
        """Force in one direction with all effects."""
        own = self._linear(self.stiffness, direction, s) + self.damper(direction, v) + self.law(s, v).get(direction, 0.0)
        return sum((forces(s, v).get(direction, 0.0) for forces in self.added), own)


@dataclass(frozen=True)
class SupportDraft:
    """The housing of a bearing on its foundation.

    displacement : "x" and "y" -> factors of coordinates that make the displacement of the housing against the ground
    mass : of the housing [kg];  damping : "x" and "y" -> N s/m
    spring : force of the foundation [N] against a displacement in "x" or "y" [m]
    """

    name: str
    displacement: Mapping[str, Mapping[str, float]]
    mass: float
    damping: Mapping[str, float]
    spring: Callable[[str, Value], Value]


@dataclass(frozen=True, eq=False)
class ShaftPiece:
    """One beam element of a shaft.

    ends : stations a and b;  length : between them [m]
    bending : stiffness against bending in both planes over the 6-vectors of a and b, 12x12
    """

    name: str
    ends: tuple[Station, Station]
    length: float
    bending: FloatArray

    def stretch(self, row: Sequence[float]) -> dict[str, float]:
        """A row over the 12-vector as factors of coordinates."""
        result: dict[str, float] = {}
        for k, station in enumerate(self.ends):
            for name, column in zip(station.names, station.arm().T.tolist(), strict=True):
                some = zip(row[6 * k : 6 * k + 6], column, strict=True)
                factor = sum(one * arm for one, arm in some if arm != 0.0)
                if factor != 0.0 and name != "ground":
                    result[name] = result.get(name, 0.0) + factor
        return result

    def spin(self, share: float = 0.0) -> dict[str, float]:
        """True spin angle of the end that is nearer to a share of the length from a, and not held, as factors of coordinates."""
        near, far = self.ends if share < 0.5 else self.ends[::-1]
        return (far if near.held else near).stretch("phi")
