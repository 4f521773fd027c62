"""Exact equations of motion of a rigid body in the coordinates [x, y, z, psi, theta, phi], A = Rx Ry Rz.

With the velocity r' of the origin, u = (psi', theta', phi'), the angular velocity w = G u and the centre
of mass c, both in the turning frame, T = m r'^2/2 + m r'.A(w x c) + w.J w/2.  Then

    | m E        -m A [c] G |        | m A (w x (w x c) + (G' u) x c) |
    | symmetric   G^T J G   | q''  + | G^T (J G' u + w x J w)         |  =  Q

Source: d'Alembert's principle (e.g. Shabana, Dynamics of Multibody Systems, 3.5); seed M (4) is its
linearisation for a balanced rotor, with the misprints that notes and tests name.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.expression import Value
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.tracked_arrays import array_of

FloatArray = npt.NDArray[np.float64]


def _parts(coordinates: Sequence[Value]) -> tuple[FloatArray, FloatArray]:
    """Rotation A and G, shape (..., 3, 3)."""
    psi, theta, phi = (np.asarray(value, float) for value in coordinates[3:])
    psi, theta, phi = np.broadcast_arrays(psi, theta, phi)
    cx, sx, cy, sy, cz, sz = np.cos(psi), np.sin(psi), np.cos(theta), np.sin(theta), np.cos(phi), np.sin(phi)
    zero, one = np.zeros_like(cx), np.ones_like(cx)
    rotation = _matrix(
        [
            [cy * cz, -cy * sz, sy],
            [cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy],
            [sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy],
        ]
    )
    return rotation, _matrix([[cz * cy, sz, zero], [-sz * cy, cz, zero], [sy, zero, one]])


def _matrix(rows: list[list[FloatArray]]) -> FloatArray:
    found = np.empty((*np.shape(rows[0][0]), 3, 3))
    for i, row in enumerate(rows):
        for j, value in enumerate(row):
            found[..., i, j] = value
    return found


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """a x b of vectors in the last direction; most of what ``np.cross`` does for one pair of them is to look at their shapes."""
    found = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for k, i, j in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[..., k] = a[..., i] * b[..., j] - a[..., j] * b[..., i]
    return found


def _cross_matrix(vector: Sequence[float]) -> FloatArray:
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def mass_matrix(body: RigidMass, coordinates: Sequence[Value]) -> FloatArray:
    """M(q) [kg, kg m, kg m^2], shape (..., 6, 6)."""
    rotation, rates = _parts(coordinates)
    coupling = -body.mass * rotation @ _cross_matrix(body.centre) @ rates
    turning = np.swapaxes(rates, -1, -2) @ np.array(body.inertia) @ rates
    moving = np.broadcast_to(body.mass * np.eye(3), turning.shape)
    upper = np.concatenate([moving, coupling], axis=-1)
    lower = np.concatenate([np.swapaxes(coupling, -1, -2), turning], axis=-1)
    return np.concatenate([upper, lower], axis=-2)


def mass_at_rest(body: RigidMass) -> FloatArray:
    """M at coordinates of zero, 6x6, of numbers that may be tracked: A = G = E."""
    m, (x, y, z) = body.mass, body.centre
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = body.inertia
    rows = [
        [m, 0.0, 0.0, 0.0, m * z, -(m * y)],
        [0.0, m, 0.0, -(m * z), 0.0, m * x],
        [0.0, 0.0, m, m * y, -(m * x), 0.0],
        [0.0, -(m * z), m * y, xx, xy, xz],
        [m * z, 0.0, -(m * x), yx, yy, yz],
        [-(m * y), m * x, 0.0, zx, zy, zz],
    ]
    return array_of(rows)


def forces_of_motion(body: RigidMass, coordinates: Sequence[Value], speeds: Sequence[Value]) -> FloatArray:
    """h(q, q') in M q'' + h = Q: centrifugal and gyroscopic terms [N, N m], shape (..., 6)."""
    rotation, rates = _parts(coordinates)
    _, theta, phi = np.broadcast_arrays(*(np.asarray(value, float) for value in coordinates[3:]))
    u = np.stack(np.broadcast_arrays(*(np.asarray(value, float) for value in speeds[3:])), axis=-1)
    w = _apply(rates, u)
    cy, sy, cz, sz = np.cos(theta), np.sin(theta), np.cos(phi), np.sin(phi)
    psi_rate, theta_rate, spin = u[..., 0], u[..., 1], u[..., 2]
    drift = np.stack(  # G' u
        [
            (-spin * sz * cy - theta_rate * cz * sy) * psi_rate + spin * cz * theta_rate,
            (-spin * cz * cy + theta_rate * sz * sy) * psi_rate - spin * sz * theta_rate,
            theta_rate * cy * psi_rate,
        ],
        axis=-1,
    )
    centre, inertia = np.array(body.centre), np.array(body.inertia)
    linear = body.mass * _apply(rotation, _cross(w, _cross(w, centre)) + _cross(drift, centre))
    angular = _apply(np.swapaxes(rates, -1, -2), drift @ inertia.T + _cross(w, w @ inertia.T))
    return np.concatenate([np.broadcast_to(linear, angular.shape), angular], axis=-1)


def _apply(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    return np.asarray((matrix @ vector[..., None])[..., 0])


def kinetic_energy(body: RigidMass, coordinates: Sequence[Value], speeds: Sequence[Value]) -> FloatArray:
    """q'^T M(q) q' / 2 [J], shape of the coordinates."""
    v = np.stack(np.broadcast_arrays(*(np.asarray(value, float) for value in speeds)), axis=-1)
    return np.asarray(0.5 * np.sum(v * _apply(mass_matrix(body, coordinates), v), axis=-1))
