"""Residuals and their slopes as short-time spectra that keep the energy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.locate.motion import Motion
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.noise import Whitener
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import AnalysisError

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


def spectra(simulator: Simulator, fitted: Fitted, motions: Sequence[Motion]) -> tuple[tuple[Spectra, ...], FloatArray]:
    """Of each trial, at the full sample rate, and the precision of the prior of each parameter.

    After the search coordinates of the hypothesis come unknown offsets of columns that have one.

    Raises AnalysisError where the fitted model cannot be run.
    """
    still = [replace(trial, measured={c: replace(m, offset=0.0) for c, m in trial.measured.items()}) for trial in simulator.trials]
    full = Simulator(still, simulator.step)
    rows = _slopes(full, fitted)
    parameters = len(rows) - 1
    for segment in full.segments:
        trial = simulator.trials[segment.trial]
        measured, values = trial.measured[segment.column], trial.columns[segment.column]
        if measured.offset > 0.0:
            size = min(measured.offset, UNKNOWN * measured.total)
            row = np.zeros(full.size)
            row[segment.span] = -_whitened(measured, np.where(np.isfinite(values), size, 0.0))
            rows.append(row)
    made = []
    for k, motion in enumerate(motions):
        spans = [segment.span for segment in full.segments if segment.trial == k]
        made.append(_of(motion, np.array([[row[span] for span in spans] for row in rows])))
    return tuple(made), np.concatenate([fitted.hypothesis.precisions, np.ones(len(rows) - 1 - parameters)])


def residuals(motion: Motion, like: Spectra) -> ComplexArray:
    """Spectra of the residuals of another run of the same trial, (windows, bins, columns)."""
    trial = motion.trial
    there = {column: np.isfinite(values) for column, values in trial.columns.items()}
    left = {column: np.where(there[column], values - motion.columns[column], 0.0) for column, values in trial.columns.items()}
    rows = np.array([_whitened(trial.measured[column], values) for column, values in left.items()])
    return np.asarray(np.moveaxis(windowed(rows, like.window, len(like.frequencies)), 0, 2) * like.quiet)


def _slopes(full: Simulator, fitted: Fitted) -> list[FloatArray]:
    """Residuals, and their slopes in each search coordinate."""
    hypothesis, z = fitted.hypothesis, fitted.z
    steps = hypothesis.steps(z)
    points = [z.copy()]
    for k, step in enumerate(steps):
        moved = z.copy()
        moved[k] += step
        if hypothesis.clipped(moved)[k] == z[k]:  # at its upper limit
            moved[k], steps[k] = z[k] - step, -step
        points.append(moved)
    base, *others = full.residuals(hypothesis, points)
    if base is None:
        raise AnalysisError("The fitted model cannot be run with all samples; use a shorter step.")
    return [base, *(np.zeros(full.size) if item is None else (item - base) / step for item, step in zip(others, steps, strict=True))]


def _whitened(measured: Measured, values: FloatArray) -> FloatArray:
    return Whitener(replace(measured, offset=0.0), np.ones(len(values), dtype=bool))(values)


def _of(motion: Motion, rows: FloatArray) -> Spectra:
    """rows : shape (1 + parameters, columns, samples)."""
    trial = motion.trial
    window = min(WINDOW, trial.samples // 4 // 2 * 2)
    bins = int(HIGHEST * window) + 1
    frequencies = 2.0 * np.pi * np.arange(bins) / (window * trial.every)
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
