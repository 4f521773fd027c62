"""Scales on which a search moves: plain numbers near zero or one in place of parameters of all units.

Each unknown turns one or two search coordinates into values of fields and knows its prior:

* Factor: a nominal parameter p = p0 (1 + sigma z) with z ~ N(0, 1), kept positive (see ``Factor``)
* Strength: a size s z >= 0 of an effect that vanishes at 0; its logarithm is uniform over the typical range
* Shape: a positive field exp(m + w z), z ~ N(0, 1), the typical range at z = -2 .. 2
* Signed: a field of either sign, w z, z ~ N(0, 1), the typical range at z = -2 .. 2
* Vector: amplitude and phase as (amplitude cos, amplitude sin)/s; logarithm of the amplitude and phase uniform
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

BEYOND = 4.0
"""Times the end of a typical range that a fitted strength may go."""
STRAIGHT, FARTHEST = 0.4, 19.0
"""Of its nominal value: where a parameter stops being linear in its coordinate; and how far it may grow above it."""
TOLERANCE = 5.0
"""Prior standard deviations that a parameter may be off unless it is suspected: what needs more is a cause of its own."""
NEXT_TO_NOTHING = 1e-9
"""Of its scale: what a run takes in place of zero."""
SMALLEST = 1e-3
"""Of its scale: a strength below it is zero for the prior."""


@dataclass(frozen=True)
class Unknown(ABC):
    """Something to find.  ``path`` is where it sits: a path of the scene, or the first one of several."""

    path: str

    @property
    def size(self) -> int:
        """Number of search coordinates."""
        return 1

    @abstractmethod
    def values(self, z: Sequence[float]) -> dict[str, float]:
        """Values by path of the fields."""

    def run_values(self, z: Sequence[float]) -> dict[str, float]:
        """Values for a run: none exactly zero that need not be, because equations without a term are other equations.

        Points that differ in numbers alone run side by side on the same machine code.
        """
        return self.values(z)

    @property
    def precision(self) -> float:
        """Of the normal prior that the fit uses on each coordinate; 0 where it has none."""
        return 1.0

    @abstractmethod
    def log_prior(self, z: Sequence[float]) -> float:
        """Logarithm of the prior density over the search coordinates."""

    def clipped(self, z: Sequence[float]) -> tuple[float, ...]:
        """The nearest allowed coordinates."""
        return tuple(z)

    def at_end(self, z: Sequence[float]) -> bool:
        """Whether a coordinate lies at an end of what is allowed, beyond which the records may want it; the zero of a size is none."""
        beyond = [value + math.copysign(1e-6, value) for value in z]
        return math.hypot(*self.clipped(beyond)) <= math.hypot(*z) + 1e-9 < math.hypot(*beyond)

    def curvature(self, z: Sequence[float]) -> float:
        """Of the prior, at least: what keeps a coordinate that the records do not determine from adding evidence."""
        return self.precision

    def step(self, z: Sequence[float]) -> float:
        """Difference for numerical derivatives."""
        return 0.01

    def reach(self, z: Sequence[float]) -> float:
        """Longest change of a coordinate in one step of a fit."""
        return 2.0


@dataclass(frozen=True)
class Size(Unknown):
    """Something of an effect that may be zero."""

    def run_values(self, z: Sequence[float]) -> dict[str, float]:
        return self.values([value if value != 0.0 else NEXT_TO_NOTHING * (k + 1) for k, value in enumerate(z)])


def _normal(z: Sequence[float]) -> float:
    return sum(-0.5 * value**2 - 0.5 * math.log(2.0 * math.pi) for value in z)


@dataclass(frozen=True)
class Factor(Unknown):
    """A nominal parameter; ``wide`` widens its prior where the parameter itself is under suspicion.

    most : prior standard deviations that it may be off where it is not under suspicion

    p/p0 = 1 + sigma z down to STRAIGHT, and from there b exp((1 + sigma z - b)/b) with b = STRAIGHT: positive and smooth.
    Straight, because inertias and drags enter as sums: what only their sum determines is then a straight valley.
    """

    name: str
    nominal: Mapping[str, float]
    sigma: float
    wide: float = 1.0
    most: float = TOLERANCE

    def values(self, z: Sequence[float]) -> dict[str, float]:
        return {path: value * self.ratio(z[0]) for path, value in self.nominal.items()}

    def ratio(self, z: float) -> float:
        """p/p0."""
        straight = 1.0 + self.sigma * self.wide * z
        return straight if straight >= STRAIGHT else STRAIGHT * math.exp((straight - STRAIGHT) / STRAIGHT)

    @staticmethod
    def deviations(ratio: float, sigma: float) -> float:
        """Standard deviations z that p/p0 is off, the other way round; ``ratio`` above 0, ``sigma`` that of a prior that is not widened."""
        straight = ratio if ratio >= STRAIGHT else STRAIGHT * (1.0 + math.log(ratio / STRAIGHT))
        return (straight - 1.0) / sigma

    def log_prior(self, z: Sequence[float]) -> float:
        return _normal(z)

    def clipped(self, z: Sequence[float]) -> tuple[float, ...]:
        most = FARTHEST / (self.sigma * self.wide)
        if self.wide == 1.0:
            most = min(most, self.most)
        return (min(max(z[0], -most), most),)

    def step(self, z: Sequence[float]) -> float:
        return 0.01 / self.wide

    def reach(self, z: Sequence[float]) -> float:
        return 3.0


@dataclass(frozen=True)
class Strength(Size):
    """A size that is zero without the effect."""

    low: float
    high: float
    scale: float
    limit: float = math.inf

    def values(self, z: Sequence[float]) -> dict[str, float]:
        return {self.path: self.scale * z[0]}

    @property
    def precision(self) -> float:
        return 0.0

    def log_prior(self, z: Sequence[float]) -> float:
        return -math.log(max(z[0], SMALLEST) * math.log(self.high / self.low))

    def clipped(self, z: Sequence[float]) -> tuple[float, ...]:
        return (min(max(z[0], 0.0), min(BEYOND * self.high, self.limit) / self.scale),)

    def curvature(self, z: Sequence[float]) -> float:
        return 1.0 / max(z[0], SMALLEST) ** 2

    def step(self, z: Sequence[float]) -> float:
        return 0.003 * max(z[0], 0.1)

    def reach(self, z: Sequence[float]) -> float:
        return 2.0 * max(z[0], 0.1 * self.high / self.scale)


@dataclass(frozen=True)
class Shape(Unknown):
    """A positive field.

    difference : of the search coordinate, for numerical derivatives
    """

    low: float
    high: float
    bottom: float = 0.0
    top: float = math.inf
    difference: float = 0.01

    @property
    def _middle(self) -> float:
        return 0.5 * math.log(self.low * self.high)

    @property
    def _width(self) -> float:
        return 0.25 * math.log(self.high / self.low)

    def values(self, z: Sequence[float]) -> dict[str, float]:
        return {self.path: min(max(math.exp(self._middle + self._width * z[0]), self.bottom), self.top)}

    def coordinate(self, value: float) -> float:
        """The search coordinate of a value."""
        return (math.log(value) - self._middle) / self._width

    def log_prior(self, z: Sequence[float]) -> float:
        return _normal(z)

    def clipped(self, z: Sequence[float]) -> tuple[float, ...]:
        return (min(max(z[0], -3.0), 3.0),)

    def step(self, z: Sequence[float]) -> float:
        return self.difference


@dataclass(frozen=True)
class Signed(Size):
    """A field of either sign."""

    half_width: float
    low: float = -math.inf
    high: float = math.inf

    def values(self, z: Sequence[float]) -> dict[str, float]:
        return {self.path: min(max(0.5 * self.half_width * z[0], self.low), self.high)}

    def log_prior(self, z: Sequence[float]) -> float:
        return _normal(z)

    def clipped(self, z: Sequence[float]) -> tuple[float, ...]:
        limit = 2.0 * BEYOND
        low, high = 2.0 * self.low / self.half_width, 2.0 * self.high / self.half_width
        return (min(max(z[0], -limit, 0.98 * low), limit, 0.98 * high),)

    def step(self, z: Sequence[float]) -> float:
        return 0.003


@dataclass(frozen=True)
class Vector(Size):
    """Amplitude (``path``) and phase."""

    phase_path: str
    low: float
    high: float
    scale: float

    @property
    def size(self) -> int:
        return 2

    @property
    def precision(self) -> float:
        return 0.0

    def values(self, z: Sequence[float]) -> dict[str, float]:
        return {self.path: self.scale * math.hypot(*z), self.phase_path: math.atan2(z[1], z[0])}

    def log_prior(self, z: Sequence[float]) -> float:
        amplitude = max(math.hypot(*z), SMALLEST)
        return -math.log(2.0 * math.pi * amplitude**2 * math.log(self.high / self.low))

    def clipped(self, z: Sequence[float]) -> tuple[float, ...]:
        amplitude, most = math.hypot(*z), BEYOND * self.high / self.scale
        shrunk = 1.0 if amplitude <= most else most / amplitude
        return (z[0] * shrunk, z[1] * shrunk)

    def curvature(self, z: Sequence[float]) -> float:
        return 1.0 / max(math.hypot(*z), SMALLEST) ** 2

    def step(self, z: Sequence[float]) -> float:
        return 0.003 * max(math.hypot(*z), 0.1)

    def reach(self, z: Sequence[float]) -> float:
        return 2.0 * max(math.hypot(*z), 0.1 * self.high / self.scale)
