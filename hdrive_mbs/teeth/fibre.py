"""The deformed neutral fibre: v and theta from w and the fibre's constant length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from numpy.polynomial import polynomial

from hdrive_mbs.errors import LawError
from hdrive_mbs.teeth.deformation import DeformationLaw, FloatArray

ComplexArray = npt.NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Fibre:
    """Displacements of the fibre of radius r0 as Fourier series in s, the angle from the major axis.

    A point of the undeformed circle at s goes to  (r0 + w) e_r + v e_t.  Its derivative,
    (w' - v) e_r + (r0 + w + v') e_t, has the length r0 if the fibre keeps its length:

        exact:        (w' - v)^2 + (r0 + w + v')^2 = r0^2,   sin(theta) = (v - w')/r0
        first order:  v' = -w,                               theta = (v - w')/r0

    with theta the rotation of the tangent in the sense of s.  v has mean zero: the fibre does not
    turn as a whole.  Exactly, w cannot be prescribed up to its mean: the closed fibre contracts by
    c = -mean(r0 - sqrt(r0^2 - (w' - v)^2)), for w0 cos 2s about -(9/16) w0^2/r0.

    w, v : coefficients c_n of Re sum c_n exp(i n s), in metres (w including the contraction)
    """

    radius: float
    exact: bool
    w: ComplexArray
    v: ComplexArray

    def radial(self, s: npt.ArrayLike, derivative: int = 0) -> FloatArray:
        """w [m], or its derivative by s."""
        return _series(self.w, s, derivative)

    def tangential(self, s: npt.ArrayLike, derivative: int = 0) -> FloatArray:
        """v [m], or its derivative by s."""
        return _series(self.v, s, derivative)

    def rotation(self, s: npt.ArrayLike) -> FloatArray:
        """theta [rad]."""
        sine = (self.tangential(s) - self.radial(s, 1)) / self.radius
        return np.arcsin(sine) if self.exact else sine

    def rotation_rate(self, s: npt.ArrayLike) -> FloatArray:
        """dtheta/ds."""
        rate = (self.tangential(s, 1) - self.radial(s, 2)) / self.radius
        if not self.exact:
            return rate
        sine = (self.tangential(s) - self.radial(s, 1)) / self.radius
        return np.asarray(rate / np.sqrt(1.0 - sine**2), float)

    def stretch(self, s: npt.ArrayLike) -> FloatArray:
        """Length of the deformed element over that of the undeformed one, less 1."""
        along = self.radius + self.radial(s) + self.tangential(s, 1)
        across = self.radial(s, 1) - self.tangential(s)
        return np.asarray(np.hypot(along, across) / self.radius - 1.0, float)


def _series(coefficients: ComplexArray, s: npt.ArrayLike, derivative: int) -> FloatArray:
    orders = np.arange(len(coefficients))
    terms = coefficients * (1j * orders) ** derivative if derivative else coefficients
    stride = 2 if not np.any(terms[1::2]) else 1
    z = np.exp(1j * stride * np.asarray(s, float))
    return np.asarray(polynomial.polyval(z, terms[::stride]).real, float)


@lru_cache(maxsize=256)
def fibre(law: DeformationLaw, radius: float, exact: bool = True) -> Fibre:
    """The fibre under a law: first order as the paper has it, or with its length kept exactly."""
    w = np.array(law.harmonics())
    v = _integral(-w)
    if exact:
        w, v = _keep_length(w, v, radius)
    return Fibre(radius, exact, w, v)


def _integral(terms: ComplexArray) -> ComplexArray:
    """Coefficients of the integral over s, of mean zero."""
    orders = np.arange(len(terms))
    result = np.zeros_like(terms)
    result[1:] = terms[1:] / (1j * orders[1:])
    return result


def shortening(w: ComplexArray, v: ComplexArray, radius: float, second_order: bool = False) -> ComplexArray:
    """Coefficients of  r0 - sqrt(r0^2 - (w' - v)^2), or of (w' - v)^2/(2 r0), by sampling."""
    samples = max(64, 8 * len(w))
    s = 2.0 * np.pi * np.arange(samples) / samples
    slope = _series(w, s, 1) - _series(v, s, 0)
    steepest = float(np.max(np.abs(slope)))
    if steepest >= radius and not second_order:
        raise LawError(
            f"The fibre (r0 = {1e3 * radius:g} mm) would have to stand upright or fold: dw/ds - v reaches {1e3 * steepest:.4g} mm, "
            "which must stay below r0. Make the deformation law smoother or smaller."
        )
    lost = slope**2 / (2.0 * radius) if second_order else radius - np.sqrt(radius**2 - slope**2)
    terms = np.asarray(np.fft.rfft(lost) / samples, complex)[: 4 * len(w)]
    terms[1:] *= 2.0
    return terms


def _keep_length(w: ComplexArray, v: ComplexArray, radius: float) -> tuple[ComplexArray, ComplexArray]:
    """Contraction and v by fixed-point iteration; each round gains a factor of about w0/r0."""
    size = float(np.max(np.abs(w)))
    for _ in range(30):
        lost = shortening(w, v, radius)
        long = np.zeros(max(len(lost), len(w)), complex)
        long[: len(w)] = w
        contraction = -lost[0].real
        w = np.array(w)
        w[0] = contraction
        rate = -long
        rate[: len(lost)] -= lost
        rate[0] = 0.0
        new = _trimmed(_integral(rate), size)
        change = float(np.max(np.abs(_padded(new, len(v)) - _padded(v, len(new)))))
        v = new
        if change < 1e-15 * size:
            break
    return w, v


def _trimmed(terms: ComplexArray, size: float) -> ComplexArray:
    used = np.flatnonzero(np.abs(terms) > 1e-15 * size)
    return terms[: used[-1] + 1]


def _padded(terms: ComplexArray, length: int) -> ComplexArray:
    return np.concatenate((terms, np.zeros(max(0, length - len(terms)))))
