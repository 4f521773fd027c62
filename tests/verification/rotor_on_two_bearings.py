"""A rotor with unbalance and gravity on two bearings: as a scene, and in equations put together again for scipy.

Situations that a scene can have: the ring of a bearing as a station of its own, with and without a housing; one of the
bearings merged with the rotor, at its centre and at the end of a rigid piece of shaft, again with and without a housing.

The equations share with the package the laws alone, as plain functions of numbers.  Rotor and shaft come from the
reference line (derived by sympy from the kinetic energy; beams from the deflection of a cantilever).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

import hdrive_mbs as hm
from hdrive_mbs.bearings.law import DIRECTIONS
from tests.verification.reference_rotors import GRAVITY, Body, section_stiffness

SPEED, SLIDING = 500.0, 0.02
"""Spin [rad/s] and axial speed of the line [m/s] at the start, all else at rest."""
TORQUE = 20.0
"""On the rotor [N m]: 6 rad/s faster in the end."""
DURATION = 0.0125
"""One turn [s]."""
SIDE, OFFSET = 0.25, 0.03
"""Length of a shaft section, and of the rigid piece between rotor and bearing [m]."""
BEAM = {"diameter": 0.022, "youngs_modulus": 2.1e11, "shear_modulus": 8.1e10}
SHAFT_DAMPING = 1e-5
ROTOR = Body(mass=8.0, polar=0.04, transverse=0.0206, eccentricity=20e-6, eccentricity_direction=0.4, tilt=5e-4, tilt_direction=2.0)
RING = Body(mass=0.35, polar=6e-5, transverse=5e-5, exact=False)
HOUSING = {"mass": 2.5, "stiffness": (6e6, 8e6), "damping": (800.0, 600.0), "cubic": (3e16, 2e16)}
KEYS = ("x", "y", "z", "psi", "theta", "phi")


# -- laws ----------------------------------------------------------------------------------------------


def matrix(diagonal: tuple[float, ...], **entries: float) -> np.ndarray:
    """6x6 with named entries: x_theta is row x, column theta."""
    result = np.diag([*diagonal, 0.0])
    for name, value in entries.items():
        row, _, column = name.partition("_")
        result[DIRECTIONS.index(row), DIRECTIONS.index(column)] = value
    return result


STIFFNESS = matrix((3e7, 4e7, 1e7, 5e3, 6e3), x_y=4e6, y_x=-3e6, x_theta=2e4, theta_x=3e4)
DAMPING = matrix((900.0, 800.0, 100.0, 0.5, 0.4), x_y=50.0, y_x=50.0)
BALLS = hm.BallBearing.from_geometry(
    balls=7,
    ball_diameter=7.94e-3,
    pitch_diameter=39.04e-3,
    inner_conformity=0.52,
    outer_conformity=0.52,
    radial_clearance=2e-6,
    contact_damping=2.0,
    damping=200.0,
    axial_stiffness=1e6,
    axial_damping=50.0,
    tilt_stiffness=50.0,
    tilt_damping=0.1,
)
LAWS: dict[str, hm.BearingLaw] = {
    "linear": hm.LinearBearing.from_matrices(stiffness=STIFFNESS, damping=DAMPING),
    "power": hm.PowerBearing.from_matrices(
        stiffness=STIFFNESS,
        damping=DAMPING,
        power_stiffness=matrix((3e17, 4e17, 1e17, 5e9, 6e9), x_y=8e16, y_x=-3e16, z_theta=1e12, theta_x=2e14, psi_y=-1e14),
    ),
    "speed table": hm.TableBearing(
        speeds=(0.0, 501.0, 504.0, 900.0),
        stiffness_xx=(3e7, 4e7, 5e7, 6e7),
        stiffness_yy=(2e7, 3e7, 4e7, 6e7),
        stiffness_xy=(0.0, 4e6, 5e6, 6e6),
        stiffness_yx=(0.0, -3e6, -5e6, -6e6),
        damping_xx=(900.0, 800.0, 700.0, 600.0),
        damping_yy=(900.0, 850.0, 800.0, 700.0),
        damping_xy=(50.0, 40.0, 30.0, 0.0),
        damping_yx=(50.0, 40.0, 30.0, 0.0),
        axial_stiffness=1e6,
        axial_damping=50.0,
        tilt_damping=0.1,
    ),
    "ball": BALLS,
    "journal": hm.JournalBearing(
        diameter=0.03, length=0.012, radial_clearance=5e-5, viscosity=0.03, axial_stiffness=1e6, axial_damping=50.0, tilt_damping=0.1
    ),
}
FRICTION: dict[str, Any] = {"bore": 0.025, "friction": 0.1, "turning_friction": 0.02, "smoothing_speed": 0.2}
LAWS["journal with friction"] = hm.WithFriction(law=LAWS["journal"], **FRICTION)


# -- the same scene twice ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Situation:
    """How the second bearing sits.

    merged : distance from the rotor at which it is part of it [m]; None: a station behind a section of shaft
    """

    merged: float | None
    housed: bool


SITUATIONS = {
    "own ring, housing": Situation(None, True),
    "own ring": Situation(None, False),
    "merged, housing": Situation(0.0, True),
    "merged": Situation(0.0, False),
    "merged at a distance, housing": Situation(OFFSET, True),
    "merged at a distance": Situation(OFFSET, False),
}


def scene(law: hm.BearingLaw, situation: Situation) -> hm.Scene:
    section = hm.ShaftSection(length=SIDE, damping=SHAFT_DAMPING, **BEAM)
    housing = hm.Housing(
        mass=HOUSING["mass"],
        **{f"{word}_{axis}": HOUSING[word][k] for word in ("stiffness", "damping") for k, axis in enumerate("xy")},
        **{f"power_stiffness_{axis}": HOUSING["cubic"][k] for k, axis in enumerate("xy")},
    )
    ring = {"mass": RING.mass, "polar_inertia": RING.polar, "transverse_inertia": RING.transverse}
    bearing = hm.Bearing(law=law, housing=housing if situation.housed else None, **ring)
    rotor = hm.Rotor(
        mass=ROTOR.mass,
        polar_inertia=ROTOR.polar,
        transverse_inertia=ROTOR.transverse,
        eccentricity=ROTOR.eccentricity,
        angle=ROTOR.eccentricity_direction,
        tilt=ROTOR.tilt,
        tilt_angle=ROTOR.tilt_direction,
    )
    parts: dict[str, hm.Component] = {
        "a": bearing,
        "left": section,
        "rotor": rotor,
        "b": bearing,
        "gravity": hm.Gravity(y=-GRAVITY),
        "drive": hm.DriveTorque(characteristic=lambda speed: TORQUE + 0.0 * speed),
    }
    chain = ["a", "left", "rotor", "b"]
    if situation.merged is None:
        parts["right"] = section
        chain.insert(3, "right")
    elif situation.merged > 0.0:
        parts["right"] = hm.RigidSection(length=situation.merged)
        chain.insert(3, "right")
    return hm.Scene(name="rotor on two bearings", parts=parts, connections=[tuple(chain), ("drive", "rotor")])


MOTION = [field.name for field in fields(hm.RelativeMotion)]


class Equations:
    """M(q) q'' = f(q, q') of the same line; stations a, rotor and (if it has its own ring) b, then housings."""

    def __init__(self, law: hm.BearingLaw, situation: Situation) -> None:
        self.law, self.situation = law, situation
        self.stations = ("a", "rotor") if situation.merged is not None else ("a", "rotor", "b")
        self.labels = [f"{station}.{key}" for station in self.stations for key in KEYS]
        if situation.housed:
            self.labels += [f"{bearing}.housing.{axis}" for bearing in "ab" for axis in "xy"]
        n = len(self.labels)
        self.mass, self.stiffness, self.damping = np.zeros((3, n, n))
        for first in range(0, 6 * (len(self.stations) - 1), 6):
            self.stiffness[first : first + 12, first : first + 12] += section_stiffness(SIDE, **BEAM)
        self.damping += SHAFT_DAMPING * self.stiffness
        for bearing in set(self.stations) - {"rotor"}:
            i = self.labels.index(f"{bearing}.x")
            self.mass[i : i + 6, i : i + 6] = np.diag(RING.diagonal)
        self.housings = [
            (self.labels.index(f"{bearing}.housing.{axis}"), k) for bearing in "ab" for k, axis in enumerate("xy") if situation.housed
        ]
        for i, k in self.housings:
            self.mass[i, i], self.stiffness[i, i], self.damping[i, i] = HOUSING["mass"], HOUSING["stiffness"][k], HOUSING["damping"][k]
        self.rotor = [(ROTOR, 0.0)]
        if situation.merged is not None:
            self.rotor.append((Body(mass=RING.mass, polar=RING.polar, transverse=RING.transverse), situation.merged))
        self.places = {bearing: self.place(bearing) for bearing in "ab"}
        self.constants = law.stiffness_matrix(), law.damping_matrix()

    def place(self, bearing: str) -> np.ndarray:
        """[x, y, z, psi, theta, phi] of the ring against the housing from the coordinates: small tilts."""
        station = "rotor" if bearing == "b" and self.situation.merged is not None else bearing
        distance = self.situation.merged or 0.0 if bearing == "b" else 0.0
        first = self.labels.index(f"{station}.x")
        rows = np.zeros((6, len(self.labels)))
        rows[:, first : first + 6] = np.eye(6)
        rows[0, first + 4], rows[1, first + 3] = distance, -distance
        if self.situation.housed:
            for k, axis in enumerate("xy"):
                rows[k, self.labels.index(f"{bearing}.housing.{axis}")] = -1.0
        return rows

    def force(self, place: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """On the housing."""
        names = ("x", "y", "z", "psi", "theta", "angle", "vx", "vy", "vz", "psi_rate", "theta_rate", "speed")
        assert set(names) == set(MOTION)
        K, D = self.constants
        total: np.ndarray = K @ place + D @ rate
        motion = hm.RelativeMotion(**dict(zip(names, (*place.tolist(), *rate.tolist()), strict=True)))
        for direction, value in self.law.forces(motion).items():
            total[DIRECTIONS.index(direction)] += value
        return total

    def acceleration(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        M, f = self.mass.copy(), -self.stiffness @ q - self.damping @ v
        for number, station in enumerate(self.stations):
            here = slice(6 * number, 6 * number + 6)
            if station == "rotor":
                f[here.stop - 1] += TORQUE
                for body, distance in self.rotor:
                    mass, force = inertia(body, distance, q[here], v[here])
                    M[here, here] += mass
                    f[here] += force
            else:  # (8), without its line in the spin
                psi_rate, theta_rate, spin = v[here][3:]
                f[here] += np.array([0.0, -RING.mass * GRAVITY, 0.0, -RING.polar * spin * theta_rate, RING.polar * spin * psi_rate, 0.0])
        for i, k in self.housings:
            f[i] -= HOUSING["cubic"][k] * q[i] ** 3 + (HOUSING["mass"] * GRAVITY if k == 1 else 0.0)
        for rows in self.places.values():
            f -= rows.T @ self.force(rows @ q, rows @ v)
        return np.linalg.solve(M, f)

    def history(self, times: np.ndarray) -> np.ndarray:
        """Rows [q, q'] at these times, from an undeflected start."""
        n = len(self.labels)
        begin = np.zeros(2 * n)
        for k, label in enumerate(self.labels):
            begin[n + k] = {"phi": SPEED, "z": SLIDING}.get(label.rpartition(".")[2], 0.0)

        def slope(t: float, u: np.ndarray) -> np.ndarray:
            return np.concatenate([u[n:], self.acceleration(u[:n], u[n:])])

        small = 1e-8 * np.concatenate([np.full(n, 1e-5), np.full(n, 1e-2)])
        run = solve_ivp(slope, (0.0, times[-1]), begin, method="DOP853", rtol=1e-8, atol=small, t_eval=times)
        assert run.success, run.message
        self.evaluations = run.nfev
        return np.asarray(run.y.T)


def inertia(body: Body, distance: float, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix and the forces of motion and weight on the right side, of a body at a distance along the axis.

    Its centre is at r + A (0, 0, a) = r + a (sin theta, -sin psi cos theta, cos psi cos theta):
    M = J^T m J + rotation,  f = -J^T m J' q' - rotation - weight, with J = d(centre)/dq.
    """
    if distance == 0.0:
        M, h = (np.array(item) for item in body.inertia(q, v))
        return M, body.weight(q) - h
    a, (psi, theta), (psi_t, theta_t) = distance, q[3:5], v[3:5]
    sp, cp, st, ct = math.sin(psi), math.cos(psi), math.sin(theta), math.cos(theta)
    J = np.zeros((3, 6))
    J[:, :3] = np.eye(3)
    J[:, 3] = 0.0, -a * cp * ct, -a * sp * ct
    J[:, 4] = a * ct, a * sp * st, -a * cp * st
    drift = a * np.array(
        [
            -st * theta_t**2,
            sp * ct * psi_t**2 + 2.0 * cp * st * psi_t * theta_t + sp * ct * theta_t**2,
            -cp * ct * psi_t**2 + 2.0 * sp * st * psi_t * theta_t - cp * ct * theta_t**2,
        ]
    )
    turning = Body(mass=0.0, polar=body.polar, transverse=body.transverse)
    M, h = (np.array(item) for item in turning.inertia(q, v))
    return M + body.mass * J.T @ J, -h - body.mass * J.T @ (drift + np.array([0.0, GRAVITY, 0.0]))


def channel(label: str, rate: bool) -> str:
    station, _, key = label.partition(".")
    if key == "phi":
        return f"{station}.{'speed' if rate else 'angle'}"
    return f"{label}{'_rate' if rate else ''}"
