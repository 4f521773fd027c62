"""Residuals and their slopes as short-time spectra that keep the energy."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, islice

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.locate.line import Line, of_windows, window_of
from hdrive_mbs.diagnosis.locate.motion import KnownForce, Motion, columns_of
from hdrive_mbs.diagnosis.locate.observer import FINER, NEAR, Observer, averaged
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.noise import Whitener
from hdrive_mbs.diagnosis.simulator import AT_ONCE, Simulator
from hdrive_mbs.diagnosis.trial import Trial

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]
Slopes = npt.NDArray[np.float32]
Values = npt.NDArray[np.complex64]

HIGHEST, HIGHEST_OF_ROTORS = 0.25, 0.16
"""Of the sample rate: frequencies above it are left out."""
UNKNOWN = 1e3
"""Standard deviation of an unknown offset, in those of the noise."""
NARROW = 8
"""Most bins of a band for rotors: their forces have orders of the speed."""
TOGETHER = 15
"""Rows whose spectra are worked out together: the fewer the less memory, the more the quicker an observer goes through them."""
LATTICES = 4
"""Positions of the steps of a rounded column at which its error is worked out."""


@dataclass(frozen=True, eq=False)
class Spectra:
    """Short-time spectra of one trial in standard deviations of the noise.

    values : shape (windows, bins, columns of the trial, 1 + parameters): the residuals, then what a unit of each parameter
        changes in them.  The squares add up to those of the samples below HIGHEST.  Seven digits are kept, far more than any noise leaves.
    frequencies : rad/s, (bins,);  bands : first bin of each band, an octave wide, or less for rotors
    whitening : what the spectrum of a residual is multiplied by, (windows, bins, columns, columns)
    window : samples;  starts : first sample of each window
    slopes : what parameters change in the columns, by sample; differences, good to less than the digits that are kept
    """

    trial: Trial
    values: Values
    frequencies: FloatArray
    bands: npt.NDArray[np.int64]
    whitening: ComplexArray
    window: int
    starts: npt.NDArray[np.int64]
    slopes: Slopes

    @property
    def widths(self) -> npt.NDArray[np.int64]:
        """Bins of each band."""
        return np.diff(np.append(self.bands, len(self.frequencies)))


def spectra(
    simulator: Simulator,
    hypothesis: Hypothesis,
    z: FloatArray,
    motions: Sequence[Motion],
    lines: Sequence[Line],
    forces: Sequence[Sequence[KnownForce]] | None = None,
    slopes: Sequence[Slopes] | None = None,
) -> tuple[Spectra, ...]:
    """Of each trial at the full sample rate.

    After the search coordinates of the hypothesis come unknown offsets of columns that have one, with precision 1.
    motions : at z, with the forces of each trial, if there are any;  lines : linearised about them
    slopes : of other spectra of these trials nearby; without them they are worked out
    """
    if slopes is None:
        slopes = slopes_of(simulator, hypothesis, z, [not item.network.is_lateral for item in motions], motions, forces)
    sizes = []
    for k, motion in enumerate(motions):
        for column, item in motion.trial.measured.items():
            if item.offset > 0.0:
                sizes.append((k, column, min(item.offset, UNKNOWN * item.total)))
    made = []
    for k, motion in enumerate(motions):
        trial = motion.trial
        whiten = lines[k].observer is None
        own = [_residuals(trial, motion.columns, whiten)]
        rest = [(column, size) if number == k else None for number, column, size in sizes]
        rows = chain(own, (row.astype(float) for row in slopes[k]), (item and _offset(trial, whiten, *item) for item in rest))
        made.append(_of(motion, lines[k], rows, 1 + len(slopes[k]) + len(sizes), slopes[k]))
    return tuple(made)


def _offset(trial: Trial, whiten: bool, column: str, size: float) -> FloatArray:
    """What an offset of a column changes in the residuals of its trial, (columns, samples)."""
    row = np.zeros((len(trial.columns), trial.samples))
    shift = np.where(np.isfinite(trial.columns[column]), size, 0.0)
    row[list(trial.columns).index(column)] = -_whitened(trial.measured[column], shift) if whiten else -shift
    return row


def slopes_of(
    simulator: Simulator,
    hypothesis: Hypothesis,
    z: FloatArray,
    whiten: Sequence[bool],
    motions: Sequence[Motion],
    forces: Sequence[Sequence[KnownForce]] | None = None,
) -> list[Slopes]:
    """What a unit of each search coordinate changes in the residuals of each trial, (parameters, columns, samples).

    Zero where that cannot be had.
    """
    steps = hypothesis.steps(z)
    points = []
    for k, step in enumerate(steps):
        moved = z.copy()
        moved[k] += step
        if hypothesis.clipped(moved)[k] == z[k]:  # at its upper limit
            moved[k], steps[k] = z[k] - step, -step
        points.append(moved)
    bases = [_residuals(motion.trial, motion.columns, own) for motion, own in zip(motions, whiten, strict=True)]
    made = [np.zeros((len(points), *base.shape), np.float32) for base in bases]
    for first in range(0, len(points), AT_ONCE):  # those of all points at once take 3 MB each on the rotor bench
        some = points[first : first + AT_ONCE]
        plain = None if forces is not None and any(forces) else simulator.columns_at(hypothesis, some)
        for k, motion in enumerate(motions):
            if plain is None:
                found = columns_of(simulator, k, hypothesis, some, forces[k] if forces else ())
            else:
                found = [item[k] for item in plain]
            for at, item in enumerate(found, first):
                if item is not None:
                    made[k][at] = (_residuals(motion.trial, item, whiten[k]) - bases[k]) / steps[at]
    return made


def _residuals(trial: Trial, columns: Mapping[str, FloatArray], whiten: bool) -> FloatArray:
    """(columns, samples); 0 where nothing was measured."""
    left = {column: np.where(np.isfinite(values), values - columns[column], 0.0) for column, values in trial.columns.items()}
    return np.array([_whitened(trial.measured[column], values) if whiten else values for column, values in left.items()])


def _whitened(measured: Measured, values: FloatArray) -> FloatArray:
    return Whitener(replace(measured, offset=0.0), np.ones(len(values), dtype=bool), steady=True)(values)


def _of(motion: Motion, line: Line, rows: Iterator[FloatArray | None], count: int, slopes: Slopes) -> Spectra:
    """rows : of the residuals, parameters and offsets, (columns, samples) each, None where zero, made a few at a time;  count : of them."""
    trial, observer = motion.trial, line.observer
    window = window_of(trial)
    bins = int((HIGHEST if observer is None else HIGHEST_OF_ROTORS) * window) + 1
    frequencies = np.asarray(2.0 * np.pi * np.arange(bins) / (window * trial.every), float)
    edges = [0, 1]
    while 2 * edges[-1] < bins and (observer is None or edges[-1] < NARROW):
        edges.append(2 * edges[-1])
    bands = np.array(edges if observer is None else [*edges, *range(edges[-1] + NARROW, bins - NARROW // 2, NARROW)])
    starts = window // 2 * (np.arange(windows_of(trial.samples, window)) - 1)
    if observer is not None:  # what its errors hold of the noise before the end of a record shows whole in whole windows alone
        starts = starts[starts + window <= trial.samples]
    quiet = np.ones((len(starts), bins, len(trial.columns)))
    for k, column in enumerate(trial.columns):
        factor = _quieter(trial.measured[column], motion.columns[column], window, bins, bands)
        quiet[:, :, k] = factor[: len(starts)]
    impulse = np.eye(1, trial.samples)[0]
    response = np.array([_whitened(trial.measured[column], impulse)[:window] for column in trial.columns])
    if observer is None:
        late = np.array([trial.measured[column].late * trial.every for column in trial.columns])
        flat = np.fft.rfft(response, n=window)[:, :bins].T * np.exp(1j * frequencies[:, None] * late) * quiet
        whitening = flat[..., None] * np.eye(len(late))
    else:
        whitening = _against(observer, np.fft.rfft(response, n=FINER * window).T, quiet, trial.every)
    seen = np.zeros((len(starts), bins, len(trial.columns), count), np.complex64)
    given = ((k, row) for k, row in enumerate(rows) if row is not None)
    while some := list(islice(given, TOGETHER)):
        left = np.array([row for _, row in some])
        if observer is not None:
            left = observer.errors(left)
        for (k, _), row in zip(some, left, strict=True):
            own = np.moveaxis(windowed(row, window, bins)[:, : len(starts)], 0, 2)
            seen[..., k] = own * quiet if observer is None else (whitening @ own[..., None])[..., 0]
    return Spectra(trial, seen, frequencies, bands, whitening, window, starts, slopes)


def _against(observer: Observer, whitener: ComplexArray, quiet: FloatArray, every: float) -> ComplexArray:
    """What makes the noise in an observer's errors white and independent, (windows, bins, columns, columns).

    whitener : of each column, at FINER points a bin;  quiet : (windows, bins, columns)
    """
    windows, bins, columns = quiet.shape
    step = 2.0 * np.pi / (every * (2 * (len(whitener) - 1)))
    points = np.arange(-NEAR, FINER * (bins - 1) + NEAR + 1)
    transfer = observer.noise_transfer(points * step)
    size = 1.0 / np.abs(whitener[np.abs(points)])
    transfer *= size[None, :, None, :]
    total = np.zeros((windows, bins, columns, columns), complex)
    white = np.all(quiet == 1.0, axis=(0, 1))
    alike = [np.flatnonzero(white), *np.flatnonzero(~white)[:, None]]
    for some in filter(len, alike):
        parts = (transfer[k : k + 1, ..., some] for k in range(len(transfer)))  # those of all stretches at once are 30 MB on a rotor line
        power = np.concatenate([averaged(part @ np.swapaxes(part.conj(), 2, 3), bins) for part in parts])
        total += of_windows(power, windows) / quiet[:, :, some[:1], None] ** 2
    return np.asarray(np.linalg.inv(np.linalg.cholesky(total)))


def windowed(rows: FloatArray, window: int, bins: int) -> ComplexArray:
    """Spectra of half-overlapping sine windows, shape (..., windows, bins): the first begins half a window before the rows.

    sin^2 + cos^2 = 1, so the squares of all windows add up to those of the samples; bins above 0 stand for two.
    """
    hop, samples = window // 2, rows.shape[-1]
    count = windows_of(samples, window)
    padded = np.pad(rows, (*((0, 0),) * (rows.ndim - 1), (hop, (count + 1) * hop - hop - samples)))
    cut = padded[..., hop * np.arange(count)[:, None] + np.arange(window)] * sine(window)
    return np.asarray(np.fft.rfft(cut, axis=-1)[..., :bins] * np.sqrt(2.0 / window))


def windows_of(samples: int, window: int) -> int:
    """How many windows ``windowed`` makes."""
    return -(-samples // (window // 2)) + 1


def joined(values: ComplexArray, window: int, samples: int) -> FloatArray:
    """The samples of spectra of ``windowed``, shape (windows, bins) -> (samples,)."""
    hop = window // 2
    parts = np.fft.irfft(values * np.sqrt(window / 2.0), n=window, axis=-1) * sine(window)
    total = np.zeros(max((len(parts) + 1) * hop, hop + samples))
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
