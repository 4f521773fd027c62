"""The ellipse that two complex amplitudes describe."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

STRAIGHT = 1e-9
"""Minor over major semi-axis below which an orbit counts as a straight line, without a direction."""


@dataclass(frozen=True, eq=False)
class WhirlOrbit:
    """Motion x = Re[X exp(i w t)], y = Re[Y exp(i w t)], w > 0, of a place; all amplitudes 0-peak.

    x + i y = p+ exp(i w t) + p- exp(-i w t)  with  p+ = (X + i Y)/2,  p- = conj(X - i Y)/2: two circles, one about
    +z and one about -z.  The semi-axes of the ellipse are |p+| + |p-| and ||p+| - |p-||.

    x, y : complex amplitudes, of any shape
    sense : +1 or -1, sense of the spin about z: forward whirl has the same
    """

    x: ComplexArray
    y: ComplexArray
    sense: FloatArray

    @property
    def positive(self) -> ComplexArray:
        """p+, the circle about +z."""
        return 0.5 * (self.x + 1j * self.y)

    @property
    def negative(self) -> ComplexArray:
        """p-, the circle about -z."""
        return np.asarray(0.5 * np.conj(self.x - 1j * self.y), complex)

    @property
    def forward(self) -> FloatArray:
        """Radius of the circle in the sense of the spin."""
        return np.where(self.sense > 0.0, np.abs(self.positive), np.abs(self.negative))

    @property
    def backward(self) -> FloatArray:
        """Radius of the circle against the spin."""
        return np.where(self.sense > 0.0, np.abs(self.negative), np.abs(self.positive))

    @property
    def major(self) -> FloatArray:
        """Major semi-axis: the largest distance from the static position, 0-peak."""
        return np.asarray(np.abs(self.positive) + np.abs(self.negative))

    @property
    def minor(self) -> FloatArray:
        """Minor semi-axis, 0-peak."""
        return np.asarray(np.abs(np.abs(self.positive) - np.abs(self.negative)))

    @property
    def inclination(self) -> FloatArray:
        """Direction of the major axis from x towards y [rad], above -pi/2 and up to pi/2; arbitrary for a circle."""
        angle = 0.5 * (np.angle(self.positive) + np.angle(self.negative))
        return np.asarray(0.5 * np.pi - np.mod(0.5 * np.pi - angle, np.pi))

    @property
    def whirl(self) -> FloatArray:
        """+1 forward, -1 backward, 0 for a straight line."""
        return np.where(self.minor <= STRAIGHT * self.major, 0.0, np.sign(self.forward - self.backward))


def lag(amplitude: ComplexArray) -> FloatArray:
    """Angle [rad] by which Re[A exp(i w t)] follows cos(w t), -arg A, from -pi/4 up to 7 pi/4.

    The cut lies below zero so that rounding about zero does not look like a whole turn.
    """
    return np.asarray(np.mod(0.25 * np.pi - np.angle(amplitude), 2.0 * np.pi) - 0.25 * np.pi)
