"""What may hang on the load: weight, a hidden inertia, an inertia that changes, a cable, a shaking neighbour, a slow or uneven brake."""

from __future__ import annotations

import math
from typing import NamedTuple

from benchmarks.withheld.plant.compiled import compiled
from benchmarks.withheld.plant.drive_train.springs import ramp

LETS_GO = 0.01  # s, in which a payload goes


class OddLoad(NamedTuple):
    """All zero at the nominal bench.

    Weight: W (sin(a + p) + v sin(2 a + p_2)).  Hidden inertia: a share of the load's behind a spring k x + k_3 x^3 and
    a damper c v + c_2 |v| v.  Inertia J (1 + m cos(2 a + q)).  Neighbour: S sin(w t + p)(1 + 0.3 sin(0.031 w t)).
    Brake: what acts follows what is recorded with a lag, and is uneven over the turn, 1 + u sin(n a + p_u) of it.
    Cable: slack up to an angle, taut beyond it, k_c r(a - a_c) with a soft ramp r.  Payload: a share of J goes at t_g with
    the speed that it has, so that nothing pushes.
    """

    weight: float = 0.0  # N m, W
    weight_phase: float = 0.0
    weight_second: float = 0.0  # 1, v
    weight_second_phase: float = 0.0
    hidden_share: float = 0.0  # 1
    hidden_stiffness: float = 0.0  # N m/rad, k
    hidden_cubic: float = 0.0  # N m/rad^3, k_3
    hidden_damping: float = 0.0  # N m s/rad, c
    hidden_square: float = 0.0  # N m s^2/rad^2, c_2
    inertia_depth: float = 0.0  # 1, m
    inertia_phase: float = 0.0
    shaking: float = 0.0  # N m, S
    shaking_frequency: float = 0.0  # rad/s
    shaking_phase: float = 0.0
    brake_time: float = 0.0  # s; 0: no lag
    uneven: float = 0.0  # 1, u
    uneven_order: float = 0.0  # 1, n
    uneven_phase: float = 0.0
    cable: float = 0.0  # N m/rad, k_c
    cable_angle: float = 0.0  # rad, a_c
    cable_width: float = 0.0  # rad, of the ramp
    gone: float = 0.0  # 1, share of the inertia
    gone_time: float = 0.0  # s, t_g


@compiled
def weight(angle, o):
    """Torque of the weight against growing angles."""
    if o.weight == 0.0:
        return 0.0
    return o.weight * (math.sin(angle + o.weight_phase) + o.weight_second * math.sin(2.0 * angle + o.weight_second_phase))


@compiled
def hidden_torque(twist, rate, o):
    """Torque of the spring and damper to the hidden inertia."""
    return (o.hidden_stiffness + o.hidden_cubic * twist * twist) * twist + (o.hidden_damping + o.hidden_square * abs(rate)) * rate


@compiled
def shaking(time, o):
    """Torque of the neighbour; its size beats slowly."""
    if o.shaking == 0.0:
        return 0.0
    beat = 1.0 + 0.3 * math.sin(0.031 * o.shaking_frequency * time)
    return o.shaking * beat * math.sin(o.shaking_frequency * time + o.shaking_phase)


@compiled
def uneven(angle, o):
    """Torque of the brake over what is recorded."""
    if o.uneven == 0.0:
        return 1.0
    return 1.0 + o.uneven * math.sin(o.uneven_order * angle + o.uneven_phase)


@compiled
def cable(angle, o):
    """Torque of a cable against growing angles."""
    if o.cable == 0.0:
        return 0.0
    return o.cable * ramp(angle - o.cable_angle, o.cable_width)


@compiled
def still_there(time, o):
    """Share of the inertia that has not gone."""
    if o.gone == 0.0:
        return 1.0
    return 1.0 - 0.5 * o.gone * (1.0 + math.tanh((time - o.gone_time) / LETS_GO))
