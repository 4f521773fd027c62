"""Residuals and their slopes as short-time spectra that keep the energy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.locate.motion import KnownForce, Motion, columns_of
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.noise import Whitener
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

WINDOW = 1024
"""Samples of a window; a quarter of the record where that is shorter."""
HIGHEST = 0.25
"""Of the sample rate: frequencies above it are left out."""
UNKNOWN = 1e3
"""Standard deviation of an unknown offset, in those of the noise."""
LATTICES = 4
"""Positions of the steps of a rounded column at which its error is worked out."""


@dataclass(frozen=True, eq=False)
class Spectra:
    """Short-time spectra of one trial in standard deviations of the noise.

    values : shape (windows, bins, columns of the trial, 1 + parameters): the residuals, then what a unit of each parameter
        changes in them.  The squares add up to those of the samples below HIGHEST.
    frequencies : rad/s, (bins,);  bands : first bin of each band, an octave wide
    whitening : of each column, (windows, bins, columns);  quiet : what values and whitening were multiplied by, where
        rounding makes more than white noise;  window : samples;  starts : first sample of each window
    """

    trial: Trial
    values: ComplexArray
    frequencies: FloatArray
    bands: npt.NDArray[np.int64]
    whitening: ComplexArray
    quiet: FloatArray
    window: int
    starts: npt.NDArray[np.int64]

    @property
    def widths(self) -> npt.NDArray[np.int64]:
        """Bins of each band."""
        return np.diff(np.append(self.bands, len(self.frequencies)))


def spectra(
    simulator: Simulator,
    hypothesis: Hypothesis,
    z: FloatArray,
    motions: Sequence[Motion],
    forces: Sequence[Sequence[KnownForce]] | None = None,
) -> tuple[Spectra, ...]:
    """Of each trial at the full sample rate.

    After the search coordinates of the hypothesis come unknown offsets of columns that have one, with precision 1.
    motions : at z, with the forces of each trial, if there are any
    """
    sizes = []
    for k, motion in enumerate(motions):
        for column, item in motion.trial.measured.items():
            if item.offset > 0.0:
                sizes.append((k, column, min(item.offset, UNKNOWN * item.total)))
    made = []
    for k, motion in enumerate(motions):
        trial = motion.trial
        rows = _slopes(simulator, k, hypothesis, z, motion, forces[k] if forces else ())
        for number, column, size in sizes:
            row = np.zeros(rows[0].shape)
            if number == k:
                there = np.isfinite(trial.columns[column])
                row[list(trial.columns).index(column)] = -_whitened(trial.measured[column], np.where(there, size, 0.0))
            rows.append(row)
        made.append(_of(motion, np.array(rows)))
    return tuple(made)


def _slopes(
    simulator: Simulator, number: int, hypothesis: Hypothesis, z: FloatArray, motion: Motion, forces: Sequence[KnownForce]
) -> list[FloatArray]:
    """Whitened residuals of a trial, and their slopes in each search coordinate: zero where they cannot be had."""
    steps = hypothesis.steps(z)
    points = []
    for k, step in enumerate(steps):
        moved = z.copy()
        moved[k] += step
        if hypothesis.clipped(moved)[k] == z[k]:  # at its upper limit
            moved[k], steps[k] = z[k] - step, -step
        points.append(moved)
    base = _residuals(motion.trial, motion.columns)
    found = columns_of(simulator, number, hypothesis, points, forces)
    others = [None if item is None else _residuals(motion.trial, item) for item in found]
    return [base, *(np.zeros(base.shape) if item is None else (item - base) / step for item, step in zip(others, steps, strict=True))]


def _residuals(trial: Trial, columns: Mapping[str, FloatArray]) -> FloatArray:
    """Whitened, (columns, samples); 0 where nothing was measured."""
    left = {column: np.where(np.isfinite(values), values - columns[column], 0.0) for column, values in trial.columns.items()}
    return np.array([_whitened(trial.measured[column], values) for column, values in left.items()])


def _whitened(measured: Measured, values: FloatArray) -> FloatArray:
    return Whitener(replace(measured, offset=0.0), np.ones(len(values), dtype=bool))(values)


def _of(motion: Motion, rows: FloatArray) -> Spectra:
    """rows : shape (1 + parameters, columns, samples)."""
    trial = motion.trial
    window = min(WINDOW, trial.samples // 4 // 2 * 2)
    bins = int(HIGHEST * window) + 1
    frequencies = np.asarray(2.0 * np.pi * np.arange(bins) / (window * trial.every), float)
    edges = [0, 1]
    while 2 * edges[-1] < bins:
        edges.append(2 * edges[-1])
    bands = np.array(edges)
    values = np.moveaxis(windowed(rows, window, bins), (0, 1), (3, 2))
    impulse = np.eye(1, trial.samples)[0]
    response = [_whitened(trial.measured[column], impulse)[:window] for column in trial.columns]
    late = np.array([trial.measured[column].late * trial.every for column in trial.columns])
    whitening = np.fft.rfft(np.array(response), n=window)[:, :bins].T * np.exp(1j * frequencies[:, None] * late)
    quiet = np.ones((*values.shape[:2], len(trial.columns)))
    for k, column in enumerate(trial.columns):
        quiet[:, :, k] = _quieter(trial.measured[column], motion.columns[column], window, bins, bands)
    starts = window // 2 * (np.arange(len(values)) - 1)
    return Spectra(trial, values * quiet[..., None], frequencies, bands, whitening * quiet, quiet, window, starts)


def windowed(rows: FloatArray, window: int, bins: int) -> ComplexArray:
    """Spectra of half-overlapping sine windows, shape (..., windows, bins): the first begins half a window before the rows.

    sin^2 + cos^2 = 1, so the squares of all windows add up to those of the samples; bins above 0 stand for two.
    """
    hop, samples = window // 2, rows.shape[-1]
    count = -(-samples // hop) + 1
    padded = np.pad(rows, (*((0, 0),) * (rows.ndim - 1), (hop, (count + 1) * hop - hop - samples)))
    cut = padded[..., hop * np.arange(count)[:, None] + np.arange(window)] * sine(window)
    return np.asarray(np.fft.rfft(cut, axis=-1)[..., :bins] * np.sqrt(2.0 / window))


def joined(values: ComplexArray, window: int, samples: int) -> FloatArray:
    """The samples of spectra of ``windowed``, shape (windows, bins) -> (samples,)."""
    hop = window // 2
    parts = np.fft.irfft(values * np.sqrt(window / 2.0), n=window, axis=-1) * sine(window)
    total = np.zeros((len(parts) + 1) * hop)
    for k, part in enumerate(parts):
        total[k * hop : k * hop + window] += part
    return total[hop : hop + samples]


def sine(window: int) -> FloatArray:
    """The window."""
    return np.asarray(np.sin(np.pi * (np.arange(window) + 0.5) / window))


def _quieter(measured: Measured, simulated: FloatArray, window: int, bins: int, bands: npt.NDArray[np.int64]) -> FloatArray:
    """What spectra of a rounded column are multiplied by, (windows, bins): the rounding of a slow signal is not white.

    Its error is worked out on the simulated column for several positions of the steps; where a band holds more of it than of
    white noise, the noise there counts as so much larger.
    """
    other = max(measured.noise, measured.coloured[0])
    if not measured.resolution > 2.0 * other:
        return np.ones((1, bins))
    noise = other * np.random.default_rng(0).standard_normal(len(simulated))
    power = np.zeros((1, 1))
    for k in range(LATTICES):
        read = (simulated + noise) / measured.resolution + k / LATTICES
        error = (np.round(read) - k / LATTICES) * measured.resolution - simulated
        power = power + np.abs(windowed(_whitened(measured, error), window, bins)) ** 2 / LATTICES
    widths = np.diff(np.append(bands, bins))
    mean = np.add.reduceat(power, bands, axis=1) / widths
    return np.asarray(np.repeat(1.0 / np.sqrt(np.maximum(mean, 1.0)), widths, axis=1))
