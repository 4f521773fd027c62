"""A place on a rotor line with lateral motion: its coordinates, its bodies and what it weighs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.expression import Value, gradient
from hdrive_mbs.network.coupling import Gyroscope
from hdrive_mbs.network.elements import AppliedTorque, Element
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Body, Channel, Rotor
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.tracked_arrays import array_of

FloatArray = npt.NDArray[np.float64]

LATERAL = ("x", "y", "z", "psi", "theta")
UNITS = {"x": "m", "y": "m", "z": "m", "psi": "rad", "theta": "rad"}
WORDS = {"x": "displacement in x", "y": "displacement in y", "z": "axial displacement", "psi": "tilt about x", "theta": "tilt about y"}
GROUND = "ground"


@dataclass(frozen=True)
class Station:
    """A flange on a rotor line, as parts see it.

    names : coordinates of x, y, z, psi, theta and the spin (forward); "ground" six times where it is held
    offset : how far the flange lies from the station's reference point along +z [m]
    sense : true sense of the spin coordinate
    position : axial position of the flange [m]
    """

    node: str
    names: tuple[str, ...]
    offset: float
    sense: int
    position: float

    @property
    def held(self) -> bool:
        """Whether it is the ground."""
        return self.node == GROUND

    def arm(self) -> FloatArray:
        """[x, y, z, psi, theta, phi] of the flange in the true sense from the coordinates, 6x6.

        A point at distance a along z has x + a theta and y - a psi.
        """
        matrix = np.diag([1.0, 1.0, 1.0, 1.0, 1.0, float(self.sense)])
        matrix[0, 4], matrix[1, 3] = self.offset, -self.offset
        return matrix

    def stretch(self, direction: str) -> dict[str, float]:
        """A displacement, tilt or the true spin angle of the flange as factors of coordinates."""
        row = self.arm()[(*LATERAL, "phi").index(direction)]
        return {} if self.held else {name: float(factor) for name, factor in zip(self.names, row, strict=True) if factor != 0.0}


def coordinate_names(node: str) -> tuple[str, ...]:
    """Names of the six coordinates of a node."""
    return (GROUND,) * 6 if node == GROUND else (*(f"{node}.{key}" for key in LATERAL), node)


@dataclass(frozen=True)
class StationBodies:
    """What one station adds to a network."""

    bodies: tuple[Body, ...]
    elements: tuple[Element, ...]
    rotor: Rotor | None


def station_bodies(
    node: str, mass: RigidMass, sense: int, ratio: float, *, turning: float, is_rotor: bool, motion: Callable[[Value], Value] | None
) -> StationBodies:
    """Bodies and elements of a station that moves.

    turning : inertia of parts that only turn with it (a Motor, an Inertia, a Load) [kg m^2]: on the spin alone, so that it
        does not tilt and has no gyroscopic moment
    is_rotor : a rigid body with all its couplings; else small tilts with gyroscopic moments (seed M (8))
    motion : the prescribed forward spin angle; then unbalance enters as a force, a function of time
    """
    names = coordinate_names(node)
    inertias = (mass.mass, mass.mass, mass.mass, mass.inertia[0][0], mass.inertia[1][1])
    group = "" if is_rotor and motion is None else node
    bodies = [
        Body(name, inertia, 1, 0.0, UNITS[key], lateral=True, group=group)
        for name, inertia, key in zip(names[:5], inertias, LATERAL, strict=True)
    ]
    elements: list[Element] = []
    if motion is None:
        bodies.append(Body(node, mass.polar + turning, sense, ratio))
        if is_rotor:
            return StationBodies(tuple(bodies), tuple(_turning_along(node, turning)), Rotor(node, names, mass, sense))
    elif is_rotor:
        elements += _forced_unbalance(node, mass, sense, motion)
    if mass.polar > 0.0:
        elements.append(Gyroscope(f"{node}.gyroscope", names[3], names[4], node, sense * mass.polar))
    if mass.centre[2] != 0.0:
        elements.append(_lever(node, mass))
    return StationBodies(tuple(bodies), tuple(elements), None)


def _turning_along(node: str, inertia: float) -> Iterator[MatrixElement]:
    """Inertia on the spin of a rotor alone, J phi'': what its rigid body leaves out."""
    if inertia > 0.0:
        zero = np.zeros((1, 1))
        yield MatrixElement(f"{node}.turning", (node,), array_of([[inertia]]), zero, zero)


def _lever(node: str, mass: RigidMass) -> MatrixElement:
    """What a centre of mass at distance a along +z adds to the masses: m a between x and theta, -m a between y and psi."""
    x, y, _, psi, theta, _ = coordinate_names(node)
    moment = mass.mass * mass.centre[2]
    matrix = array_of([[0.0, moment, 0.0, 0.0], [moment, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, -moment], [0.0, 0.0, -moment, 0.0]])
    return MatrixElement(f"{node}.lever", (x, theta, y, psi), matrix, np.zeros((4, 4)), np.zeros((4, 4)))


def _forced_unbalance(node: str, mass: RigidMass, sense: int, motion: Callable[[Value], Value]) -> Iterator[Element]:
    """Force and moment of unbalance at a prescribed spin:  F = Re[m e (w^2 - i a) exp(i phi)], x as real part.

    From -d^2/dt^2 (m e exp(i phi)); the moment of the products of inertia J = J_xz + i J_yz likewise:
    M_y - i M_x = -(w^2 - i a) J exp(i phi).
    """
    speed, acceleration = gradient(motion), gradient(gradient(motion))
    static, product = mass.unbalance[:2], mass.unbalance[2:]
    pairs = (("x", static, 1.0, 0.0), ("y", static, 0.0, 1.0), ("theta", product, -1.0, 0.0), ("psi", product, 0.0, 1.0))
    for key, size, real, imaginary in pairs:
        if not any(size):
            continue

        def force(moment: Moment, size: tuple[float, float] = size, real: float = real, imaginary: float = imaginary) -> Value:
            time = moment.time
            angle = sense * motion(time)
            a, b = size
            cosine, sine = a * np.cos(angle) - b * np.sin(angle), b * np.cos(angle) + a * np.sin(angle)
            square, rise = speed(time) ** 2, sense * (acceleration(time) + 0.0 * time)
            # (w^2 - i a)(c + i s) = w^2 c + a s + i (w^2 s - a c)
            return real * (square * cosine + rise * sine) + imaginary * (square * sine - rise * cosine)

        yield AppliedTorque(f"{node}.unbalance_{key}", f"{node}.{key}", force)


def weights(node: str, mass: RigidMass, sense: int, gravity: tuple[float, float, float], is_rotor: bool) -> Iterator[Element]:
    """Weight of a station: m g at the centre, the moments of a centre of mass off the reference point.

    First order in tilt and eccentricity: the product of both is left out.
    is_rotor : whether it is a free rigid body; else the moments come with the matrix of its lever
    """
    names = coordinate_names(node)
    force = [mass.mass * value for value in gravity]
    moments = {0: force[0], 1: force[1], 2: force[2]}
    if is_rotor:
        moments |= {3: -mass.centre[2] * force[1], 4: mass.centre[2] * force[0]}
    for k, value in moments.items():
        if value != 0.0:
            yield constant_force(f"{names[k]}.weight", names[k], value)
    ex, ey = mass.centre[:2]
    if is_rotor and (ex or ey) and (force[0] or force[1]):

        def torque(moment: Moment) -> Value:
            angle = sense * moment.angle(node)
            x, y = ex * np.cos(angle) - ey * np.sin(angle), ey * np.cos(angle) + ex * np.sin(angle)
            return sense * (x * force[1] - y * force[0])

        def height(moment: Moment) -> Value:
            angle = sense * moment.angle(node)
            x, y = ex * np.cos(angle) - ey * np.sin(angle), ey * np.cos(angle) + ex * np.sin(angle)
            return -x * force[0] - y * force[1]

        yield AppliedTorque(f"{node}.weight", node, torque, stored=height)


def constant_force(name: str, coordinate: str, value: float) -> AppliedTorque:
    """A constant force along a coordinate [N, N m] and the energy of position that belongs to it."""
    return AppliedTorque(name, coordinate, lambda m: value + 0.0 * m.time, stored=lambda m: -value * m.angle(coordinate))


def station_channels(
    place: str, names: Mapping[str, Mapping[str, float]], centre: tuple[float, float, float] | None, spin: str, sense: int
) -> list[Channel]:
    """Displacements and tilts of a place, its distance from the axis, and those of its centre of mass.

    names : direction -> factors of coordinates; centre : of mass in the turning frame, None where it is on the axis
    """
    channels = []
    for key, factors in names.items():
        slope, unit = f"{place}.{key}_rate", UNITS[key]
        channels += [
            Channel(f"{place}.{key}", unit, f"{WORDS[key]} of {place}", _sum(factors, "angles"), slope, factors),
            Channel(slope, f"{unit}/s", f"rate of the {WORDS[key]} of {place}", _sum(factors, "speeds"), f"{place}.{key}_acceleration"),
        ]
    x, y = _sum(names["x"], "angles"), _sum(names["y"], "angles")
    channels.append(Channel(f"{place}.radial", "m", f"distance of the centre of {place} from the axis", lambda m: np.hypot(x(m), y(m))))
    if centre is not None:
        ex, ey, lever = centre
        psi, theta = _sum(names["psi"], "angles"), _sum(names["theta"], "angles")

        def radial_of_mass(moment: Moment) -> Value:
            angle = sense * moment.angle(spin)
            px = x(moment) + lever * theta(moment) + ex * np.cos(angle) - ey * np.sin(angle)
            py = y(moment) - lever * psi(moment) + ey * np.cos(angle) + ex * np.sin(angle)
            return np.hypot(px, py)

        channels.append(
            Channel(
                f"{place}.mass_centre_radial", "m", f"distance of the centre of mass of the body at {place} from the axis", radial_of_mass
            )
        )
    return channels


def _sum(factors: Mapping[str, float], kind: str) -> Callable[[Moment], Value]:
    def read(moment: Moment) -> Value:
        values = moment.angles if kind == "angles" else moment.speeds
        return sum(factor * values[name] for name, factor in factors.items()) if factors else 0.0 * moment.time

    return read
