"""Mass, centre of mass and inertia tensor of what turns as one rigid body."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hdrive_mbs.tracked import cosine, sine

Vector = tuple[float, float, float]
Tensor = tuple[Vector, Vector, Vector]


@dataclass(frozen=True)
class RigidMass:
    """A rigid body in its own frame, which turns with it; the origin lies on the axis.

    mass : kg
    centre : centre of mass [m], shape (3,)
    inertia : tensor about the origin [kg m^2], 3x3
    """

    mass: float
    centre: Vector
    inertia: Tensor

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
        lean = sine(tilt)
        axis = (lean * cosine(tilt_angle), lean * sine(tilt_angle), cosine(tilt))
        centre = (eccentricity * cosine(angle), eccentricity * sine(angle), 0.0)
        tensor = _tensor(lambda i, j: (transverse if i == j else 0.0) + (polar - transverse) * (axis[i] * axis[j]))
        return cls(mass, centre, _sum(tensor, _steiner(mass, centre)))

    @classmethod
    def point(cls, mass: float, at: Vector) -> RigidMass:
        """A mass at a point [kg, m]."""
        return cls(mass, at, _steiner(mass, at))

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
        x, y, z = self.centre
        there = (x, y, z + axial)
        before, after = _steiner(self.mass, self.centre), _steiner(self.mass, there)
        return RigidMass(self.mass, there, _tensor(lambda i, j: self.inertia[i][j] - before[i][j] + after[i][j]))

    def balanced(self) -> RigidMass:
        """The same body without unbalance: what a Campbell diagram is computed with."""
        transverse = self.transverse
        tensor = ((transverse, 0.0, 0.0), (0.0, transverse, 0.0), (0.0, 0.0, self.polar))
        return RigidMass(self.mass, (0.0, 0.0, self.centre[2]), tensor)

    def __add__(self, other: RigidMass) -> RigidMass:
        mass = self.mass + other.mass
        x, y, z = (self.mass * a + other.mass * b for a, b in zip(self.centre, other.centre, strict=True))
        centre = (x / mass, y / mass, z / mass) if mass > 0.0 else (x, y, z)
        return RigidMass(mass, centre, _sum(self.inertia, other.inertia))

    @property
    def unbalance(self) -> tuple[float, float, float, float]:
        """x and y part of the static unbalance m e [kg m] and J_xz, J_yz [kg m^2], in the frame of the body."""
        return self.mass * self.centre[0], self.mass * self.centre[1], self.inertia[0][2], self.inertia[1][2]

    @property
    def static_unbalance(self) -> complex:
        """m e as a complex number: x part + i y part [kg m], in the frame of the body."""
        return complex(*self.unbalance[:2])

    @property
    def product_unbalance(self) -> complex:
        """J_xz + i J_yz [kg m^2]: the moment of a spin w is w^2 times it (M_x = J_yz w^2, M_y = -J_xz w^2)."""
        return complex(*self.unbalance[2:])


def _tensor(entry: Callable[[int, int], float]) -> Tensor:
    """A symmetric tensor from its entries on and above the diagonal."""
    xx, xy, xz, yy, yz, zz = (entry(i, j) for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)))
    return (xx, xy, xz), (xy, yy, yz), (xz, yz, zz)


def _sum(a: Tensor, b: Tensor) -> Tensor:
    return _tensor(lambda i, j: a[i][j] + b[i][j])


def _steiner(mass: float, centre: Vector) -> Tensor:
    """m (|c|^2 E - c c^T)."""
    x, y, z = centre
    square = x * x + y * y + z * z
    return _tensor(lambda i, j: mass * ((square if i == j else 0.0) - centre[i] * centre[j]))


NOTHING = RigidMass(0.0, (0.0, 0.0, 0.0), ((0.0, 0.0, 0.0),) * 3)
"""What a flange without mass brings."""
