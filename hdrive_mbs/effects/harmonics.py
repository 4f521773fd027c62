"""Sums of harmonics of an angle, for the laws that have several."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from hdrive_mbs.expression import Value

MOTOR_ORDERS = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0, 24.0, 30.0, 36.0, 42.0, 48.0)
"""Orders of a motor that a search tries: its pole pairs, slots and their usual multiples, and one and two for its mounting."""


def harmonics(angle: Value, order: float, parts: Iterable[tuple[float, float]]) -> Value:
    """sum(A_k sin(k n a + p_k)) over (A_k, p_k), k = 1, 2, ...; parts of amplitude 0 cost nothing."""
    used = [(k, amplitude, phase) for k, (amplitude, phase) in enumerate(parts, start=1) if amplitude != 0.0]
    return sum((amplitude * np.sin(k * order * angle + phase) for k, amplitude, phase in used), 0.0 * angle)


def potential(angle: Value, order: float, parts: Iterable[tuple[float, float]]) -> Value:
    """sum(A_k cos(k n a + p_k)/(k n)): minus its slope is the sum of the harmonics."""
    used = [(k, amplitude, phase) for k, (amplitude, phase) in enumerate(parts, start=1) if amplitude != 0.0]
    return sum((amplitude / (k * order) * np.cos(k * order * angle + phase) for k, amplitude, phase in used), 0.0 * angle)
