"""Residuals through an observer: what they hold that the model cannot go on with by itself.

A light damped line goes on vibrating long after a force has ended, so spectra of short stretches do not show which force
acted in a stretch.  An observer takes the free vibration out: with residuals y_k of the columns

    e_k = y_k - C x_k,   x_{k+1} = A_d x_k + L e_k,   A_d = exp(A T)

and L the steady Kalman gain for white forces at all places, the errors e_k forget within a few samples.  A force F(w)
shows in them as E(w) H(w) F(w) and noise of spectral density N(w) as E N E^H, with H the transfer of the line and
E(z) = 1 - C (z - A_d + L C)^-1 L.  Nothing is lost: E can be inverted.  Source: unknown inputs of linear systems, e.g.
Anderson, Moore, Optimal Filtering, 9; Gillijns, De Moor, Automatica 43, 2007.

A is constant in a stretch of half a window.  Leaves out how it changes within one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.linalg import expm

from hdrive_mbs.errors import AnalysisError

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

STRONG = 1e4
"""Power of the white force at each place over that of the noise, where it shows most: the larger the sooner it forgets."""
HIDDEN = 1e-9
"""Share of what the force that shows most shows, below which one counts as hidden, by symmetry say, and is not reckoned with: to show
as much as the others it would have to be without limit."""
ROUNDS, MORE = 400, 40
"""Of the covariance's recursion in the first stretch, and in each of the next."""
GROWS = 1.1
"""Factor by which errors may grow within a stretch: a line that turns freely has a motion that neither grows nor fades."""
STRIDE = 8
"""Samples that are worked out at a time."""
FINER, NEAR = 4, 10
"""Points in a bin at which noise is averaged over the window's own spectrum, and how many to each side."""


@dataclass(frozen=True, eq=False)
class Observer:
    """The observer of one trial, by stretch.

    kept : A_d - L C, (stretches, states, states);  gain : L, (stretches, states, columns);  read : C, (stretches, columns, states)
    length : samples of a stretch;  every : s
    """

    kept: FloatArray
    gain: FloatArray
    read: FloatArray
    length: int
    every: float

    def errors(self, rows: FloatArray) -> FloatArray:
        """Of rows, shape (rows, columns, samples)."""
        number, columns, samples = rows.shape
        stretches = len(self.kept)
        found = np.zeros((stretches * self.length, columns, number))  # begins as the rows and becomes their errors, step by step
        found[:samples] = np.moveaxis(rows, 2, 0).transpose(0, 2, 1)
        state = np.zeros((self.kept.shape[1], number))
        for k in range(stretches):
            own = self.kept[k], self.gain[k], self.read[k]
            whole, rest = _strided(*own, STRIDE), _strided(*own, self.length % STRIDE)
            end = (k + 1) * self.length
            for at in range(k * self.length, end, STRIDE):
                count = min(STRIDE, end - at)
                seen, driven, moved, pushed = whole if count == STRIDE else rest
                given = found[at : at + count].reshape(-1, number).copy()
                found[at : at + count] = (given - seen @ state - driven @ given).reshape(count, columns, number)
                state = moved @ state + pushed @ given
        return np.ascontiguousarray(found[:samples].transpose(2, 1, 0))

    def moved(self, a: FloatArray, c: FloatArray) -> Observer:
        """With the same gains for another A and C, (stretches, ...)."""
        kept = [expm(one * self.every) - gain @ read for one, gain, read in zip(a, self.gain, c, strict=True)]
        return Observer(np.array(kept), self.gain, np.array(c), self.length, self.every)

    def noise_transfer(self, rates: FloatArray) -> ComplexArray:
        """E at frequencies in rad/s, shape (stretches, rates, columns, columns)."""
        z = np.exp(1j * rates * self.every)
        one = np.eye(self.read.shape[1])
        found = np.empty((len(self.kept), len(rates), *one.shape), complex)
        for k, (values, left, right) in enumerate(self._modes):
            residues = (left.T[:, :, None] * right[:, None, :]).reshape(len(values), -1)
            found[k] = one - (1.0 / (z[:, None] - values) @ residues).reshape(len(z), *one.shape)
        return found

    @cached_property
    def _modes(self) -> list[tuple[ComplexArray, ComplexArray, ComplexArray]]:
        """Of A_d - L C in each stretch: values, C V and V^-1 L."""
        made = []
        for kept, gain, read in zip(self.kept, self.gain, self.read, strict=True):
            values, vectors = np.linalg.eig(kept)
            made.append((values, read @ vectors, np.linalg.solve(vectors, gain.astype(complex))))
        return made

    @property
    def growth(self) -> float:
        """Logarithm by which the slowest error grows in a sample, the largest of all stretches; inf where it is no number."""
        if not np.isfinite(self.kept).all():
            return math.inf
        return math.log(max(float(np.max(np.abs(np.linalg.eigvals(kept)))) for kept in self.kept))


