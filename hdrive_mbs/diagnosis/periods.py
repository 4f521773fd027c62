"""Orders and frequencies that stand out in what a fitted model leaves, for laws that need them nearly right from the start.

A force that goes with n times the spin angle shows only where n is right within about one period over the record: a search
that begins elsewhere sees nothing of it.  So n is read off the residuals first.  With the angle f_k of the shaft at sample k,

    S(n) = sum_k w_k r_k exp(-i n f_k)

by the fast Fourier transform over f, samples put into bins of the angle; the same over time for frequencies.  The fitted
samples come in stretches; each is tapered over the angle (Hann), so that strong synchronous vibration does not leak over the
whole range.  A peak is judged against what lies about it.

Source: computed order tracking, e.g. Fyfe, Munck, Mechanical Systems and Signal Processing 11 (1997) 187, with the sum over
the angle in place of resampling.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.locate.motion import motion_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.turning import reference_shaft

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

TURN, TIME = "turn", "time"
"""What a period is counted over: radians of the reference shaft, or seconds."""
MOST = 6
"""Peaks that are tried."""
SMALLEST = 8
"""Bins that the shortest period of a range has at least: sin(pi/8)/(pi/8) = 0.97 of its size is then seen."""
FINER = 2
"""Times finer than one period over the longest record."""
STRETCH = 64
"""Samples that a stretch needs."""
ABOUT, WIDE = 16, 12
"""Parts of a range, at most, that have a level of their own, which a peak stands out of, and periods over a stretch that each spans."""


class Periods:
    """What is periodic in the residuals of a model on the records of a simulator.

    fitted : on this simulator
    """

    def __init__(self, simulator: Simulator, fitted: Fitted) -> None:
        self._simulator, self._fitted = simulator, fitted

    def standing_out(self, over: str, low: float, high: float) -> tuple[float, ...]:
        """Periods per radian of ``over`` ("turn", "time": [rad/s]) in a range, the clearest first; none where nothing was excited."""
        highest = high
        if over == TIME:  # above half the sample rate a frequency looks like another one
            high = min(high, float(np.pi / max(trial.every * self._simulator.every for trial in self._simulator.trials)))
        rows = list(self._rows(over))
        longest = _longest(rows)
        if longest * (high - low) < 4.0 * np.pi:
            return ()
        stretch = max(float(np.ptp(at[part])) for at, _, parts in rows for part in parts)
        width = 2.0 * np.pi / (SMALLEST * high)
        count = 1 << int(np.ceil(np.log2(FINER * longest / width)))
        power = np.zeros(count // 2)
        for at, values, parts in rows:
            power += _power(at, values, parts, width, count)[: count // 2]
        periods = np.asarray(2.0 * np.pi * np.arange(count // 2) / (count * width))
        inside = (periods >= low) & (periods <= high)
        found = _peaks(periods[inside], power[inside], 2.0 * np.pi / longest, 2.0 * np.pi / stretch)
        return found if over == TURN else self._with_images(found, low, highest)

    def _with_images(self, found: Sequence[float], low: float, high: float) -> tuple[float, ...]:
        """Frequencies, each followed by those that look like it where only every few samples are compared, up to half the sample rate."""
        sampled = max(trial.every for trial in self._simulator.trials)
        rate, high = 2.0 * float(np.pi) / (sampled * self._simulator.every), min(high, float(np.pi) / sampled)
        images = [
            image
            for frequency in found
            for image in (frequency, *(k * rate + side * frequency for k in range(1, self._simulator.every + 1) for side in (-1.0, 1.0)))
            if image == frequency or low <= image <= high
        ]
        return tuple(images[: 2 * MOST])

    def width(self, over: str) -> float:
        """What the longest record can just tell apart, in periods per radian of ``over``; infinite where nothing was excited."""
        longest = _longest(list(self._rows(over)))
        return 2.0 * float(np.pi) / longest if longest > 0.0 else float(np.inf)

    def _rows(self, over: str) -> Iterator[tuple[FloatArray, FloatArray, list[slice]]]:
        """Of every trial: where its samples are, weighted residuals by column, (columns, samples), and stretches that a fit sees."""
        weights = np.zeros(self._simulator.size)
        fit = self._simulator.fit
        weights[fit] = self._simulator.blocks.weights(self._fitted.residuals[fit])
        weighted = weights * self._fitted.residuals
        for k, trial in enumerate(self._simulator.trials):
            spans = [item.span for item in self._simulator.segments if item.trial == k]
            at = trial.times[:: self._simulator.every] if over == TIME else self._angles[k]
            if spans:
                yield at, np.array([weighted[span] for span in spans]), _stretches(np.any([fit[span] for span in spans], axis=0))

    @cached_property
    def _angles(self) -> list[FloatArray]:
        """Of the reference shaft at the samples of each trial."""
        fitted, simulator = self._fitted, self._simulator
        motions = (motion_of(simulator, k, fitted.hypothesis, fitted.z) for k in range(len(simulator.trials)))
        return [reference_shaft(motion)[1][:: simulator.every] for motion in motions]


def _longest(rows: Sequence[tuple[FloatArray, FloatArray, list[slice]]]) -> float:
    """How far the longest record goes of which a fit sees something."""
    return max((float(np.ptp(at)) for at, _, parts in rows if parts), default=0.0)


def _stretches(seen: Mask) -> list[slice]:
    """Runs of samples without a hole."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], seen.astype(np.int8), [0]])))
    return [slice(int(a), int(b)) for a, b in edges.reshape(-1, 2) if b - a >= STRETCH]


def _power(at: FloatArray, values: FloatArray, stretches: Sequence[slice], width: float, count: int) -> FloatArray:
    """|S|^2 of all columns together, each over its own energy."""
    bins = np.floor((at - np.min(at)) / width).astype(np.int64) % count
    taper = np.zeros(len(at))
    for part in stretches:
        inside = at[part]
        turned = (inside - inside[0]) / (inside[-1] - inside[0]) if inside[-1] != inside[0] else np.zeros(len(inside))
        taper[part] = np.sin(np.pi * turned) ** 2
    found = np.zeros(count // 2 + 1)
    for row in values * taper:
        energy = float(row @ row)
        if energy > 0.0:
            found += np.abs(np.fft.rfft(np.bincount(bins, row, minlength=count))) ** 2 / energy
    return found


def _peaks(periods: FloatArray, power: FloatArray, fine: float, coarse: float) -> tuple[float, ...]:
    """Where the power is largest beside its level, the clearest first.

    fine, coarse : what the whole record and one stretch of it can tell apart; between them lie side lobes, which come last
    """
    span = periods[-1] - periods[0]
    parts = np.array_split(power, int(np.clip(span / (WIDE * coarse), 1, ABOUT)))
    level = np.concatenate([np.full(len(part), np.median(part)) for part in parts])
    clear = np.where(level > 0.0, power / np.where(level > 0.0, level, 1.0), 0.0)
    order = [int(k) for k in np.argsort(clear)[::-1] if clear[k] > 0.0]
    found: list[float] = []
    for apart in (2.0 * coarse, 2.0 * fine):
        for k in order:
            if len(found) == MOST:
                break
            if all(abs(periods[k] - other) >= apart for other in found):
                found.append(float(periods[k]))
    return tuple(found)
