"""Matrices of the rotor from Timoshenko's beam equations alone: nothing of hdrive_mbs and nothing of ROSS goes in.

In the complex coordinates w = x + i y and s = theta - i psi a rotor that is alike in all directions has one plane:

    M q'' + C q' - i W P q' + K q = f,        q = [w0, s0, w1, s1, ...],   W the spin

Consistent mass, rotary inertia, gyroscopic moments and shear with Cowper's coefficient, as ROSS's ShaftElement has them
by default (shear_effects, rotary_inertia, gyroscopic, shear_method_calc="cowper").
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from benchmarks.rotor_speed import rotor

FloatArray = npt.NDArray[np.float64]

AREA = math.pi / 4.0 * rotor.DIAMETER**2
SECOND_MOMENT = math.pi / 64.0 * rotor.DIAMETER**4
POISSON = rotor.YOUNGS_MODULUS / (2.0 * rotor.SHEAR_MODULUS) - 1.0
BENDING = rotor.YOUNGS_MODULUS * SECOND_MOMENT
"""E I [N m^2]."""
SHEAR = 6.0 * (1.0 + POISSON) / (7.0 + 6.0 * POISSON) * rotor.SHEAR_MODULUS * AREA
"""kappa G A [N], solid round section: G. R. Cowper, J. Appl. Mech. 33 (1966)."""


@dataclass(frozen=True, kw_only=True)
class Matrices:
    """Of one plane: mass M with rotary inertia, polar inertia P, stiffness K and damping C with both bearings."""

    mass: FloatArray
    polar: FloatArray
    stiffness: FloatArray
    damping: FloatArray


def matrices(elements: int, bearing_damping: float = 0.0) -> Matrices:
    """Assemble equal elements, the discs and the bearings."""
    size = 2 * (elements + 1)
    mass, polar, stiffness, damping = (np.zeros((size, size)) for _ in range(4))
    element = _element(rotor.LENGTH / elements)
    for first in range(0, 2 * elements, 2):
        for whole, part in zip((mass, polar, stiffness), element, strict=True):
            whole[first : first + 4, first : first + 4] += part
    for station, disc in zip(rotor.disc_stations(elements), rotor.DISCS, strict=True):
        w, s = 2 * station, 2 * station + 1
        mass[w, w] += disc.mass
        mass[s, s] += disc.transverse_inertia
        polar[s, s] += disc.polar_inertia
    for w in (0, 2 * elements):
        stiffness[w, w] += rotor.BEARING_STIFFNESS
        damping[w, w] += bearing_damping
    return Matrices(mass=mass, polar=polar, stiffness=stiffness, damping=damping)


def _element(length: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mass, polar inertia and stiffness over (w, s) at both ends.

    Between loads at its ends a beam obeys E I s'' + kG A g = 0 and (kG A g)' = 0 with the shear angle g = w' - s, so
    g = -(E I / kG A) w''' and w is a cubic a0 + a1 u + a2 u^2 + a3 u^3 in u = z / length.  The shapes follow by
    inverting the cubic's values at the ends; the integrals are Gauss's with 4 points, exact to degree 7.
    """
    flexibility = BENDING / SHEAR / length**2
    powers = np.arange(4.0)

    def displacement(u: float) -> FloatArray:
        return np.asarray(u**powers)

    def slope(u: float) -> FloatArray:
        return np.array([0.0, 1.0, 2.0 * u, 3.0 * u**2 + 6.0 * flexibility]) / length

    shapes = np.linalg.inv(np.array([displacement(0.0), slope(0.0), displacement(1.0), slope(1.0)]))
    shear_angle = np.array([0.0, 0.0, 0.0, -6.0 * flexibility]) / length @ shapes
    mass, polar, stiffness = (np.zeros((4, 4)) for _ in range(3))
    points, weights = np.polynomial.legendre.leggauss(4)
    for u, weight in zip((0.5 + 0.5 * points).tolist(), (0.5 * length * weights).tolist(), strict=True):
        w, s = displacement(u) @ shapes, slope(u) @ shapes
        curvature = np.array([0.0, 0.0, 2.0, 6.0 * u]) / length**2 @ shapes
        tilting = weight * rotor.DENSITY * SECOND_MOMENT * np.outer(s, s)
        mass += weight * rotor.DENSITY * AREA * np.outer(w, w) + tilting
        polar += 2.0 * tilting
        stiffness += weight * (BENDING * np.outer(curvature, curvature) + SHEAR * np.outer(shear_angle, shear_angle))
    return mass, polar, stiffness
