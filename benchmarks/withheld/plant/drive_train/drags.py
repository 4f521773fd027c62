"""Drags that grow with a power of speed, and drags that no library lists."""

from __future__ import annotations

import math
from typing import NamedTuple

from benchmarks.withheld.plant.compiled import compiled


class Drag(NamedTuple):
    """Drags of one body.

    c |w/w_c|^n sign(w), with n near 2 (Blasius' law of turbulent friction has 7/4);
    one-way b w for w > 0; warming b exp(-t/t_w) w; rub at one angle, R exp((cos(a - a_r) - 1)/s^2) sign(w);
    grip from t_1 to t_2, G sign(w) with soft ends.
    """

    power: float = 0.0  # N m, c
    power_speed: float = 1.0  # rad/s, w_c
    exponent: float = 1.0  # 1, n
    one_way: float = 0.0  # N m s/rad
    warming: float = 0.0  # N m s/rad
    warming_time: float = 1.0  # s
    rub: float = 0.0  # N m, R
    rub_angle: float = 0.0  # rad
    rub_width: float = 1.0  # rad, s
    grip: float = 0.0  # N m, G
    grip_start: float = 0.0  # s
    grip_end: float = 1.0  # s
    smooth_speed: float = 1.0  # rad/s, of sign(w)


@compiled
def drag_torque(time, angle, speed, d):
    """Torque against the motion."""
    total = (d.one_way if speed > 0.0 else 0.0) * speed
    if d.power > 0.0:
        size = d.power * (abs(speed) / d.power_speed) ** d.exponent
        total += size if speed > 0.0 else -size
    if d.warming != 0.0:
        total += d.warming * math.exp(-time / d.warming_time) * speed
    if d.rub > 0.0 or d.grip > 0.0:
        sign = speed / math.sqrt(speed * speed + d.smooth_speed**2)
        total += sign * d.rub * math.exp((math.cos(angle - d.rub_angle) - 1.0) / d.rub_width**2)
        window = math.tanh((time - d.grip_start) / 0.05) - math.tanh((time - d.grip_end) / 0.05)
        total += sign * 0.5 * d.grip * window
    return total
