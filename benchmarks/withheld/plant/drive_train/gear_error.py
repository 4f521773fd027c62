"""Kinematic error of the gear: a sum of orders of the wave generator and of the output."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from benchmarks.withheld.case import Array
from benchmarks.withheld.plant.compiled import compiled


class Orders(NamedTuple):
    """e(angle) = sum of A sin(n angle + p) - A sin(p), so that a run from rest starts unwound."""

    amplitude: Array
    order: Array
    phase: Array


def orders(*terms: tuple[float, float, float]) -> Orders:
    """From (amplitude, order, phase) of each term."""
    table = np.array(terms, dtype=float).reshape(-1, 3).T
    return Orders(table[0].copy(), table[1].copy(), table[2].copy())


def with_side_bands(amplitude: float, order: float, phase: float, depth: float, carrier: float) -> list[tuple[float, float, float]]:
    """A (1 + depth sin(carrier angle)) sin(order angle + phase) as three orders."""
    side = 0.5 * depth * amplitude
    return [(amplitude, order, phase), (side, order - carrier, phase + 0.5 * np.pi), (side, order + carrier, phase - 0.5 * np.pi)]


@compiled
def error(angle, o):
    """(e, de/d angle)"""
    value = 0.0
    slope = 0.0
    for k in range(o.amplitude.size):
        inside = o.order[k] * angle + o.phase[k]
        value += o.amplitude[k] * (math.sin(inside) - math.sin(o.phase[k]))
        slope += o.amplitude[k] * o.order[k] * math.cos(inside)
    return value, slope
