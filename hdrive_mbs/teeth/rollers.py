"""Generators with rollers: a thin ring under two or four radial forces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from hdrive_mbs.conversions import degrees
from hdrive_mbs.quantities import parameter
from hdrive_mbs.teeth.deformation import DeformationLaw, FloatArray


def two_forces(angle: FloatArray) -> FloatArray:
    """Shape of a thin ring pulled apart at s = 0 and pi:  sin s + (pi/2 - s) cos s - 4/pi,  0 <= s <= pi.

    Times P r^3/(4 E I) this is the radial displacement (Timoshenko, Strength of Materials, part II,
    art. on thin rings); its Fourier series is  (8/pi) sum cos(n s)/(n^2 - 1)^2, n = 2, 4, 6 ...
    """
    s = np.mod(np.asarray(angle, float), np.pi)
    return np.asarray(np.sin(s) + (np.pi / 2.0 - s) * np.cos(s) - 4.0 / np.pi, float)


@dataclass(frozen=True, kw_only=True)
class FourForceDeformation(DeformationLaw):
    """A ring pressed outwards by four equal forces at +-b and pi +- b from the major axis.

    w = w0 (f(s - b) + f(s + b)) / (2 f(b)),   f: see two_forces

    which between the forces is  w0 (A cos s + s sin s sin b - 4/pi) / (A - 4/pi)  with
    A = sin b + (pi/2 - b) cos b.  Here w0 is the displacement on the major axis, which is the
    largest one outwards as long as tan b <= pi/2 - b, that is up to 40.7 degrees.  Inwards, on the
    minor axis, it is 0.99 w0 for b = 20, 1.09 w0 for 30 and 1.20 w0 for 35 degrees.

    Source: thin-ring theory (Timoshenko, Strength of Materials, part II), in this use M. N. Ivanov,
    Wave gears, 1981 (b of 20 to 35 degrees).  Leaves out the contact width of the rollers, shear,
    the stiffening by the teeth and the pull of the cup.
    """

    amplitude: float = parameter("m", "w0, radial displacement on the major axis", above=0.0, high=0.1)
    force_angle: float = parameter("rad", "b, angle of the forces from the major axis", low=0.0, high=degrees(40.0))

    def radial(self, angle: FloatArray) -> FloatArray:
        s, b = np.asarray(angle, float), self.force_angle
        shape = two_forces(s - b) + two_forces(s + b)
        return np.asarray(self.amplitude * shape / (2.0 * two_forces(np.array(b))), float)

    def scaled(self, amplitude: float) -> Self:
        return self.replacing(amplitude=amplitude)


@dataclass(frozen=True, kw_only=True)
class TwoRollerDeformation(DeformationLaw):
    """A ring pressed outwards by two rollers on the major axis.

    w = w0 (sin s + (pi/2 - s) cos s - 4/pi) / (pi/2 - 4/pi)   for 0 <= s <= pi, then repeated.

    On the minor axis w is -0.918 w0, less than outwards: the second stage reaches less deep.

    Source: Timoshenko, Strength of Materials, part II (thin ring under two opposite forces).
    Leaves out the contact width of the rollers, shear, and the stiffening by the teeth.
    """

    amplitude: float = parameter("m", "w0, radial displacement on the major axis", above=0.0, high=0.1)

    def radial(self, angle: FloatArray) -> FloatArray:
        return np.asarray(self.amplitude * two_forces(angle) / (np.pi / 2.0 - 4.0 / np.pi), float)

    def scaled(self, amplitude: float) -> Self:
        return self.replacing(amplitude=amplitude)
