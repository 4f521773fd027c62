"""Forces -(K q + D q') of all matrices of a network together, with as few operations as we can find.

Symmetric matrices act as springs and dampers (see springs); where springs have the same damping over stiffness beta,
as all sections of one shaft have, they are stretched by q + beta q', which is formed once for each coordinate.
Unsymmetric ones are multiplied row by row without their zeros.  Changes nothing but the last digits: parts below 1e-11
of a matrix, its diagonal scaled to 1, count as zero.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.groups import groups
from hdrive_mbs.compiled.springs import NEGLIGIBLE, Spring, springs
from hdrive_mbs.expression import Value
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment

FloatArray = npt.NDArray[np.float64]

Factors = tuple[tuple[str, float], ...]


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
        known: dict[tuple[str, ...], tuple[FloatArray, list[Spring] | None]] = {}
        for kind, matrix in (("stiffness", element.stiffness), ("damping", element.damping)):
            for at in groups(matrix != 0.0):
                names, part = tuple(element.coordinates[k] for k in at), matrix[np.array(at)[:, None], at]
                found = _proportional(part, *known[names]) if names in known else springs(part)
                known[names] = part, found
                if found is None or sum(2 * np.count_nonzero(spring.factors) for spring in found) > np.count_nonzero(part):
                    values = moment.angles if kind == "stiffness" else moment.speeds
                    for i, j in np.argwhere(part).tolist():
                        terms.resist(names[i], abs(float(part[i, j])) * values[names[j]], positive=part[i, j] > 0.0)
                else:
                    _add_springs(kind, names, found, lines)
    for ratio, same in _by_ratio(list(lines.values())).items():
        _add_lines(ratio, same, terms, moment)
    total: dict[str, Value] = {}
    for name in dict.fromkeys((*terms.added, *terms.subtracted)):
        total[name] = sum(terms.added.get(name, []))
        for value in terms.subtracted.get(name, []):
            total[name] = total[name] - value
    return total


def _proportional(part: FloatArray, before: FloatArray, found: list[Spring] | None) -> list[Spring] | None:
    """The springs of a matrix, taken from those of another one if it is a multiple of it."""
    ratio = float(part[0, 0] / before[0, 0]) if before[0, 0] else 0.0
    if found is None or not ratio > 0.0 or np.max(np.abs(part - ratio * before)) > 1e-15 * np.max(np.abs(part)):
        return springs(part)
    return [Spring(ratio * spring.stiffness, spring.factors) for spring in found]


def _add_springs(kind: str, names: Sequence[str], found: Sequence[Spring], lines: dict[tuple[tuple[str, int, int], ...], _Line]) -> None:
    for spring in found:
        factors = tuple((name, float(factor)) for name, factor in zip(names, spring.factors, strict=True) if factor)
        total = sum(factor for _, factor in factors)
        if total < -NEGLIGIBLE or (abs(total) <= NEGLIGIBLE and factors[0][1] < 0.0):
            factors = tuple((name, -factor) for name, factor in factors)
        key = tuple((name, *_digits(factor)) for name, factor in factors)
        line = lines.setdefault(key, _Line(factors))
        setattr(line, kind, getattr(line, kind) + spring.stiffness)


def _digits(factor: float) -> tuple[int, int]:
    """A key that is the same for factors that differ by rounding."""
    mantissa, exponent = np.frexp(factor)
    return round(float(mantissa) * 1e9), int(exponent)


def _by_ratio(lines: Sequence[_Line]) -> dict[float, list[_Line]]:
    """Lines with the same damping over stiffness together, if stretching them by q + beta q' saves operations; others under 0."""
    groups: dict[float, list[_Line]] = {}
    for line in lines:
        near = [ratio for ratio in groups if abs(ratio - line.ratio) <= NEGLIGIBLE * ratio]
        groups.setdefault(near[0] if near else line.ratio, []).append(line)
    plain = groups.pop(0.0, [])
    for ratio in list(groups):
        used = {name for line in groups[ratio] for name, _ in line.factors}
        if 2 * len(used) >= sum(_cost(line.factors) + 2 for line in groups[ratio]):
            plain += groups.pop(ratio)
    return {0.0: plain, **groups}


def _grouped(factors: Factors) -> dict[float, list[tuple[str, bool]]]:
    """Magnitude of a factor -> coordinates, and whether it is positive; the positive ones first."""
    found: dict[float, list[tuple[str, bool]]] = {}
    for name, factor in factors:
        found.setdefault(abs(factor), []).append((name, factor > 0.0))
    return {size: sorted(items, key=lambda item: not item[1]) for size, items in found.items()}


def _cost(factors: Factors) -> int:
    """Operations of a stretch."""
    return len(factors) - 1 + sum(size != 1.0 for size in _grouped(factors))


def _stretch(factors: Factors, values: Mapping[str, Value]) -> Value:
    total: Value = 0.0
    for size, items in _grouped(factors).items():
        inner: Value = 0.0
        for name, positive in items:
            inner = inner + values[name] if positive else inner - values[name]
        total = total + size * inner
    return total


def _add_lines(ratio: float, lines: Sequence[_Line], terms: _Terms, moment: Moment) -> None:
    used = {name for line in lines for name, _ in line.factors}
    moved = {name: moment.angle(name) + ratio * moment.speed(name) for name in sorted(used)} if ratio else {}
    for line in lines:
        force: Value = 0.0
        if ratio:
            force = line.stiffness * _stretch(line.factors, moved)
        else:
            if line.stiffness:
                force = force + line.stiffness * _stretch(line.factors, moment.angles)
            if line.damping:
                force = force + line.damping * _stretch(line.factors, moment.speeds)
        for size, items in _grouped(line.factors).items():
            part = size * force
            for name, positive in items:
                terms.resist(name, part, positive=positive)
