"""Sums of sines whose peaks are small for their power."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

ROUNDS, RESTARTS = 60, 4
"""Rounds of clipping from each start, and random starts besides Schroeder's."""


def multisine(points: FloatArray, harmonics: Sequence[int], amplitudes: FloatArray, phases: FloatArray) -> FloatArray:
    """Sum of A_k cos(2 pi h_k t + p_k) at points t of a period of 1; amplitudes 0-peak."""
    angles = 2.0 * np.pi * np.outer(points, np.asarray(harmonics, float)) + phases
    return np.asarray(np.cos(angles) @ amplitudes)


def schroeder_phases(amplitudes: FloatArray) -> FloatArray:
    """p_k = -2 pi sum over l < k of (k - l) q_l with the shares of power q: about flat in time.

    Source: Schroeder, IEEE Trans. Information Theory 16 (1970) 85.  Meant for lines that follow each other evenly.
    """
    power = np.asarray(amplitudes, float) ** 2
    shares = power / max(float(power.sum()), 1e-300)
    return -2.0 * np.pi * np.concatenate(([0.0], np.cumsum(np.cumsum(shares))[:-1]))


def low_phases(harmonics: Sequence[int], amplitudes: FloatArray, seed: int = 0) -> FloatArray:
    """Phases with a small peak: Schroeder's and random ones, improved by clipping, whichever is best.

    Each round clips the signal at part of its peak and takes over the phases of what is left, at the wanted amplitudes.
    Source: Van der Ouderaa, Schoukens, Renneboog, IEEE Trans. Instrumentation and Measurement 37 (1988) 145.
    """
    rng = np.random.default_rng(seed)
    lines = np.asarray(harmonics)
    number = 1 << int(np.ceil(np.log2(8.0 * lines.max())))
    starts = [schroeder_phases(amplitudes), *rng.uniform(0.0, 2.0 * np.pi, (RESTARTS, len(lines)))]
    best, least = starts[0], np.inf
    for phases in starts:
        for k in range(ROUNDS):
            spectrum = np.zeros(number // 2 + 1, complex)
            np.add.at(spectrum, lines, 0.5 * number * amplitudes * np.exp(1j * phases))
            signal = np.fft.irfft(spectrum, number)
            peak = float(np.abs(signal).max())
            if peak < least:
                best, least = phases, peak
            limit = (0.75 + 0.2 * k / ROUNDS) * peak
            phases = np.angle(np.fft.rfft(np.clip(signal, -limit, limit))[lines])
    return np.asarray(best)


def spread_harmonics(low: int, high: int, number: int) -> tuple[int, ...]:
    """So many different harmonics from low to high, about even on a logarithmic scale; fewer where there are no more."""
    wanted = np.round(np.geomspace(low, high, number)).astype(int)
    return tuple(int(item) for item in np.unique(wanted))
