"""Dry friction of bodies and of the mesh, in three laws each of another form than tanh or LuGre."""

from __future__ import annotations

import math
from typing import NamedTuple

from benchmarks.withheld.plant.compiled import compiled

NONE, SMOOTH, DAHL, BANK = 0.0, 1.0, 2.0, 3.0


class Friction(NamedTuple):
    """Friction of one body.

    Level: L(w) = C (1 + s/(1 + |w/w_s|^n)) (1 + a w/(|w| + w_s)); the hyperbola is Hess and Soom's (1990), not a Gaussian.
    SMOOTH  tau = L w/sqrt(w^2 + w_0^2)
    DAHL    dF/dt = k w |1 - F sign(w)/L|^g sign(1 - F sign(w)/L)   (Dahl 1968 with exponent g; passive for any g > 0)
    BANK    Jenkins elements with limits in proportion to L
    """

    kind: float = NONE
    coulomb: float = 0.0  # N m, C
    drop: float = 0.0  # 1, s
    drop_speed: float = 1.0  # rad/s, w_s
    drop_exponent: float = 1.0  # 1, n
    asymmetry: float = 0.0  # 1, a
    smooth_speed: float = 1.0  # rad/s, w_0
    stiffness: float = 1.0  # N m/rad, k
    sharpness: float = 1.0  # 1, g


@compiled
def level(speed, f):
    """L(w)/C"""
    share = abs(speed) / f.drop_speed
    drop = f.drop / (1.0 + share**f.drop_exponent)
    return (1.0 + drop) * (1.0 + f.asymmetry * speed / (abs(speed) + f.drop_speed))


@compiled
def smooth_friction(speed, f):
    """Torque of the law SMOOTH."""
    return f.coulomb * level(speed, f) * speed / math.sqrt(speed * speed + f.smooth_speed**2)


@compiled
def dahl_rate(force, rate, limit, stiffness, sharpness):
    """dF/dt of the law DAHL."""
    gap = 1.0 - force / limit * (1.0 if rate > 0.0 else -1.0)
    size = abs(gap) ** sharpness
    return stiffness * rate * (size if gap > 0.0 else -size)


class MeshFriction(NamedTuple):
    """Friction of the mesh on the wave generator: mu A(T)/u (1 + h/(1 + |w|/w_h)), A = T^2/(|T| + T_0).

    SMOOTH takes the sign w/sqrt(w^2 + w_0^2); BANK takes Jenkins elements with limits in proportion.
    """

    kind: float = NONE
    loss: float = 0.0  # 1, mu
    round_torque: float = 1.0  # N m, T_0
    rise: float = 0.0  # 1, h
    rise_speed: float = 1.0  # rad/s
    smooth_speed: float = 1.0


@compiled
def mesh_level(torque, speed, ratio, m):
    """Largest friction torque on the wave generator."""
    size = torque * torque / (abs(torque) + m.round_torque)
    return m.loss * size / ratio * (1.0 + m.rise / (1.0 + abs(speed) / m.rise_speed))
