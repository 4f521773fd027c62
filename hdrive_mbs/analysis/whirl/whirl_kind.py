"""What a mode of a line is: forward or backward whirl, torsional, axial, or mixed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.whirl.roots import ComplexArray, FloatArray
from hdrive_mbs.analysis.whirl.spinning_line import SpinningLine

STRAIGHT = 1e-6
"""Orbits whose areas are below this share of the circles of the same energy count as straight lines."""

OPPOSITE = 0.01
"""Places that whirl the other way count where their orbits have this share of the area of the others."""

WORDS = ("forward", "backward", "torsional", "axial", "mixed")

_KINDS = ("lateral", "axial", "torsional")


@dataclass(frozen=True)
class _Pair:
    """Two coordinates that make an orbit: (x, y), or (theta, -psi) with sign -1; sense of the spin there; their inertia."""

    place: str
    first: int
    second: int
    sign: float
    sense: float
    weight: float


class WhirlKinds:
    """Classifies shapes over the coordinates of a line.

    With x = Re[X exp(i w t)] and y alike, x + i y is a circle of radius |X + i Y|/2 in the positive sense and one of
    |X - i Y|/2 in the negative sense.  Forward is the sense in which the place itself spins (at rest: will spin).
    Orbits are weighted with mass, those of tilts with the moment of inertia; housings do not spin and do not count.
    """

    def __init__(self, line: SpinningLine) -> None:
        index = {name: k for k, name in enumerate(line.names)}
        self._pairs: list[_Pair] = []
        for spin, ratio in line.ratios.items():
            for first, second, sign in ((".x", ".y", 1.0), (".theta", ".psi", -1.0)):
                a, b = index.get(f"{spin}{first}"), index.get(f"{spin}{second}")
                if a is not None and b is not None:
                    self._pairs.append(_Pair(spin, a, b, sign, -1.0 if ratio < 0.0 else 1.0, float(line.mass[a, a])))
        lateral = {body.name for body in line.network.bodies if body.lateral}
        kind = ["torsional" if name not in lateral else "axial" if name.endswith("z") else "lateral" for name in line.names]
        self._members = {word: np.array([item == word for item in kind]) for word in _KINDS}
        self._size = len(line.names)
        self._mass = line.mass

    def form(self) -> ComplexArray:
        """Hermitian H with x* H x = sum of (forward radius^2 - backward radius^2) times inertia."""
        whole = np.zeros((self._size, self._size), complex)
        for pair in self._pairs:
            whole[pair.first, pair.second] += 0.5j * pair.sign * pair.sense * pair.weight
            whole[pair.second, pair.first] -= 0.5j * pair.sign * pair.sense * pair.weight
        return whole

    def classify(
        self, index: npt.NDArray[np.intp], shapes: ComplexArray, direction: npt.NDArray[np.float64]
    ) -> tuple[list[str], FloatArray]:
        """Word and circularity of each shape.

        index : the coordinates of the rows of shapes, (n,);  shapes : (n, k)
        direction : -1 where the reference shaft turns backwards, else 1, (k,)

        Circularity is +1 for forward circles, -1 for backward ones, 0 for straight lines and for what is not lateral.
        """
        energy = {}
        for word, member in self._members.items():
            at = np.flatnonzero(member[index])
            part = shapes[at]
            energy[word] = np.sum(part.conj() * (self._mass[np.ix_(index[at], index[at])] @ part), axis=0).real
        kinds = np.argmax([energy[word] for word in _KINDS], axis=0)
        row = {int(k): i for i, k in enumerate(index)}
        pairs = [pair for pair in self._pairs if pair.first in row]
        first = shapes[[row[pair.first] for pair in pairs]]
        second = shapes[[row[pair.second] for pair in pairs]] * np.array([[pair.sign] for pair in pairs]).reshape(-1, 1)
        weight = np.array([[pair.weight] for pair in pairs]).reshape(-1, 1)
        sense = np.array([[pair.sense] for pair in pairs]).reshape(-1, 1) * direction
        positive, negative = weight * np.abs(first + 1j * second) ** 2, weight * np.abs(first - 1j * second) ** 2
        circles = np.sum(positive + negative, axis=0)
        places = list(dict.fromkeys(pair.place for pair in pairs))
        at_place = np.array([[float(pair.place == place) for pair in pairs] for place in places]).reshape(len(places), len(pairs))
        area = at_place @ (sense * (positive - negative))
        forward, backward = np.sum(np.maximum(area, 0.0), axis=0), np.sum(np.maximum(-area, 0.0), axis=0)
        words = []
        for k, kind in enumerate(kinds):
            large, small = max(forward[k], backward[k]), min(forward[k], backward[k])
            if _KINDS[kind] != "lateral":
                words.append(_KINDS[kind])
            elif large <= STRAIGHT * circles[k] or small > OPPOSITE * large:
                words.append("mixed")
            else:
                words.append("forward" if forward[k] > backward[k] else "backward")
        circularity = np.where(kinds == 0, (forward - backward) / np.where(circles > 0.0, circles, 1.0), 0.0)
        return words, circularity
