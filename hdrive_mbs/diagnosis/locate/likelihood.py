"""How likely residuals are if an unknown force acts at one place, whatever its course in time.

In one window and one band the spectra Y (n bins, m columns) are complex normal with covariance

    rho (I + s^2 H H^H)

H the transfer from the force to the columns, s the force's strength over the noise, one of a few values or zero, and
rho >= 1 what else the model lacks there, at its most probable value.  Strengths have a prior and are summed over, so a
force that explains nothing costs.  Parameters come in linearly with their normal prior and are integrated out by
Laplace's method.  Source: latent forces after Alvarez, Luengo, Lawrence (2009), with a free spectrum for a covariance;
evidence after MacKay, Information Theory, Inference and Learning Algorithms, 27.

Leaves out what a force does to the next window, and how the linear model changes within one.  Vibrations that last longer than
a window, like those of rotors, are taken out before (observer.py).  What is slower than a window shows in few bins, and there rho
takes it up as well as a force does: steady forces are hardly placed.  One force is looked for at a time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.locate.spectra import Spectra

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

STRENGTHS = 10.0 ** np.arange(0.0, 9.0)
"""Of s^2 times the mean of |H|^2 in the band."""
ABSENT = 0.9
"""Prior probability that a force is zero in a window and band."""
SMALLEST = 1e-12
"""Precision that a parameter without a prior gets in the determinant."""


@dataclass(frozen=True, eq=False)
class Directions:
    """Orthogonal directions of a place in the columns of one trial.

    along : unit vectors, shape (windows, bins, columns, d);  power : |H|^2 along each, (windows, bins, d)
    """

    along: ComplexArray
    power: FloatArray


def directions(transfer: ComplexArray) -> Directions:
    """Of a transfer, shape (windows, bins, columns, d), made orthogonal one after the other."""
    left = transfer.copy()
    power = np.zeros((*left.shape[:2], left.shape[3]))
    for k in range(left.shape[3]):
        for j in range(k):
            left[..., k] -= left[..., j] * np.sum(left[..., j].conj() * left[..., k], axis=-1)[..., None]
        power[..., k] = np.sum(np.abs(left[..., k]) ** 2, axis=-1)
        left[..., k] /= np.sqrt(np.maximum(power[..., k], 1e-300))[..., None]
    return Directions(left, power)


@dataclass(frozen=True, eq=False)
class Fit:
    """A place in one trial.

    by_window : log likelihood, (windows,);  left : sum of squares that is left, (windows, bands)
    scale : rho, (windows, bands);  strength : most probable s^2, (windows, bins)
    kept : share of the residuals along each direction that is put down to the force, (windows, bins, d); None without a force
    """

    by_window: FloatArray
    left: FloatArray
    scale: FloatArray
    strength: FloatArray
    kept: FloatArray | None


@dataclass(frozen=True, eq=False)
class Explained:
    """A place with its best parameters.

    log_likelihood : parameters integrated out;  z : change of the parameters;  fits : by trial
    curvature, slope : of the misfit in the parameters there, without their prior
    """

    log_likelihood: float
    z: FloatArray
    fits: tuple[Fit, ...]
    curvature: FloatArray
    slope: FloatArray

    @property
    def left(self) -> float:
        """Sum of squares that is left."""
        return float(sum(fit.left.sum() for fit in self.fits))

    @property
    def above_noise(self) -> float:
        """Log likelihood that is missing to that of noise alone: sum of n/2 log(rho), n = left/rho where rho > 1."""
        return float(sum(np.sum(0.5 * fit.left / fit.scale * np.log(fit.scale)) for fit in self.fits))


Place = Sequence[Directions | None]
"""Directions in each trial, None where it does not show."""


class Likelihood:
    """Spectra of all trials with the prior of their parameters.

    at : search coordinates at which the spectra were made;  precision : of the prior of each, about zero
    """

    def __init__(self, given: Sequence[Spectra], at: FloatArray, precision: FloatArray) -> None:
        self.given, self.at, self.precision = tuple(given), at, precision
        self._last: dict[int, tuple[FloatArray, ComplexArray, FloatArray]] = {}
        self._grams: dict[int, FloatArray] = {}

    def forget(self) -> None:
        """Drop what was worked out, to be worked out again when it is asked for."""
        self._last.clear()
        self._grams.clear()

    @property
    def numbers(self) -> int:
        """How many residuals there are."""
        return sum(item.values[..., 0].size for item in self.given)

    def of(self, place: Place | None, z: FloatArray, rounds: int = 2) -> Explained:
        """The likelihood with a force at a place, or with none.

        z : change of the parameters to begin with;  rounds : of fitting them
        """
        shown: Place = place if place is not None else [None] * len(self.given)
        seen = [None if part is None else self.seen(part, k) for k, part in enumerate(shown)]
        for _ in range(rounds):
            fits = [self._fit(k, shown[k], seen[k], z) for k in range(len(self.given))]
            curvature, slope = self._normal(fits, seen)
            ridge = 1e-9 * np.diag(np.diag(curvature)) + SMALLEST * np.eye(len(z))
            z = np.asarray(-np.linalg.solve(curvature + np.diag(self.precision) + ridge, slope + self.precision * self.at), float)
        fits = [self._fit(k, shown[k], seen[k], z) for k in range(len(self.given))]
        curvature, slope = self._normal(fits, seen)
        total = float(sum(fit.by_window.sum() for fit in fits)) - 0.5 * float(self.precision @ (self.at + z) ** 2)
        return Explained(total - 0.5 * _growth(curvature, self.precision), z, tuple(fits), curvature, slope)

    def quickly(self, place: Place, z: FloatArray, like: Explained) -> Explained:
        """With the parameters and the curvature of another result: a lower bound, but for what the force takes of the curvature."""
        left = [self.residuals(k, z)[..., None] for k in range(len(self.given))]
        seen = [None if part is None else np.matmul(np.swapaxes(part.along.conj(), 2, 3), left[k]) for k, part in enumerate(place)]
        fits = [like.fits[k] if part is None else self._fit(k, part, seen[k], z) for k, part in enumerate(place)]
        gained = sum(float((new.by_window - old.by_window).sum()) for new, old in zip(fits, like.fits, strict=True))
        return replace(like, log_likelihood=like.log_likelihood + gained, z=z, fits=tuple(fits))

    def seen(self, part: Directions, k: int) -> ComplexArray:
        """Residuals and slopes along the directions, shape (windows, bins, d, 1 + parameters)."""
        return np.asarray(np.matmul(np.swapaxes(part.along.conj(), 2, 3), self.given[k].values))

    def residuals(self, k: int, z: FloatArray) -> ComplexArray:
        """Spectra of a trial with changed parameters, (windows, bins, columns)."""
        return self._at(k, z)[0]

    def loosened(self, found: Explained, k: int, times: float) -> float:
        """Gain of the log likelihood if the prior of one parameter is that many times wider, all else linear about a result."""

        def value(precision: FloatArray) -> float:
            slope = found.slope + precision * self.at
            system = found.curvature + np.diag(precision) + SMALLEST * np.eye(len(precision))
            best = 0.5 * float(slope @ np.linalg.solve(system, slope)) - 0.5 * float(precision @ self.at**2)
            return best - 0.5 * _growth(found.curvature, precision)

        wide = self.precision.copy()
        wide[k] /= times**2
        return value(wide) - value(self.precision)

    def _fit(self, k: int, place: Directions | None, seen: ComplexArray | None, z: FloatArray) -> Fit:
        item = self.given[k]
        columns, widths = item.values.shape[2], item.widths
        _, total = self._at(k, z)
        numbers = columns * widths
        if place is None or seen is None:
            scale = np.maximum(1.0, total / numbers)
            value = -0.5 * np.sum(numbers * np.log(scale) + total / scale, axis=1)
            return Fit(value, total, scale, np.zeros((len(total), len(item.frequencies))), None)
        explained = np.abs(seen[..., 0] if seen.shape[-1] == 1 else seen @ np.concatenate([[1.0], z])) ** 2
        mean = np.add.reduceat(place.power.sum(axis=2), item.bands, axis=1) / widths
        unit = np.repeat(1.0 / np.maximum(mean, 1e-300), widths, axis=1)
        levels = np.concatenate([[0.0], STRENGTHS])
        priors = np.log(np.concatenate([[ABSENT], np.full(len(STRENGTHS), (1.0 - ABSENT) / len(STRENGTHS))]))
        values = np.empty((len(levels), *total.shape))
        lefts = np.empty_like(values)
        for i, (level, prior) in enumerate(zip(levels, priors, strict=True)):
            grown = 1.0 + level * unit[..., None] * place.power
            growth = np.add.reduceat(np.sum(np.log(grown), axis=2), item.bands, axis=1)
            lefts[i] = total - np.add.reduceat(np.sum(explained * (1.0 - 1.0 / grown), axis=2), item.bands, axis=1)
            scale = np.maximum(1.0, lefts[i] / numbers)
            values[i] = prior - 0.5 * (numbers * np.log(scale) + growth + lefts[i] / scale)
        best, top = np.argmax(values, axis=0), np.max(values, axis=0)
        sums = top + np.log(np.sum(np.exp(values - top), axis=0))
        left = np.take_along_axis(lefts, best[None], axis=0)[0]
        strength = np.repeat(levels[best], widths, axis=1) * unit
        kept = 1.0 - 1.0 / (1.0 + strength[..., None] * place.power)
        return Fit(sums.sum(axis=1), left, np.maximum(1.0, left / numbers), strength, kept)

    def _at(self, k: int, z: FloatArray) -> tuple[ComplexArray, FloatArray]:
        """Residuals of a trial, and their sum of squares by (windows, bands); those that were asked for last are kept."""
        known = self._last.get(k)
        if known is None or not np.array_equal(known[0], z):
            item = self.given[k]
            residuals = np.asarray(item.values @ np.concatenate([[1.0], z]))
            residuals.flags.writeable = False
            energy = np.add.reduceat(np.sum(np.abs(residuals) ** 2, axis=-1), item.bands, axis=1)
            known = self._last[k] = z.copy(), residuals, energy
        return known[1:]

    def _normal(self, fits: Sequence[Fit], seen: Sequence[ComplexArray | None]) -> tuple[FloatArray, FloatArray]:
        """J^T W J and J^T W r."""
        size = len(self.at) + 1
        total = np.zeros((size, size))
        for k, (item, fit, own) in enumerate(zip(self.given, fits, seen, strict=True)):
            total += np.tensordot(1.0 / fit.scale, self._gram(k), axes=2)
            if own is not None and fit.kept is not None:
                weight = np.repeat(1.0 / fit.scale, item.widths, axis=1)[..., None] * fit.kept
                less = (own * np.sqrt(weight)[..., None]).reshape(-1, size)
                total -= less.real.T @ less.real + less.imag.T @ less.imag
        return total[1:, 1:], total[1:, 0]

    def _gram(self, k: int) -> FloatArray:
        """Real part of the products of residuals and slopes of a trial, summed over each band, (windows, bands, 1 + parameters, same)."""
        if k not in self._grams:
            item, made = self.given[k], []
            for first, width in zip(item.bands, item.widths, strict=True):
                own = item.values[:, first : first + width].astype(complex).reshape(len(item.values), -1, item.values.shape[-1])
                parts = np.concatenate([own.real, own.imag], axis=1)
                made.append(np.swapaxes(parts, 1, 2) @ parts)
            self._grams[k] = np.stack(made, axis=1)
        return self._grams[k]


def _growth(curvature: FloatArray, precision: FloatArray) -> float:
    """log det (I + curvature/precision)."""
    free = np.maximum(precision, SMALLEST)
    return float(np.linalg.slogdet(curvature / np.sqrt(np.outer(free, free)) + np.eye(len(free)))[1])
