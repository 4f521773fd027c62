"""What every law of the deformed neutral fibre offers."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, Self

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import LawError
from hdrive_mbs.quantities import Described

FloatArray = npt.NDArray[np.float64]
SAMPLES = 2048
"""Samples of w around the fibre; a law is known up to its 1023rd harmonic."""
AXIS_TOLERANCE = 5.0
"""Degrees that the highest place of the wave may lie off s = 0: w there and at s = 0 then differ by 1.5 % of w0 for two waves."""


@dataclass(frozen=True, kw_only=True)
class DeformationLaw(Described):
    """Radial displacement w(s) [m] of the neutral fibre, s [rad] from the generator's major axis.

    A law gives w only.  The tangential displacement and the rotation of the section follow from
    the fibre's constant length (``fibre.py``).  Positive is outwards.

    A law of a user's own subclasses this and writes ``radial`` and ``scaled``, or uses
    ``FunctionDeformation`` or ``TableDeformation``.
    """

    _kind: ClassVar[str] = "deformation law"

    def radial(self, angle: FloatArray) -> FloatArray:
        """w [m] at angles [rad] from the major axis."""
        raise NotImplementedError

    def scaled(self, amplitude: float) -> Self:
        """The same shape with w = amplitude [m] on the major axis."""
        raise NotImplementedError

    @property
    def on_major_axis(self) -> float:
        """w [m] at s = 0: the w0 of the paper."""
        return float(self.radial(np.zeros(1))[0])

    @property
    def waves(self) -> int:
        """Number of waves: the strongest harmonic of w."""
        return int(np.argmax(np.abs(self.harmonics())))

    def harmonics(self) -> npt.NDArray[np.complex128]:
        """Coefficients c_n of w = Re sum c_n exp(i n s), the mean c_0 replaced by 0.

        Raises LawError where w is not finite, not periodic, zero, or has a mean that a fibre of
        constant length cannot have: to first order the mean of w is zero (dv/ds = -w has to close),
        to second order it is a contraction of about w0^2/r0, which ``fibre.py`` adds.  A mean up to
        2 % of the largest \\|w\\| is taken for that contraction, or for rounding, and is dropped.
        """
        return _harmonics(self)

    def check(self) -> None:
        """Raise LawError for a law that no wave generator makes, or whose angles are not counted from the major axis."""
        name, waves = type(self).__name__, self.waves
        if waves < 2:
            raise LawError(
                f"{name}: w has one wave around the circumference, which only moves the fibre as a whole; a wave generator has two or more."
            )
        off = float(np.degrees(-np.angle(self.harmonics()[waves]) / waves))
        if abs(off) > AXIS_TOLERANCE:
            raise LawError(
                f"{name}: the wave is highest {abs(off):.3g} deg {'after' if off > 0.0 else 'before'} s = 0; s counts from the major axis, "
                f"where w is largest outwards (within {AXIS_TOLERANCE:g} deg). Shift the angles."
            )


@lru_cache(maxsize=256)
def _harmonics(law: DeformationLaw) -> npt.NDArray[np.complex128]:
    angles = 2.0 * np.pi * np.arange(SAMPLES) / SAMPLES
    name = type(law).__name__
    try:
        w = np.asarray(law.radial(angles), float)
    except TypeError as error:
        raise LawError(f"{name}: w does not accept an array of angles ({error}). Use numpy functions: np.cos, not math.cos.") from error
    if w.shape != angles.shape or not np.isfinite(w).all():
        raise LawError(f"{name}: w must be a finite number [m] at every angle of a turn; it has to accept an array of angles.")
    largest = float(np.max(np.abs(w)))
    if largest == 0.0:
        raise LawError(f"{name}: w is zero everywhere; a wave generator has to deform the flexspline.")
    after = np.asarray(law.radial(angles + 2.0 * np.pi), float)
    if np.max(np.abs(after - w)) > 1e-6 * largest:
        raise LawError(
            f"{name}: w is not the same after a turn (differs by {1e3 * np.max(np.abs(after - w)):.3g} mm); it must be periodic."
        )
    coefficients = np.fft.rfft(w) / SAMPLES
    coefficients[1:] *= 2.0
    mean = float(coefficients[0].real)
    if abs(mean) > 0.02 * largest:
        raise LawError(
            f"{name}: the mean of w over a turn is {1e3 * mean:.4g} mm at a largest |w| of {1e3 * largest:.4g} mm; a fibre of "
            "constant length closes only if the mean is zero (to first order). Subtract the mean, or correct the fibre radius by it."
        )
    coefficients[0] = 0.0
    coefficients[-1] = 0.0
    # what the law itself is continuous to decides how far the series goes; below 1e-13 is rounding
    last = int(np.flatnonzero(np.abs(coefficients) > 1e-13 * largest)[-1])
    coefficients = coefficients[: last + 1]
    coefficients[np.abs(coefficients) < 1e-14 * largest] = 0.0
    coefficients.setflags(write=False)
    return coefficients
