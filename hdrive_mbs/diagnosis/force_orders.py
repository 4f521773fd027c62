"""Orders of the spin in the force that is missing at a place, for laws that need them nearly right from the start.

Residuals show a force through the line: where the speed passes a resonance, they stand out at what resonates, and their phase turns.
The unknown force of a localisation is free of both.  With its parts across the axis as z = F_x + i F_y over the angle f of the shaft,

    S(n) = sum_k w_k z_k exp(-i n f_k),  n < 0: it turns against the spin

A flaw of a race that stands still has lines at +-n and multiples, one of a race that turns with the shaft at +-n + 1 with sidebands
one order apart: so every line stands for the orders one beside it as well, and the combs are compared.

Source: McFadden, Smith, J. Sound and Vibration 96 (1984) 69, for the sidebands; full spectrum as in D. E. Bently, C. T. Hatch,
Fundamentals of Rotating Machinery Diagnostics (2002), with orders in place of frequencies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.locate.latent_force import TurnedForce
from hdrive_mbs.diagnosis.periods import MOST, TURN

FloatArray = npt.NDArray[np.float64]

BINS = 0.05
"""rad between samples over the angle: orders up to 63."""
FINER = 2
"""Times finer than one period over the longest record."""
WHOLE = 3.0
"""Periods over a record that a line has to be away from a whole order, where every misfit of unbalance lies."""
LINES = 8
"""Lines that stand out, of which orders are made."""
COMB = (0.0, 1.0, 2.0)
"""Where lines lie beside +-n: at the force of a race that stands, or turns with the shaft, and its nearest sidebands."""
TURNS = 10.0
"""rad that a shaft has to turn for orders to be told apart."""


class StandsOut(Protocol):
    """Where periods of laws begin: residuals (Periods), or the force at a place."""

    def standing_out(self, over: str, low: float, high: float) -> tuple[float, ...]:
        """Periods per radian of ``over`` in a range, the clearest first."""

    def width(self, over: str) -> float:
        """What the longest record can just tell apart."""


@dataclass(frozen=True, eq=False)
class ForceOrders:
    """Orders from forces at a place; what is not counted over turns comes from ``other``."""

    forces: Sequence[TurnedForce]
    other: StandsOut

    def width(self, over: str) -> float:
        """What the longest record can just tell apart, in periods per radian of ``over``."""
        return self.other.width(over)

    def standing_out(self, over: str, low: float, high: float) -> tuple[float, ...]:
        """Orders between two, those with the strongest combs of lines first; from ``other`` where no force goes with the turns."""
        found = self._orders(low, high) if over == TURN else ()
        return found or self.other.standing_out(over, low, high)

    def _orders(self, low: float, high: float) -> tuple[float, ...]:
        turning = [item for item in self.forces if np.ptp(item.angle) > TURNS]
        if not turning:
            return ()
        longest = max(float(np.ptp(item.angle)) for item in turning)
        count = 1 << int(np.ceil(np.log2(FINER * longest / BINS)))
        size = sum((_spectrum(item, count) for item in turning), np.zeros(count))
        width = 2.0 * np.pi / longest
        orders = np.asarray(2.0 * np.pi * np.fft.fftfreq(count, BINS), dtype=np.float64)
        ranked: list[tuple[float, float]] = []
        for line in _lines(orders, size, width, high + COMB[-1]):
            for order in (abs(line), abs(line) + 1.0, abs(line) - 1.0):
                if low <= order <= high and all(abs(order - known) > width for _, known in ranked):
                    ranked.append((_comb(orders, size, order, width), order))
        return tuple(order for _, order in sorted(ranked, reverse=True)[:MOST])


def _spectrum(item: TurnedForce, count: int) -> FloatArray:
    """|S(n)|, tapered, over the root mean square of the force."""
    angle, first = np.maximum.accumulate(item.angle), np.min(item.angle)
    at = np.arange(first, angle[-1], BINS)
    even = np.interp(at, angle, item.force.real) + 1j * np.interp(at, angle, item.force.imag)
    power = float(np.sqrt(np.mean(np.abs(even) ** 2)))
    return np.abs(np.fft.fft(even * np.hanning(len(even)), count)) / (power * len(even)) if power > 0.0 else np.zeros(count)


def _lines(orders: FloatArray, size: FloatArray, width: float, high: float) -> list[float]:
    """The strongest lines away from whole orders, forward and backward."""
    away = np.abs(orders - np.round(orders)) > WHOLE * width
    shown = np.where(away & (np.abs(orders) <= high), size, 0.0)
    chosen: list[float] = []
    for k in np.argsort(shown)[::-1]:
        if len(chosen) == LINES or shown[k] <= 0.0:
            break
        if all(abs(abs(orders[k]) - abs(other)) > WHOLE * width for other in chosen):
            chosen.append(float(orders[k]))
    return chosen


def _comb(orders: FloatArray, size: FloatArray, order: float, width: float) -> float:
    """Lines of a force with an order together."""
    places = (sign * order + beside for sign in (-1.0, 1.0) for beside in COMB)
    return sum(float(np.max(size[np.abs(orders - at) < width], initial=0.0)) for at in places)
