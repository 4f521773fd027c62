"""Mass, centre of mass and inertia tensor of what turns as one rigid body."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class RigidMass:
    """A rigid body in its own frame, which turns with it; the origin lies on the axis.

    mass : kg
    centre : centre of mass [m], shape (3,)
    inertia : tensor about the origin [kg m^2], 3x3
    """

    mass: float
    centre: tuple[float, float, float]
    inertia: tuple[tuple[float, float, float], ...]

    @classmethod
    def rotor(
        cls,
        mass: float,
        polar: float,
        transverse: float,
        *,
        eccentricity: float = 0.0,
        angle: float = 0.0,
        tilt: float = 0.0,
        tilt_angle: float = 0.0,
    ) -> RigidMass:
        """A disc whose centre of mass lies off the axis and whose principal axis leans.

        polar, transverse : moments of inertia about the centre of mass [kg m^2]
        eccentricity, angle : e [m] and its direction from x towards y [rad] (static unbalance m e)
        tilt, tilt_angle : lean of the principal axis [rad] and the direction in which it leans at +z
            (dynamic unbalance: moment (Jt - Jp) tilt w^2 about the axis at tilt_angle + 90 degrees)

        The tensor is R diag(Jt, Jt, Jp) R^T with the exact rotation R that leans the axis, moved to the
        origin by m (|c|^2 E - c c^T).
        """
        direction = np.array([math.cos(tilt_angle), math.sin(tilt_angle), 0.0])
        axis = math.sin(tilt) * direction + np.array([0.0, 0.0, math.cos(tilt)])
        tensor = transverse * np.eye(3) + (polar - transverse) * np.outer(axis, axis)
        centre = np.array([eccentricity * math.cos(angle), eccentricity * math.sin(angle), 0.0])
        return cls._made(mass, centre, tensor + mass * _steiner(centre))

    @classmethod
    def _made(cls, mass: float, centre: FloatArray, inertia: FloatArray) -> RigidMass:
        x, y, z = (float(value) for value in centre)
        rows = tuple((float(a), float(b), float(c)) for a, b, c in inertia)
        return cls(mass, (x, y, z), rows)

    @property
    def polar(self) -> float:
        """Moment of inertia about the axis [kg m^2]."""
        return self.inertia[2][2]

    @property
    def transverse(self) -> float:
        """Mean moment of inertia about x and y through the origin [kg m^2]."""
        return 0.5 * (self.inertia[0][0] + self.inertia[1][1])

    def moved(self, axial: float) -> RigidMass:
        """The same body in a frame whose origin lies ``axial`` [m] further back on the axis."""
        if axial == 0.0:
            return self
        centre = np.array(self.centre)
        there = centre + np.array([0.0, 0.0, axial])
        tensor = np.array(self.inertia) - self.mass * _steiner(centre) + self.mass * _steiner(there)
        return self._made(self.mass, there, tensor)

    def balanced(self) -> RigidMass:
        """The same body without unbalance: what a Campbell diagram is computed with."""
        tensor = np.diag([self.transverse, self.transverse, self.polar])
        return self._made(self.mass, np.array([0.0, 0.0, self.centre[2]]), tensor)

    def __add__(self, other: RigidMass) -> RigidMass:
        mass = self.mass + other.mass
        moment = self.mass * np.array(self.centre) + other.mass * np.array(other.centre)
        return self._made(mass, moment / mass if mass > 0.0 else moment, np.array(self.inertia) + np.array(other.inertia))

    @property
    def static_unbalance(self) -> complex:
        """m e as a complex number: x part + i y part [kg m], in the frame of the body."""
        return self.mass * complex(self.centre[0], self.centre[1])

    @property
    def product_unbalance(self) -> complex:
        """J_xz + i J_yz [kg m^2]: the moment of a spin w is w^2 times it (M_x = J_yz w^2, M_y = -J_xz w^2)."""
        return complex(self.inertia[0][2], self.inertia[1][2])


def _steiner(centre: FloatArray) -> FloatArray:
    return np.asarray(float(centre @ centre) * np.eye(3) - np.outer(centre, centre))


NOTHING = RigidMass(0.0, (0.0, 0.0, 0.0), ((0.0, 0.0, 0.0),) * 3)
"""What a flange without mass brings."""
