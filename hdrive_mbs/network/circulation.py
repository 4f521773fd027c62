"""Forces of damping that turns with the shaft: spin times displacement, and the brake on the spin."""

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
    """Lateral forces -w C q and the torque q.C q' - w q.B q on the spin, half at each end; w is the mean true spin.

    With the dissipative part -B q' (a matrix of its own), B = beta K_b and C = -B J, where J turns lateral vectors by
    +90 degrees, it is damping of the rates in the turning frame, q' - w J q: what whirl gains, the spin loses.
    """

    name: str
    coordinates: tuple[str, ...]
    spins: tuple[tuple[str, int], ...]
    """Spin coordinate and sense at each end that can turn."""
    circulatory: FloatArray
    dissipative: FloatArray

    @classmethod
    def between(cls, name: str, a: Station, b: Station, circulatory: FloatArray, dissipative: FloatArray) -> Circulation:
        """From C and B, 12x12 over two stations."""
        return cls.over(name, (a, b), (), circulatory, dissipative)

    @classmethod
    def over(
        cls, name: str, ends: tuple[Station, Station], own: tuple[str, ...], circulatory: FloatArray, dissipative: FloatArray
    ) -> Circulation:
        """From C and B over the 6-vectors of two stations and further coordinates; phi without entries."""
        names = [item for station in ends for item in station.names] + list(own)
        arm = np.eye(len(names))
        for k, station in enumerate(ends):
            arm[6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = station.arm()
        left_out = {"ground", ends[0].names[5], ends[1].names[5]}
        used = list(dict.fromkeys(item for item in names if item not in left_out))
        gather = arm @ np.array([[float(item == kept) for kept in used] for item in names])
        spins = tuple((station.node, station.sense) for station in ends if not station.held)
        return cls(name, tuple(used), spins, gather.T @ circulatory @ gather, gather.T @ dissipative @ gather)

    def claims(self) -> tuple[Claim, ...]:
        """It feeds whirl above the critical speed: nothing to promise on its own."""
        return ()

    def _spin(self, moment: Moment) -> Value:
        return sum(sense * moment.speed(name) for name, sense in self.spins) / len(self.spins)

    def _times(self, matrix: FloatArray, moment: Moment) -> list[Value]:
        """Matrix times displacements."""
        return [sum((float(row[j]) * moment.angle(self.coordinates[j]) for j in np.flatnonzero(row)), 0.0 * moment.time) for row in matrix]

    def contribution(self, moment: Moment) -> dict[str, Value]:
        spin = self._spin(moment)
        turned = self._times(self.circulatory, moment)
        result: dict[str, Value] = {name: -spin * value for name, value in zip(self.coordinates, turned, strict=True)}
        held = self._times(self.dissipative, moment)
        torque: Value = 0.0
        for name, across, along in zip(self.coordinates, turned, held, strict=True):
            # q.C q' = -q'.C q, as C is skew
            torque = torque - moment.speed(name) * across - spin * moment.angle(name) * along
        for name, sense in self.spins:
            result[name] = sense * torque / len(self.spins)
        return result

    def power(self, moment: Moment) -> Value:
        """Power that it takes from the coordinates, without that of the matrix B [W]."""
        return -sum(force * moment.speed(name) for name, force in self.contribution(moment).items())
