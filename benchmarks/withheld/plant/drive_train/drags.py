"""Drags that grow with a power of speed, and drags that no library lists."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from benchmarks.withheld.case import Array
from benchmarks.withheld.plant.compiled import compiled


class Drags(NamedTuple):
    """At motor, wave generator and load (arrays of three).

    c |w/w_c|^n sign(w), with n near 2 (Blasius' law of turbulent friction has 7/4);
    one-way b w for w > 0; warming b exp(-t/t_w) w; rub at one angle, R exp((cos(a - a_r) - 1)/s^2) sign(w);
    grip from t_1 to t_2, G sign(w) with soft ends.
    """

    power: Array  # N m, c
    power_speed: Array  # rad/s, w_c
    exponent: Array  # 1, n
    one_way: Array  # N m s/rad
    warming: Array  # N m s/rad
    warming_time: Array  # s
    rub: Array  # N m, R
    rub_angle: Array  # rad
    rub_width: Array  # rad, s
    grip: Array  # N m, G
    grip_start: Array  # s
    grip_end: Array  # s
    smooth_speed: Array  # rad/s, of sign(w)


def no_drags() -> Drags:
    """None at any site."""
    off, on = np.zeros(3), np.ones(3)
    smooth = np.array([0.2, 0.2, 0.002])
    return Drags(off, on, on, off, off, on, off, off, on, off, off, on, smooth)


@compiled
def drag(site, time, angle, speed, d):
    """Torque against the motion."""
    total = (d.one_way[site] if speed > 0.0 else 0.0) * speed
    if d.power[site] > 0.0:
        size = d.power[site] * (abs(speed) / d.power_speed[site]) ** d.exponent[site]
        total += size if speed > 0.0 else -size
    if d.warming[site] != 0.0:
        total += d.warming[site] * math.exp(-time / d.warming_time[site]) * speed
    if d.rub[site] > 0.0 or d.grip[site] > 0.0:
        sign = speed / math.sqrt(speed * speed + d.smooth_speed[site] ** 2)
        total += sign * d.rub[site] * math.exp((math.cos(angle - d.rub_angle[site]) - 1.0) / d.rub_width[site] ** 2)
        window = math.tanh((time - d.grip_start[site]) / 0.05) - math.tanh((time - d.grip_end[site]) / 0.05)
        total += sign * 0.5 * d.grip[site] * window
    return total
