"""Forces of a bearing law with their derivatives: by differentiation of its record, else by differences."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields

import numpy as np

from hdrive_mbs.bearings.law import DIRECTIONS, BearingLaw, FloatArray, RelativeMotion
from hdrive_mbs.expression import TraceError, Value, derivative, record, scalar_function, trace, variable

NAMES = tuple(field.name for field in fields(RelativeMotion))
"""Motion values in the order of a point: five displacements, five rates, spin angle and speed."""

FREE = 5
"""Directions that can give way: all but the spin."""

_STEPS = (1e-9, 1e-9, 1e-9, 1e-8, 1e-8)
"""Half widths of central differences: displacements [m], tilts [rad]; rates use 1000 times these per second."""

Derivatives = Callable[[FloatArray], tuple[FloatArray, FloatArray, FloatArray]]
"""A point -> forces (5,), stiffness (5, 5), damping (5, 5)."""


def at_rest(displacement: FloatArray, speed: float, angle: float) -> FloatArray:
    """The point of a ring that does not vibrate."""
    return np.concatenate((displacement, np.zeros(FREE), [angle, speed]))


def derivatives(law: BearingLaw) -> Derivatives:
    """Forces, stiffness and damping of a law as a function of the point."""
    symbols = RelativeMotion(**{name: variable(name) for name in NAMES})
    recorded: dict[str, Value] = {}

    def total(motion: RelativeMotion) -> Value:
        recorded.update(law.total_forces(motion))
        return 0.0

    try:
        trace(total, symbols)
        outputs = [record(recorded[direction]) for direction in DIRECTIONS[:FREE]]
    except TraceError:
        return lambda point: _differences(law, point)
    slopes = [derivative(output, name) for name in NAMES[: 2 * FREE] for output in outputs]
    function = scalar_function([*outputs, *slopes], NAMES)

    def of(point: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        values = np.array(function(*point.tolist()))
        forces, rest = values[:FREE], values[FREE:].reshape(2, FREE, FREE)
        return forces, rest[0].T, rest[1].T

    return of


def _differences(law: BearingLaw, point: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Central differences, for a law that cannot be recorded."""
    columns = []
    for k, step in enumerate((*_STEPS, *(1000.0 * s for s in _STEPS))):
        change = np.zeros(len(point))
        change[k] = step
        columns.append((numbers(law, point + change) - numbers(law, point - change)) / (2.0 * step))
    slopes = np.array(columns).T
    return numbers(law, point), slopes[:, :FREE], slopes[:, FREE:]


def numbers(law: BearingLaw, point: FloatArray) -> FloatArray:
    """Forces at a point, by plain numbers."""
    total = law.total_forces(RelativeMotion(**dict(zip(NAMES, point.tolist(), strict=True))))
    return np.array([float(total[direction]) for direction in DIRECTIONS[:FREE]])
