"""Channels of the bench: what the sensors make of the motion, faults, noise and rounding."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.withheld import noise
from benchmarks.withheld.case import Array, Column
from benchmarks.withheld.plant.drive_train import excitation
from benchmarks.withheld.plant.drive_train.line import LOAD, LOAD_SPEED, MOTOR
from benchmarks.withheld.plant.drive_train.motion import Motion

MOTOR_TORQUE_NOISE, MOTOR_TORQUE_STEP = 0.02, 0.005  # N m
MOTOR_ANGLE_STEP = 2.0 * np.pi / 16384  # rad
LOAD_ANGLE_NOISE, LOAD_ANGLE_STEP = 1.5e-6, 2.0 * np.pi / 4e6  # rad
OUTPUT_TORQUE_WHITE, OUTPUT_TORQUE_COLOURED, OUTPUT_TORQUE_MEMORY = 0.28, 0.21, 0.95  # N m, N m, a sample
OUTPUT_TORQUE_OFFSET, OUTPUT_TORQUE_STEP = 0.3, 0.1  # N m


@dataclass(frozen=True, kw_only=True)
class Eccentricity:
    """Encoder disc off its axis: A (sin(a + p) - sin p) + r A (sin(2 a + q) - sin q)."""

    amplitude: float = 0.0  # rad, A
    phase: float = 0.0
    second: float = 0.0  # 1, r
    second_phase: float = 0.0

    def seen(self, angle: Array) -> Array:
        first = np.sin(angle + self.phase) - np.sin(self.phase)
        second = np.sin(2.0 * angle + self.second_phase) - np.sin(self.second_phase)
        return np.asarray(angle + self.amplitude * (first + self.second * second))


@dataclass(frozen=True, kw_only=True)
class Sensors:
    """Faults; none at the nominal bench."""

    motor_encoder: Eccentricity = Eccentricity()
    load_encoder: Eccentricity = Eccentricity()
    load_encoder_delay: float = 0.0  # s
    load_encoder_jump: float = 0.0  # rad
    load_encoder_jump_time: float = 0.0  # s
    torque_gain: float = 1.0
    torque_cubic: float = 0.0  # 1/(N m)^2: reading = gain T (1 + cubic T^2)
    torque_lag: float = 0.0  # s, first order
    torque_loop: float = 0.0  # 1, share by which the reading lags behind the torque at every turn
    torque_loop_limit: float = 1.0  # N m, by which the torque must have turned for the lag to turn as well
    lost_count: float = 0.0  # rad, that the load's encoder loses where it passes one angle
    lost_count_angle: float = 0.0  # rad


def clean(moved: Motion, sensors: Sensors) -> dict[str, Array]:
    """Channels without noise and rounding."""
    load_angle = _delayed(moved.states[:, LOAD], moved.states[:, LOAD_SPEED], sensors.load_encoder_delay)
    load_angle = sensors.load_encoder.seen(load_angle)
    time = np.arange(load_angle.size) / excitation.RATE
    load_angle = load_angle + sensors.load_encoder_jump * 0.5 * (1.0 + np.tanh((time - sensors.load_encoder_jump_time) / 2e-3))
    turns = np.floor((moved.states[:, LOAD] - sensors.lost_count_angle) / (2.0 * np.pi))
    load_angle = load_angle - sensors.lost_count * (turns - turns[0])
    torque = sensors.torque_gain * moved.output_torque * (1.0 + sensors.torque_cubic * moved.output_torque**2)
    if sensors.torque_loop != 0.0:
        torque = torque + sensors.torque_loop * _loops(moved.output_torque, sensors.torque_loop_limit)
    return {
        "motor_torque": moved.command,
        "motor_angle": sensors.motor_encoder.seen(moved.states[:, MOTOR]),
        "load_angle": load_angle,
        "output_torque": _lagged(torque, sensors.torque_lag),
    }


def _delayed(values: Array, rates: Array, delay: float) -> Array:
    """Values of ``delay`` seconds ago by Hermite interpolation between samples; the first value before the start."""
    if delay == 0.0:
        return values
    back = delay * excitation.RATE
    at = np.maximum(np.arange(values.size) - back, 0.0)
    k = np.minimum(at.astype(int), values.size - 2)
    x = at - k
    slope = rates / excitation.RATE
    here, there = values[k], values[k + 1]
    return np.asarray(
        here * (1 + 2 * x) * (1 - x) ** 2 + there * x**2 * (3 - 2 * x) + slope[k] * x * (1 - x) ** 2 + slope[k + 1] * x**2 * (x - 1)
    )


def _lagged(values: Array, lag: float) -> Array:
    """First-order lag of a signal that is linear between samples, exactly."""
    if lag == 0.0:
        return values
    keep = np.exp(-1.0 / (excitation.RATE * lag))
    mean = lag * excitation.RATE * (1.0 - keep)  # weight of the ramp
    found = np.empty_like(values)
    found[0] = values[0]
    for k in range(1, values.size):
        found[k] = keep * found[k - 1] + (mean - keep) * values[k - 1] + (1.0 - mean) * values[k]
    return found


def _loops(values: Array, limit: float) -> Array:
    """Three stops side by side (Prandtl-Ishlinskii): each follows the values and slips at its limit; none moves at the start."""
    total = np.zeros_like(values)
    for stop in (0.25 * limit, 0.5 * limit, limit):
        held = 0.0
        for k in range(1, values.size):
            held = min(max(held + values[k] - values[k - 1], -stop), stop)
            total[k] += held / 3.0
    return total


def measured(
    record: str, channels: dict[str, Array], rng: np.random.Generator, *, memories: dict[str, float] | None = None
) -> list[Column]:
    """The table of a record; ``memories`` gives part of the noise of a channel a memory (a sample)."""
    memory = {"motor_torque": 0.0, "load_angle": 0.0, "output_torque": 0.0, **(memories or {})}
    count = channels["motor_torque"].size
    reference, brake = (values[:count] for values in excitation.inputs(record))
    motor_torque = channels["motor_torque"] + noise.coloured(rng, MOTOR_TORQUE_NOISE, memory["motor_torque"], count)
    load_angle = channels["load_angle"] + noise.coloured(rng, LOAD_ANGLE_NOISE, memory["load_angle"], count)
    output_torque = channels["output_torque"] + OUTPUT_TORQUE_OFFSET * rng.standard_normal()
    output_torque = output_torque + noise.coloured(rng, OUTPUT_TORQUE_WHITE, memory["output_torque"], count)
    output_torque = output_torque + noise.first_order(rng, OUTPUT_TORQUE_COLOURED, OUTPUT_TORQUE_MEMORY, count)
    return [
        Column(name="time", unit="s", values=np.arange(count) / excitation.RATE),
        Column(name="speed_reference", unit="rad/s", values=reference),
        Column(name="motor_torque", unit="N m", values=noise.rounded(motor_torque, MOTOR_TORQUE_STEP), single=True),
        Column(name="load_torque", unit="N m", values=brake),
        Column(name="motor_angle", unit="rad", values=noise.rounded(channels["motor_angle"], MOTOR_ANGLE_STEP)),
        Column(name="load_angle", unit="rad", values=noise.rounded(load_angle, LOAD_ANGLE_STEP)),
        Column(name="output_torque", unit="N m", values=noise.rounded(output_torque, OUTPUT_TORQUE_STEP), single=True),
    ]
