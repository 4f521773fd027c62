"""The rotor line of seed M in plain numpy: an independent model to check the package against.

Coordinates of a station: x, y, z of the geometric centre, tilts psi and theta, spin phi; rotation
Rx(psi) Ry(theta) Rz(phi).  Planes of bending (x, +theta) and (y, -psi).

    M(q) q'' + h(q, q') = -K q - C q' - cubic(q) + weight + drive

Rotors and the drive disc follow the exact equations of ``derive_rotor_body``.  Bearing rings (and a
rotor with ``exact=False``) follow (8) of the paper without its line in the spin equation, which breaks
the energy balance:

    Jt psi'' + Jp phi' theta' = Mx,     Jt theta'' - Jp phi' psi' = My,     Jp phi'' = Mz

with the unbalance terms of the undeflected position.  (8) leaves out Jp phi'' theta of the exact first
line, which is linear in the tilt: the torque that accelerates the rotor, at its lever.  In a run-up it
is not small beside light damping; ``test_reference_rotors`` says how much it is on M-REF.

Shafts are massless Euler-Bernoulli sections; their damping is ``damping`` x K for bending, axial
motion and torsion, on rates in the inertial frame (not rotating).  Their forces act on the
coordinates themselves, so that energies are exact.

``full``: a bearing ring is a station; between ring and housing stiffness and damping in x and y, from
the ring to ground in z and in both tilts, from the housing to ground in x and y.

``simplified``: section 5, one section from rotor to rotor across the bearing, and on it

    (m_h + m_b) N1^T N1 + Jt N2^T N2,   c_h N1^T N1 + c_tilt N2^T N2,   k_h N1^T N1 + k_tilt N2^T N2

in (x, theta) and in (y, -psi): N1 deflection and N2 slope of the section at the bearing.  Section 5 has
neither spin nor axial motion of the bearing: its polar inertia is left out (``spin_inertia`` takes it in,
at the linear interpolation of phi), its axial stiffness and damping act on the linear interpolation of z.

It imports nothing from the package.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from tests.verification import rotor_body_equations as exact

Array = np.ndarray[Any, Any]
GRAVITY = 9.81


@dataclass(frozen=True, kw_only=True)
class Body:
    """Disc, rotor or ring; directions are angles in the body, from its x axis."""

    mass: float
    polar: float
    transverse: float
    eccentricity: float = 0.0
    eccentricity_direction: float = 0.0
    tilt: float = 0.0
    tilt_direction: float = 0.0
    exact: bool = True

    @property
    def diagonal(self) -> Array:
        return np.array([self.mass, self.mass, self.mass, self.transverse, self.transverse, self.polar])

    @property
    def balanced(self) -> bool:
        return self.eccentricity == 0.0 and self.tilt == 0.0

    @property
    def constant(self) -> bool:
        """The mass matrix does not depend on the position."""
        return self.balanced and not self.exact

    @property
    def numbers(self) -> tuple[float, ...]:
        """In the order of the generated equations."""
        return (
            *(self.mass, self.transverse, self.polar, self.eccentricity),
            *(self.eccentricity_direction, self.tilt, self.tilt_direction),
        )

    def inertia(self, q: Array, v: Array) -> tuple[Any, Any]:
        """M and h of M q'' + h = Q."""
        psi, theta, phi = q[3:].tolist()
        rates = psi_t, theta_t, phi_t = v[3:].tolist()
        if self.exact and self.balanced:
            return exact.balanced_inertia(self.mass, self.transverse, self.polar, psi, theta, phi, *rates)
        if self.exact:
            return exact.inertia(*self.numbers, psi, theta, phi, *rates)
        M, h = exact.inertia(*self.numbers, 0.0, 0.0, phi, 0.0, 0.0, phi_t)
        momentum = self.polar * phi_t
        return M, (*h[:3], h[3] + momentum * theta_t, h[4] - momentum * psi_t, h[5])

    def kinetic_energy(self, q: Array, v: Array) -> float:
        if self.exact:
            return float(exact.kinetic_energy(*self.numbers, *q[3:].tolist(), *v.tolist()))
        M, _ = exact.inertia(*self.numbers, 0.0, 0.0, float(q[5]), 0.0, 0.0, 0.0)
        return 0.5 * float(v @ np.array(M) @ v)

    def height(self, q: Array) -> float:
        return self.mass_centre(q)[1]

    def mass_centre(self, q: Array) -> tuple[float, float, float]:
        tilts = q[3:5].tolist() if self.exact else (0.0, 0.0)
        return exact.mass_centre(self.eccentricity, self.eccentricity_direction, *q[:3].tolist(), *tilts, float(q[5]))  # type: ignore[no-any-return]

    def weight(self, q: Array) -> Array:
        tilts = q[3:5].tolist() if self.exact else (0.0, 0.0)
        slope = exact.height_slope(self.eccentricity, self.eccentricity_direction, *tilts, float(q[5]))
        return -self.mass * GRAVITY * np.array(slope)


@dataclass(frozen=True, kw_only=True)
class Bearing:
    stiffness: float
    damping: float
    tilt_stiffness: float
    tilt_damping: float
    housing_mass: float
    housing_stiffness: float
    housing_damping: float
    axial_stiffness: float = 0.0
    axial_damping: float = 0.0
    cubic: float = 0.0
    """N/m3, in x and in y each on its own (the .^ of (5)), between ring and housing."""


@dataclass(frozen=True, kw_only=True)
class Station:
    name: str
    z: float
    body: Body
    bearing: Bearing | None = None


@dataclass(frozen=True, kw_only=True)
class Drive:
    """Torque on the first station: peak clip((target - speed) / band, -1, 1)."""

    peak: float = 20.0
    target: float = 1000.0
    band: float = 5.0

    def __call__(self, speed: float) -> float:
        return self.peak * min(max((self.target - speed) / self.band, -1.0), 1.0)


@dataclass(frozen=True, kw_only=True)
class Line:
    stations: tuple[Station, ...]
    diameter: float = 0.022
    youngs_modulus: float = 2.1e11
    shear_modulus: float = 8.1e10
    damping: float = 0.0
    """Stiffness-proportional damping of the shaft [s]."""
    drive: Callable[[float], float] = field(default_factory=Drive)
    gravity: bool = False
    """Weight of rotors, rings and housings along -y."""

    def with_linear_tilts(self) -> Line:
        """Every body by (8) instead of the exact equations."""
        return replace(self, stations=tuple(replace(s, body=replace(s.body, exact=False)) for s in self.stations))

    def with_bearings(self, **changes: float) -> Line:
        stations = tuple(s if s.bearing is None else replace(s, bearing=replace(s.bearing, **changes)) for s in self.stations)
        return replace(self, stations=stations)


def reference_line(damped_in_bearing: bool = False, **changes: Any) -> Line:
    """M-REF, or M-REF2 with most damping in the bearing.  Bearing A locates axially (1e8 N/m, 100 N s/m)."""
    ring = Body(mass=0.35, polar=6e-5, transverse=5e-5, exact=False)
    rest = {"tilt_stiffness": 5e3, "tilt_damping": 0.5, "housing_mass": 2.5, "housing_stiffness": 6e6}
    if damped_in_bearing:
        bearing = Bearing(stiffness=3e7, damping=2e4, housing_damping=100.0, **rest)
    else:
        bearing = Bearing(stiffness=1.2e8, damping=400.0, housing_damping=800.0, **rest)
    rotor_1 = Body(mass=8.0, polar=0.04, transverse=0.0206, eccentricity=20e-6, tilt=5e-4)
    stations = (
        Station(name="drive", z=0.0, body=Body(mass=0.8, polar=4e-4, transverse=2.6e-4)),
        Station(name="A", z=0.06, body=ring, bearing=replace(bearing, axial_stiffness=1e8, axial_damping=100.0)),
        Station(name="rotor_1", z=0.31, body=rotor_1),
        Station(name="B", z=0.56, body=ring, bearing=bearing),
        Station(name="rotor_2", z=0.63, body=Body(mass=3.0, polar=0.00735, transverse=0.00383)),
    )
    return replace(Line(stations=stations, damping=0.0 if damped_in_bearing else 1e-5), **changes)


def section_stiffness(length: float, diameter: float, youngs_modulus: float, shear_modulus: float) -> Array:
    """12x12 from the deflection of a clamped bar under a force and a moment at its free end.

    [w, w'] = [[L^3/3EI, L^2/2EI], [L^2/2EI, L/EI]] [F, M], taken relative to the tangent at the clamped end.
    """
    L, area, second = length, np.pi * diameter**2 / 4, np.pi * diameter**4 / 64
    bending = youngs_modulus * second
    yields = np.array([[L**3 / (3 * bending), L**2 / (2 * bending)], [L**2 / (2 * bending), L / bending]])
    relative = np.array([[-1.0, -L, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]])
    plane = relative.T @ np.linalg.solve(yields, relative)
    couple = np.array([[1.0, -1.0], [-1.0, 1.0]])
    K = np.zeros((12, 12))
    for columns, signs in PLANES:
        K[np.ix_(columns, columns)] += np.outer(signs, signs) * plane
    K[np.ix_([2, 8], [2, 8])] += youngs_modulus * area / L * couple
    K[np.ix_([5, 11], [5, 11])] += shear_modulus * 2 * second / L * couple
    return K


PLANES = (([0, 4, 6, 10], np.ones(4)), ([1, 3, 7, 9], np.array([1.0, -1.0, 1.0, -1.0])))
"""Deflection and slope at both ends: x, theta and y, -psi."""


def section_shapes(length: float, place: float) -> tuple[Array, Array]:
    """Deflection and slope at ``place`` of the cubic with given deflections and slopes at its ends: N1, N2 of (9)."""

    def powers(s: float) -> Array:
        return np.array([[1.0, s, s**2, s**3], [0.0, 1.0, 2 * s, 3 * s**2]])

    shapes = np.linalg.solve(np.vstack([powers(0.0), powers(length)]).T, powers(place).T).T
    return shapes[0], shapes[1]


@dataclass(frozen=True)
class System:
    """Matrices and nonlinear terms; ``mass`` holds all that is constant, ``nominal`` every body, undeflected and balanced."""

    line: Line
    labels: tuple[str, ...]
    bodies: tuple[tuple[int, Body], ...]
    """First coordinate and body."""
    mass: Array
    stiffness: Array
    damping: Array
    cubics: tuple[tuple[int, int, float], ...]
    housings: tuple[tuple[int, float], ...]

    @property
    def nominal(self) -> Array:
        M = self.mass.copy()
        for first, body in self.bodies:
            if not body.constant:
                M[first : first + 6, first : first + 6] += np.diag(body.diagonal)
        return M

    @property
    def gyroscopic(self) -> Array:
        """At unit speed."""
        G = np.zeros_like(self.mass)
        for first, body in self.bodies:
            G[first + 3, first + 4], G[first + 4, first + 3] = body.polar, -body.polar
        return G

    def index(self, label: str) -> int:
        return self.labels.index(label)

    def acceleration(self, q: Array, v: Array) -> Array:
        M, f = self.mass.copy(), -(self.stiffness @ q) - self.damping @ v
        f[5] += self.line.drive(float(v[5]))
        for first, body in self.bodies:
            here = slice(first, first + 6)
            if body.constant:
                momentum = body.polar * v[first + 5]
                f[first + 3] -= momentum * v[first + 4]
                f[first + 4] += momentum * v[first + 3]
            else:
                matrix, force = body.inertia(q[here], v[here])
                M[here, here] += matrix
                f[here] -= force
            if self.line.gravity:
                f[here] += body.weight(q[here])
        for i, j, k in self.cubics:
            force = k * (q[i] - q[j]) ** 3
            f[i] -= force
            f[j] += force
        if self.line.gravity:
            for i, m in self.housings:
                f[i] -= m * GRAVITY
        return np.linalg.solve(M, f)

    def kinetic_energy(self, q: Array, v: Array) -> float:
        moving = sum(b.kinetic_energy(q[i : i + 6], v[i : i + 6]) for i, b in self.bodies if not b.constant)
        return moving + 0.5 * float(v @ self.mass @ v)

    def potential_energy(self, q: Array) -> float:
        """Elastic and, with gravity, of height."""
        energy = 0.5 * float(q @ self.stiffness @ q) + sum(0.25 * k * (q[i] - q[j]) ** 4 for i, j, k in self.cubics)
        if self.line.gravity:
            energy += sum(b.mass * GRAVITY * b.height(q[i : i + 6]) for i, b in self.bodies)
            energy += sum(m * GRAVITY * q[i] for i, m in self.housings)
        return float(energy)

    def jacobian(self, q: Array, v: Array) -> Array:
        """Of [q', v'] by [q, v], without the couplings of unbalance: enough for Newton."""
        K, C = self.stiffness.copy(), self.damping.copy()
        for first, body in self.bodies:
            spin = body.polar * v[first + 5]
            C[first + 3, first + 4] += spin
            C[first + 4, first + 3] -= spin
        for i, j, k in self.cubics:
            slope = 3 * k * (q[i] - q[j]) ** 2
            K[np.ix_([i, j], [i, j])] += slope * np.array([[1.0, -1.0], [-1.0, 1.0]])
        n = len(q)
        lower = -np.linalg.solve(self.nominal, np.hstack([K, C]))
        return np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower])


def _labels(names: list[str], housings: list[str]) -> tuple[str, ...]:
    return (
        *(f"{name}.{c}" for name in names for c in ("x", "y", "z", "psi", "theta", "phi")),
        *(f"{name}.housing.{c}" for name in housings for c in "xy"),
    )


def _sections(line: Line, stations: tuple[Station, ...], size: int) -> Array:
    K = np.zeros((size, size))
    for i, (left, right) in enumerate(pairwise(stations)):
        here = slice(6 * i, 6 * i + 12)
        K[here, here] += section_stiffness(right.z - left.z, line.diameter, line.youngs_modulus, line.shear_modulus)
    return K


def full(line: Line) -> System:
    """Every bearing ring a station, every housing two coordinates."""
    held = [(i, s, s.bearing) for i, s in enumerate(line.stations) if s.bearing is not None]
    ends = 6 * len(line.stations)
    size = ends + 2 * len(held)
    K = _sections(line, line.stations, size)
    C = line.damping * K
    M = np.zeros((size, size))
    for i, station in enumerate(line.stations):
        if station.body.constant:
            M[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = np.diag(station.body.diagonal)
    cubics, housings = [], []
    for number, (i, _, bearing) in enumerate(held):
        couple = np.array([[1.0, -1.0], [-1.0, 1.0]])
        for axis in (0, 1):
            ring, housing = 6 * i + axis, ends + 2 * number + axis
            pair = np.ix_([ring, housing], [ring, housing])
            K[pair] += bearing.stiffness * couple
            C[pair] += bearing.damping * couple
            K[housing, housing] += bearing.housing_stiffness
            C[housing, housing] += bearing.housing_damping
            M[housing, housing] += bearing.housing_mass
            if bearing.cubic:
                cubics.append((ring, housing, bearing.cubic))
        housings.append((ends + 2 * number + 1, bearing.housing_mass))
        for row, k, c in (
            (2, bearing.axial_stiffness, bearing.axial_damping),
            (3, bearing.tilt_stiffness, bearing.tilt_damping),
            (4, bearing.tilt_stiffness, bearing.tilt_damping),
        ):
            K[6 * i + row, 6 * i + row] += k
            C[6 * i + row, 6 * i + row] += c
    labels = _labels([s.name for s in line.stations], [s.name for _, s, _ in held])
    bodies = tuple((6 * i, s.body) for i, s in enumerate(line.stations))
    return System(line, labels, bodies, M, K, C, tuple(cubics), tuple(housings))


def simplified(line: Line, spin_inertia: bool = False) -> System:
    """Section 5 of the paper: the bearings as nodal matrices of the section that runs across them."""
    kept = tuple(s for s in line.stations if s.bearing is None)
    size = 6 * len(kept)
    K = _sections(line, kept, size)
    C = line.damping * K
    M = np.zeros((size, size))
    for i, station in enumerate(kept):
        if station.body.constant:
            M[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = np.diag(station.body.diagonal)
    for station in line.stations:
        if station.bearing is None:
            continue
        if line.gravity or station.bearing.cubic:
            raise ValueError("section 5 has neither the weight of the bearing nor its cubic stiffness")
        i = next(n for n, (left, right) in enumerate(pairwise(kept)) if left.z < station.z < right.z)
        length, place = kept[i + 1].z - kept[i].z, station.z - kept[i].z
        deflection, slope = section_shapes(length, place)
        N1, N2 = np.outer(deflection, deflection), np.outer(slope, slope)
        bearing, body = station.bearing, station.body
        for columns, signs in PLANES:
            here = np.ix_([6 * i + c for c in columns], [6 * i + c for c in columns])
            sign = np.outer(signs, signs)
            M[here] += sign * ((bearing.housing_mass + body.mass) * N1 + body.transverse * N2)
            C[here] += sign * (bearing.housing_damping * N1 + bearing.tilt_damping * N2)
            K[here] += sign * (bearing.housing_stiffness * N1 + bearing.tilt_stiffness * N2)
        share = np.array([1.0 - place / length, place / length])
        axial = np.ix_([6 * i + 2, 6 * i + 8], [6 * i + 2, 6 * i + 8])
        K[axial] += bearing.axial_stiffness * np.outer(share, share)
        C[axial] += bearing.axial_damping * np.outer(share, share)
        if spin_inertia:
            spin = np.ix_([6 * i + 5, 6 * i + 11], [6 * i + 5, 6 * i + 11])
            M[spin] += body.polar * np.outer(share, share)
    bodies = tuple((6 * i, s.body) for i, s in enumerate(kept))
    return System(line, _labels([s.name for s in kept], []), bodies, M, K, C, (), ())
