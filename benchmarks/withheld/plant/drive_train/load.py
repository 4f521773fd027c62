"""What may hang on the load: weight, a hidden inertia, an inertia that changes with the angle, a shaking neighbour, a slow brake."""

from __future__ import annotations

import math
from typing import NamedTuple

from benchmarks.withheld.plant.compiled import compiled


class OddLoad(NamedTuple):
    """All zero at the nominal bench.

    Weight: W (sin(a + p) + v sin(2 a + p_2)).  Hidden inertia: a share of the load's behind a spring k x + k_3 x^3 and
    a damper c v + c_2 |v| v.  Inertia J (1 + m cos(2 a + q)).  Neighbour: S sin(w t + p)(1 + 0.3 sin(0.031 w t)).
    Brake: what acts follows what is recorded with a lag.
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
