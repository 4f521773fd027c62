"""Forces -(K q + D q') of all matrices of a network together, with as few operations as we can find.

Symmetric matrices act as springs and dampers (see springs); where springs have the same damping over stiffness beta,
as all sections of one shaft have, they are stretched by q + beta q', which is formed once for each coordinate.
Unsymmetric ones are multiplied row by row without their zeros.  Changes nothing but the last digits: parts below 1e-11
of a matrix, its diagonal scaled to 1, count as zero.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.groups import groups
from hdrive_mbs.compiled.springs import NEGLIGIBLE, Spring, springs_of
from hdrive_mbs.expression import Value
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.tracked import plain
from hdrive_mbs.tracked_arrays import is_tracked, proportions

FloatArray = npt.NDArray[np.float64]

Factors = tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class _Direction:
    """What a spring is stretched by, over the places of a matrix: factors, and those to the digits that tell springs apart."""

    factors: tuple[tuple[int, float], ...]
    digits: tuple[tuple[int, int, int], ...]


@dataclass(frozen=True)
class _Share:
    """A part of a matrix: springs, with the stiffness (or damping) of each, or entries row by row."""

    is_stiffness: bool
    springs: tuple[tuple[float, _Direction], ...]
    entries: tuple[tuple[int, int, float], ...]


@dataclass
class _Line:
    """Spring and damper along one combination of coordinates."""

    factors: Factors
    stiffness: float = 0.0
    damping: float = 0.0

    @property
    def ratio(self) -> float:
        """Damping over stiffness [s]; 0 where one is missing."""
        return self.damping / self.stiffness if self.stiffness else 0.0

    @cached_property
    def grouped(self) -> dict[float, list[tuple[str, bool]]]:
        """Magnitude of a factor -> coordinates, and whether it is positive; the positive ones first."""
        found: dict[float, list[tuple[str, bool]]] = {}
        for name, factor in self.factors:
            found.setdefault(abs(factor), []).append((name, factor > 0.0))
        return {size: sorted(items, key=lambda item: not item[1]) for size, items in found.items()}

    @property
    def cost(self) -> int:
        """Operations of its stretch."""
        return len(self.factors) - 1 + sum([size != 1.0 for size in self.grouped])

    def stretch(self, values: Mapping[str, Value]) -> Value:
        """By what coordinates with these values stretch it."""
        total: Value = 0.0
        for size, items in self.grouped.items():
            inner: Value = 0.0
            for name, positive in items:
                inner = inner + values[name] if positive else inner - values[name]
            total = total + size * inner
        return total


@dataclass
class _Terms:
    """What is added to and subtracted from the force on each coordinate."""

    added: dict[str, list[Value]]
    subtracted: dict[str, list[Value]]

    def resist(self, name: str, value: Value, *, positive: bool = True) -> None:
        """Subtract a value, or add it."""
        (self.subtracted if positive else self.added).setdefault(name, []).append(value)


def linear_forces(elements: Sequence[MatrixElement], moment: Moment, others: Mapping[str, Value]) -> dict[str, Value]:
    """Forces of all matrices on top of the others on each coordinate."""
    lines: dict[tuple[tuple[str, int, int], ...], _Line] = {}
    terms = _Terms({name: [value] for name, value in others.items()}, {})
    for element in elements:
        names = element.coordinates
        for share in _shares_of(element.stiffness, element.damping):
            values = moment.angles if share.is_stiffness else moment.speeds
            for i, j, entry in share.entries:
                terms.resist(names[i], abs(entry) * values[names[j]], positive=entry > 0.0)
            for stiffness, along in share.springs:
                key = tuple([(names[k], mantissa, exponent) for k, mantissa, exponent in along.digits])
                if key not in lines:
                    lines[key] = _Line(tuple([(names[k], factor) for k, factor in along.factors]))
                if share.is_stiffness:
                    lines[key].stiffness += stiffness
                else:
                    lines[key].damping += stiffness
    for ratio, same in _by_ratio(list(lines.values())).items():
        _add_lines(ratio, same, terms, moment)
    total: dict[str, Value] = {}
    for name in dict.fromkeys((*terms.added, *terms.subtracted)):
        total[name] = sum(terms.added.get(name, []))
        for value in terms.subtracted.get(name, []):
            total[name] = total[name] - value
    return total


def _shares_of(stiffness: FloatArray, damping: FloatArray) -> tuple[_Share, ...]:
    found = _shares(len(stiffness), _written(stiffness), _written(damping))
    if not (is_tracked(stiffness) or is_tracked(damping)):
        return found
    return tuple([_tracked(share, stiffness if share.is_stiffness else damping) for share in found])


def _tracked(share: _Share, matrix: FloatArray) -> _Share:
    """A share with the tracked numbers of its matrix.

    Springs of parts that are multiples of each other differ in stiffness alone: it goes with the first entry of the part, as all others
    do.
    """
    entries = tuple([(i, j, matrix.item(i, j)) for i, j, _ in share.entries])
    if not share.springs:
        return replace(share, entries=entries)
    at = np.array(sorted({place for _, along in share.springs for place, _ in along.factors}))
    first = matrix.item(at[0], at[0])
    proportions(matrix[at[:, None], at], first)
    return replace(share, springs=tuple([((stiffness / plain(first)) * first, along) for stiffness, along in share.springs]))


def _written(matrix: FloatArray) -> bytes:
    return np.ascontiguousarray(matrix, float).tobytes()


@lru_cache(maxsize=1024)
def _shares(size: int, stiffness: bytes, damping: bytes) -> tuple[_Share, ...]:
    """The parts of the stiffness and the damping of an element."""
    made: list[_Share] = []
    for is_stiffness, entries in ((True, stiffness), (False, damping)):
        matrix = np.frombuffer(entries).reshape(size, size)
        for at in groups(matrix != 0.0):
            part = matrix[np.array(at)[:, None], at]
            found = springs_of(part)
            if found is None or sum(2 * np.count_nonzero(spring.factors) for spring in found) > np.count_nonzero(part):
                full = tuple((at[i], at[j], float(part[i, j])) for i, j in np.argwhere(part).tolist())
                made.append(_Share(is_stiffness, (), full))
            else:
                made.append(_Share(is_stiffness, tuple((spring.stiffness, _direction(at, spring)) for spring in found), ()))
    return tuple(made)


def _direction(at: Sequence[int], spring: Spring) -> _Direction:
    factors = tuple((place, float(factor)) for place, factor in zip(at, spring.factors, strict=True) if factor)
    total = sum(factor for _, factor in factors)
    if total < -NEGLIGIBLE or (abs(total) <= NEGLIGIBLE and factors[0][1] < 0.0):
        factors = tuple((place, -factor) for place, factor in factors)
    return _Direction(factors, tuple((place, *_digits(factor)) for place, factor in factors))


def _digits(factor: float) -> tuple[int, int]:
    """A key that is the same for factors that differ by rounding."""
    mantissa, exponent = math.frexp(factor)
    return round(mantissa * 1e9), exponent


def _by_ratio(lines: Sequence[_Line]) -> dict[float, list[_Line]]:
    """Lines with the same damping over stiffness together, if stretching them by q + beta q' saves operations; others under 0."""
    groups: dict[float, list[_Line]] = {}
    for line in lines:
        near = [ratio for ratio in groups if abs(ratio - line.ratio) <= NEGLIGIBLE * ratio]
        groups.setdefault(near[0] if near else line.ratio, []).append(line)
    plain = groups.pop(0.0, [])
    for ratio in list(groups):
        used = {name for line in groups[ratio] for name, _ in line.factors}
        if 2 * len(used) >= sum(line.cost + 2 for line in groups[ratio]):
            plain += groups.pop(ratio)
    return {0.0: plain, **groups}


def _add_lines(ratio: float, lines: Sequence[_Line], terms: _Terms, moment: Moment) -> None:
    used = {name for line in lines for name, _ in line.factors}
    moved = {name: moment.angle(name) + ratio * moment.speed(name) for name in sorted(used)} if ratio else {}
    for line in lines:
        force: Value = 0.0
        if ratio:
            force = line.stiffness * line.stretch(moved)
        else:
            if line.stiffness:
                force = force + line.stiffness * line.stretch(moment.angles)
            if line.damping:
                force = force + line.damping * line.stretch(moment.speeds)
        for size, items in line.grouped.items():
            part = size * force
            for name, positive in items:
                terms.resist(name, part, positive=positive)


def forget() -> None:
    """Let go of the parts that are kept for equal matrices."""
    _shares.cache_clear()
