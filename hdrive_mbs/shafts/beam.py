"""A uniform round beam between two stations: stiffness, mass, gyroscopic and damping matrices.

All matrices are 12x12 over [xa, ya, za, psia, thetaa, phia, xb, yb, zb, psib, thetab, phib]; end a
has the lower z.  Tilts are those of the cross-sections, psi about x and theta about y, so the axis of
a beam without shear has dx/dz = theta and dy/dz = -psi.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import Described, parameter
from hdrive_mbs.shafts.section_geometry import CircularSection
from hdrive_mbs.tracked_arrays import added_at, array_of, scaled, zeros

FloatArray = npt.NDArray[np.float64]

_X_PLANE = ((0, 4, 6, 10), (1.0, 1.0, 1.0, 1.0))
_Y_PLANE = ((1, 3, 7, 9), (1.0, -1.0, 1.0, -1.0))
"""Places in the 12-vector and signs of (displacement, slope) at ends a and b in each bending plane."""

_POINTS, _WEIGHTS = (0.5 * values for values in np.polynomial.legendre.leggauss(4))
_POINTS = _POINTS + 0.5
"""Gauss points on [0, 1], exact to degree 7; products of cubic shapes have degree 6."""


def _along_plane(values: FloatArray, plane: tuple[tuple[int, ...], tuple[float, ...]]) -> FloatArray:
    """The four entries of one bending plane as a row over the 12-vector."""
    places, signs = plane
    row = np.zeros(12)
    row[list(places)] = values * np.array(signs)
    return row


@dataclass(frozen=True, kw_only=True)
class Beam(Described):
    """A straight uniform beam of a section that is alike in all directions.

        E I s'' + G A_s (v' - s) = 0,   G A_s (v' - s)' = 0       in both planes (v, s) = (x, theta), (y, -psi)
        E A z'' = 0,   G Ip phi'' = 0

    is solved exactly between the ends, which gives the shapes and the stiffness; Phi = 12 E I / (G A_s L^2).
    The inertia matrices use the same shapes (consistent), so frequencies come out too high: with N elements along a pinned
    beam, w^2 by (k h)^4 / 720 for Euler-Bernoulli, and by the order h^2 w^2 rho A / (12 G A_s) with shear, which is
    constant along an element (k the wave number, h = L).  Source: J. S. Przemieniecki, Theory
    of Matrix Structural Analysis (1968), ch. 5, 11; M. Friswell et al., Dynamics of Rotating Machines (2010),
    ch. 4-5.  Leaves out the softening by axial force and by torque, and the warping of the sections.
    """

    length: float = parameter("m", "distance L from end a to end b", above=0.0)
    area: float = parameter("m^2", "area A of the section", above=0.0)
    second_moment: float = parameter("m^4", "second moment of area I about a diameter", above=0.0)
    polar_moment: float = parameter("m^4", "polar moment of area Ip", above=0.0)
    youngs_modulus: float = parameter("Pa", "Young's modulus E", above=0.0)
    shear_modulus: float = parameter("Pa", "shear modulus G", above=0.0)
    density: float = parameter("kg/m^3", "density rho; 0 for a massless beam", low=0.0)
    shear_area: float | None = parameter(
        "m^2", "A_s = kappa A of Timoshenko's beam; none or infinite: Euler-Bernoulli", default=None, above=0.0
    )

    def __post_init__(self) -> None:
        if self.shear_area == math.inf:
            object.__setattr__(self, "shear_area", None)
        super().__post_init__()

    @classmethod
    def circular(
        cls, *, length: float, diameter: float, bore: float = 0.0, youngs_modulus: float, shear_modulus: float, density: float, shear: bool
    ) -> Self:
        """From the diameters [m]; with ``shear`` the shear area is Cowper's (Timoshenko), without it Euler-Bernoulli."""
        section = CircularSection(diameter=diameter, bore=bore)
        return cls(
            length=length,
            area=section.area,
            second_moment=section.second_moment,
            polar_moment=section.polar_moment,
            youngs_modulus=youngs_modulus,
            shear_modulus=shear_modulus,
            density=density,
            shear_area=section.shear_area(youngs_modulus, shear_modulus) if shear else None,
        )

    @property
    def shear_parameter(self) -> float:
        """Phi = 12 E I / (G A_s L^2): share of shear in the flexibility; 0 for Euler-Bernoulli."""
        if self.shear_area is None:
            return 0.0
        return 12.0 * self.youngs_modulus * self.second_moment / (self.shear_modulus * self.shear_area * self.length**2)

    def end_polar_inertia(self) -> float:
        """rho Ip L / 2 [kg m^2]: polar inertia of the half at each end, to be lumped to the station there."""
        return 0.5 * self.density * self.polar_moment * self.length

    def split(self, xi: float) -> tuple[Beam, Beam]:
        """The beams from end a to xi and from xi to end b, with 0 < xi < 1 the share of the length."""
        if not 0.0 < xi < 1.0:
            raise ParameterError(
                f"A beam of {self.length:g} m cannot be split at {xi * self.length:g} m (xi = {xi:g}): the point must lie "
                "between its ends, 0 < xi < 1. At an end, use the station there."
            )
        return self.replacing(length=xi * self.length), self.replacing(length=(1.0 - xi) * self.length)

    def shape(self, xi: float) -> FloatArray:
        """6x12 matrix N: [x, y, z, psi, theta, phi] of the section at xi L from end a is N times the 12-vector.

        With zeta = 1 - xi, Phi the shear parameter, and (1 + Phi) as common divisor, in each plane (v, s):

            v :  1 - 3 xi^2 + 2 xi^3 + Phi zeta,   L (xi zeta^2 + Phi xi zeta / 2),
                 3 xi^2 - 2 xi^3 + Phi xi,        -L (xi^2 zeta + Phi xi zeta / 2)
            s : -6 xi zeta / L,   zeta (1 - 3 xi + Phi),   6 xi zeta / L,   xi (3 xi - 2 + Phi)

        z and phi are linear.  Exact for static loads at the ends only.
        """
        if not 0.0 <= xi <= 1.0:
            raise ParameterError(f"xi = {xi:g}: must lie on the beam, from 0 at end a to 1 at end b (length {self.length:g} m).")
        phi, length, zeta = self.shear_parameter, self.length, 1.0 - xi
        displacement = np.array(
            [
                zeta**2 * (1.0 + 2.0 * xi) + phi * zeta,
                length * xi * zeta * (zeta + 0.5 * phi),
                xi**2 * (1.0 + 2.0 * zeta) + phi * xi,
                -length * xi * zeta * (xi + 0.5 * phi),
            ]
        ) / (1.0 + phi)
        slope = np.array(
            [-6.0 * xi * zeta / length, zeta * (1.0 - 3.0 * xi + phi), 6.0 * xi * zeta / length, xi * (1.0 - 3.0 * zeta + phi)]
        ) / (1.0 + phi)
        shape = np.zeros((6, 12))
        shape[0] = _along_plane(displacement, _X_PLANE)
        shape[1] = _along_plane(displacement, _Y_PLANE)
        shape[3] = -_along_plane(slope, _Y_PLANE)
        shape[4] = _along_plane(slope, _X_PLANE)
        for row in (2, 5):
            shape[row, row], shape[row, row + 6] = zeta, xi
        return shape

    def bending_stiffness(self) -> FloatArray:
        """Lateral part of the stiffness: bending and shear in both planes.  Per plane, over (va, sa, vb, sb):

        E I / ((1 + Phi) L^3) [[12, 6L, -12, 6L], [., (4 + Phi) L^2, -6L, (2 - Phi) L^2], [., ., 12, -6L], [., ., ., (4 + Phi) L^2]]
        """
        phi, length = self.shear_parameter, self.length
        near, far = (4.0 + phi) * length**2, (2.0 - phi) * length**2
        plane = array_of(
            [
                [12.0, 6.0 * length, -12.0, 6.0 * length],
                [6.0 * length, near, -6.0 * length, far],
                [-12.0, -6.0 * length, 12.0, -6.0 * length],
                [6.0 * length, far, -6.0 * length, near],
            ]
        )
        plane = scaled(self.youngs_modulus * self.second_moment / ((1.0 + phi) * length**3), plane)
        stiffness = zeros((12, 12), like=plane)
        for places, signs in (_X_PLANE, _Y_PLANE):
            stiffness[np.ix_(places, places)] = plane * np.outer(signs, signs)
        return stiffness

    def stiffness(self) -> FloatArray:
        """Bending and shear in both planes, E A / L along z, G Ip / L about z."""
        stiffness = self.bending_stiffness()
        for row, spring in ((2, self.youngs_modulus * self.area), (5, self.shear_modulus * self.polar_moment)):
            along = scaled(spring / self.length, np.array([[1.0, -1.0], [-1.0, 1.0]]))
            stiffness = added_at(stiffness, np.array([row, row + 6]), along)
        return stiffness

    def mass(self, *, rotary_inertia: bool = True) -> FloatArray:
        """Consistent mass, integral of rho A (Nx'Nx + Ny'Ny + Nz'Nz) + rho I (Npsi'Npsi + Ntheta'Ntheta) along the beam.

        phi has no entries here: see ``polar_mass`` and ``end_polar_inertia``.  ``rotary_inertia=False`` leaves out
        rho I, as closed forms for thin shafts do.  The weight is this matrix times the acceleration of
        gravity (-9.81 in y at both ends), and so has moments at the ends.
        """
        across = self.density * self.area
        tilting = self.density * self.second_moment if rotary_inertia else 0.0
        return self._integral(np.diag([across, across, across, tilting, tilting, 0.0]))

    def polar_mass(self) -> FloatArray:
        """Consistent polar inertia, rho Ip L / 6 [[2, 1], [1, 2]] over (phia, phib)."""
        return self._integral(np.diag([0.0, 0.0, 0.0, 0.0, 0.0, self.density * self.polar_moment]))

    def gyroscopic(self) -> FloatArray:
        """Consistent gyroscopic matrix G at unit spin: M q'' + spin G q' + K q = 0.

        Per length, a slice of polar inertia rho Ip that spins at W about +z resists with

            Mx = + rho Ip W theta',   My = - rho Ip W psi'

        as a station does.  The whole beam has one spin here; where the ends may spin apart, lump
        ``end_polar_inertia`` to the stations instead.
        """
        polar = np.zeros((6, 6))
        polar[3, 4], polar[4, 3] = 1.0, -1.0
        return self._integral(self.density * self.polar_moment * polar)

    def circulatory(self) -> FloatArray:
        """Matrix C of damping that turns with the shaft: the forces on the ends are -beta Kb q' - beta spin C q.

        The material of the shaft sees the rates in the frame that spins with it, q' - spin J q, where J turns a
        lateral vector by +90 degrees about z, (x, y) -> (-y, x) and (psi, theta) -> (-theta, psi).  With Kb the
        ``bending_stiffness``, which is alike in both planes, damping of beta Kb times these rates gives

            force = -beta Kb (q' - spin J q),   C = -Kb J    (skew)

        It drives forward whirl slower than the spin and damps all other whirl.  What it gives to the whirl comes
        out of the spin.  For energy to balance, the spin needs the torque about z (half at each end if spin is the mean)

            torque = beta (q.C q' - spin q.Kb q)

        Leaves out hysteresis that does not depend on frequency, and the damping of shrink fits and splines.
        """
        turn = np.zeros((12, 12))
        for first, second in ((0, 1), (3, 4), (6, 7), (9, 10)):
            turn[first, second], turn[second, first] = -1.0, 1.0
        return -self.bending_stiffness() @ turn

    def _integral(self, density: FloatArray) -> FloatArray:
        """Integral of N' density N along the beam; density, 6x6 per length, is symmetric or skew and so is the result."""
        total = np.zeros((12, 12))
        for xi, weight in zip(_POINTS, _WEIGHTS):
            shape = self.shape(float(xi))
            total += self.length * weight * (shape.T @ density @ shape)
        mirror = 1.0 if np.array_equal(density, density.T) else -1.0
        return 0.5 * (total + mirror * total.T)  # exactly, in spite of rounding
