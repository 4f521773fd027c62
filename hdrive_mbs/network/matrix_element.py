"""A linear element over many coordinates: shaft sections, bearing coefficients, condensed parts."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Claim
from hdrive_mbs.network.moment import Moment

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MatrixElement:
    """M q'' + D q' + K q = 0 over the named coordinates (forward for spins).

    coordinates : n names
    mass, damping, stiffness : n x n; unsymmetric stiffness is allowed (cross-coupled bearings)
    falling : force per acceleration of gravity in x, y and z [kg], (n, 3), where coordinates are not displacements
        of places alone; None: the mass times those that are
    """

    name: str
    coordinates: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    falling: FloatArray | None = None

    def without(self, names: Collection[str]) -> MatrixElement:
        """The element over the other coordinates, with these at rest."""
        kept = [k for k, name in enumerate(self.coordinates) if name not in names]
        if len(kept) == len(self.coordinates):
            return self
        at = np.ix_(kept, kept)
        falling = None if self.falling is None else self.falling[kept]
        return MatrixElement(
            self.name, tuple(self.coordinates[k] for k in kept), self.mass[at], self.damping[at], self.stiffness[at], falling
        )

    def claims(self) -> tuple[Claim, ...]:
        """Matrices promise nothing."""
        return ()

    def contribution(self, moment: Moment) -> dict[str, Value]:
        """Forces -(K q + D q'); the mass enters the equations of motion on its own."""
        result: dict[str, Value] = {}
        for target, springs, dampers in self._rows:
            force: Value = 0.0
            for factor, name in springs:
                force = force - factor * moment.angles[name]
            for factor, name in dampers:
                force = force - factor * moment.speeds[name]
            result[target] = force
        return result

    @cached_property
    def _rows(self) -> tuple[tuple[str, list[tuple[float, str]], list[tuple[float, str]]], ...]:
        """Of each coordinate what is not zero of its stiffness and of its damping."""
        return tuple(zip(self.coordinates, self._sparse(self.stiffness), self._sparse(self.damping), strict=True))

    def _sparse(self, matrix: FloatArray) -> list[list[tuple[float, str]]]:
        rows: list[list[tuple[float, str]]] = [[] for _ in self.coordinates]
        at = np.nonzero(matrix)
        for i, j, factor in zip(*(part.tolist() for part in at), matrix[at].tolist(), strict=True):
            rows[i].append((factor, self.coordinates[j]))
        return rows

    def power(self, moment: Moment) -> Value:
        """Power that stiffness and damping take from the coordinates [W]."""
        return -sum(force * moment.speed(name) for name, force in self.contribution(moment).items())

    def stored(self, moment: Moment) -> Value:
        """q^T K q / 2 [J], the elastic energy where K is symmetric."""
        return -0.5 * sum(force * moment.angle(name) for name, force in self._elastic(moment).items())

    def _elastic(self, moment: Moment) -> dict[str, Value]:
        still = MatrixElement(self.name, self.coordinates, self.mass, 0.0 * self.damping, self.stiffness)
        return still.contribution(moment)

    def kinetic(self, moment: Moment) -> Value:
        """q'^T M q' / 2 [J]."""
        total: Value = 0.0
        for i, j in np.argwhere(self.mass):
            speeds = moment.speed(self.coordinates[i]) * moment.speed(self.coordinates[j])
            total = total + 0.5 * float(self.mass[i, j]) * speeds
        return total