def _strided(kept: FloatArray, gain: FloatArray, read: FloatArray, count: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """What so many samples show of the state at their beginning and of each other, and where they take the state."""
    columns, states = read.shape
    seen = np.zeros((count * columns, states))
    driven = np.zeros((count * columns, count * columns))
    moved, pushed = np.eye(states), np.zeros((states, count * columns))
    for k in range(count):
        at = slice(k * columns, (k + 1) * columns)
        seen[at], driven[at] = read @ moved, read @ pushed
        moved, pushed = kept @ moved, kept @ pushed
        pushed[:, at] = gain
    return seen, driven, moved, pushed


def observer(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray, noise: FloatArray, every: float, length: int) -> Observer:
    """For x' = A x + B f, y = C x + D f in each stretch.

    a : (stretches, states, states), and so on;  noise : standard deviation of each column;  every : s;  length : of a stretch

    Raises AnalysisError where errors grow: residuals cannot be followed then.
    """
    kept, gains = [], []
    covariance = None
    scale = noise.copy()
    for k in range(len(a)):
        free = expm(a[k] * every)
        moved = free @ b[k] * every
        shown = np.abs(_steady(free, moved, c[k], d[k], every)) / scale[:, None]
        most = np.max(shown, axis=(0, 1))
        size = np.where(most > HIDDEN * np.max(most, initial=0.0), np.sqrt(STRONG) / np.maximum(most, 1e-300), 0.0)
        push, through = moved * size, d[k] * size
        process, cross = push @ push.T, push @ through.T
        direct = through @ through.T + np.diag(scale**2)
        covariance = process.copy() if covariance is None else covariance
        for _ in range(ROUNDS if k == 0 else MORE):
            total = c[k] @ covariance @ c[k].T + direct
            gain = np.linalg.solve(total, (free @ covariance @ c[k].T + cross).T).T
            covariance = free @ covariance @ free.T + process - gain @ total @ gain.T
            covariance = 0.5 * (covariance + covariance.T)
        kept.append(free - gain @ c[k])
        gains.append(gain)
    found = Observer(np.array(kept), np.array(gains), np.array(c), length, every)
    if not found.growth <= math.log(GROWS) / length:
        grown = math.exp(min(found.growth * length, 700.0))
        raise AnalysisError(
            f"The residuals cannot be followed along the records: their errors would grow by a factor of {grown:.3g} within"
            f" {length * every:.3g} s. Record another column, like the angle of the shaft."
        )
    return found


def _steady(free: FloatArray, moved: FloatArray, c: FloatArray, d: FloatArray, every: float) -> ComplexArray:
    """Transfers at a few frequencies below a quarter of the sample rate, shape (frequencies, columns, forces)."""
    z = np.exp(1j * np.geomspace(0.01, 0.5 * np.pi, 40))
    system = z[:, None, None] * np.eye(len(free)) - free
    return np.asarray(c @ np.linalg.solve(system, np.broadcast_to(moved, (len(z), *moved.shape)).astype(complex)) + d)


def averaged(power: ComplexArray, bins: int) -> ComplexArray:
    """Of a density at FINER points a bin, NEAR before bin 0 and after the last, over the sine window's own spectrum.

    power : shape (stretches, points, columns, columns) -> (stretches, bins, columns, columns)
    """
    offsets = np.arange(-NEAR, NEAR + 1) / FINER
    # the sine window is the sum of two rectangular ones, half a bin to either side
    weights = (np.sinc(offsets - 0.5) + np.sinc(offsets + 0.5)) ** 2
    weights /= weights.sum()
    found = np.zeros((power.shape[0], bins, *power.shape[2:]), power.dtype)
    for k, weight in enumerate(weights):
        found += weight * power[:, k : k + FINER * (bins - 1) + 1 : FINER]
    return found
