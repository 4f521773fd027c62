"""Channels in units of their noise."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.signal import lfilter

from benchmarks.withheld.case import Array
from benchmarks.withheld.plant.drive_train import sensors

_ROUNDING = 12.0**-0.5
_WHITE = {
    "motor_torque": np.hypot(sensors.MOTOR_TORQUE_NOISE, sensors.MOTOR_TORQUE_STEP * _ROUNDING),
    "motor_angle": sensors.MOTOR_ANGLE_STEP * _ROUNDING,
    "load_angle": np.hypot(sensors.LOAD_ANGLE_NOISE, sensors.LOAD_ANGLE_STEP * _ROUNDING),
}


def in_noise(channels: Mapping[str, Array]) -> Array:
    """All channels of a record as one vector whose noise is white and of size 1, the torque offset taken out."""
    parts = [channels[name] / size for name, size in _WHITE.items()]
    torque = _torque_white(channels["output_torque"])
    constant = _torque_white(np.ones(torque.size))
    return np.concatenate([*parts, torque - constant * (constant @ torque) / (constant @ constant)])


def _torque_white(torque: Array) -> Array:
    """Whiten white plus first-order noise: (1 - m L)/(1 - t L)/s with t, s from the moments of the sum."""
    memory = sensors.OUTPUT_TORQUE_MEMORY
    white = sensors.OUTPUT_TORQUE_WHITE**2 + sensors.OUTPUT_TORQUE_STEP**2 / 12.0
    steps = sensors.OUTPUT_TORQUE_COLOURED**2 * (1.0 - memory**2)
    variance, neighbour = steps + white * (1.0 + memory**2), -memory * white
    half = -0.5 * variance / neighbour
    theta = half - np.sqrt(half**2 - 1.0)
    size = np.sqrt(-neighbour / theta)
    return np.asarray(lfilter([1.0, -memory], [1.0, -theta], torque) / size)
