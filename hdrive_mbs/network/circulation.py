"""Forces of damping that turns with the shaft: spin times displacement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Claim
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.station import Station

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Circulation:
    """F = -w C q with the spin speed w of the first end (true sense): the circulatory part of rotating damping.

    It does no work on the spin here; the power it takes from the spin is of second order in the displacements.
    """

    name: str
    coordinates: tuple[str, ...]
    spin: str
    matrix: FloatArray

    @classmethod
    def between(cls, name: str, a: Station, b: Station, matrix: FloatArray) -> Circulation:
        """From a 12x12 matrix over two stations."""
        lead = b if a.held else a
        names = (*a.names[:5], *b.names[:5])
        keep = [k for k in range(12) if k % 6 < 5]
        arm = np.zeros((12, 12))
        arm[:6, :6], arm[6:, 6:] = a.arm(), b.arm()
        moved = (arm.T @ matrix @ arm)[np.ix_(keep, keep)]
        used = list(dict.fromkeys(item for item in names if item != "ground"))
        gather = np.array([[float(item == kept) for kept in used] for item in names])
        return cls(name, tuple(used), lead.node, lead.sense * (gather.T @ moved @ gather))

    def claims(self) -> tuple[Claim, ...]:
        """It feeds whirl above the critical speed: nothing to promise."""
        return ()

    def contribution(self, moment: Moment) -> dict[str, Value]:
        speed = moment.speed(self.spin)
        result: dict[str, Value] = {}
        for i, target in enumerate(self.coordinates):
            row = np.flatnonzero(self.matrix[i])
            if len(row):
                result[target] = -speed * sum(float(self.matrix[i, j]) * moment.angle(self.coordinates[j]) for j in row)
        return result

    def power(self, moment: Moment) -> Value:
        """Power that it takes from the lateral motion [W] (negative where it feeds whirl)."""
        return -sum(force * moment.speed(name) for name, force in self.contribution(moment).items())
