"""What the sensors of the rotor bench show: channels, faults, noise, rounding."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.withheld.case import Column
from benchmarks.withheld.noise import coloured, rounded
from benchmarks.withheld.plant.rotor_line.equations import COORDINATES, SPIN, FloatArray
from benchmarks.withheld.plant.rotor_line.planted import SensorFaults
from benchmarks.withheld.plant.rotor_line.records import ACCELEROMETERS, PROBES, Run

# channel: (unit, noise, resolution)
TORQUE = ("N m", 0.05, 0.02)
ANGLE = ("rad", 0.0, 2 * math.pi / 8192)
PROBE = ("m", 2.5e-7, 1e-7)
ACCELEROMETER = ("m/s^2", 0.05, 0.02)
HAMMER = ("N", 1.0, 0.0)
OFFSET = 1.5e-5  # m, standard deviation of a probe's offset in a record
MEMORY = 0.8  # of the coloured half of the noise, a sample: 1.1 ms
CHANNELS = {"motor_torque": TORQUE, "spin_angle": ANGLE, **dict.fromkeys(PROBES, PROBE), **dict.fromkeys(ACCELEROMETERS, ACCELEROMETER)}
_STATION = {"r1_x": 1, "r1_y": 1, "r2_x": 3, "r2_y": 3}


def shown(run: Run, faults: SensorFaults) -> dict[str, FloatArray]:
    """The channels without noise, offset and rounding; the hammer is an input and not among them."""
    found = {"motor_torque": run.torque, "spin_angle": run.states[:, SPIN]}
    for name, k in PROBES.items():
        found[name] = _probe(name, run.states[:, k], run.states[:, SPIN + _STATION[name]], faults)
    found.update({name: run.slopes[:, COORDINATES + k] for name, k in ACCELEROMETERS.items()})
    return found


def _probe(name: str, centre: FloatArray, angle: FloatArray, faults: SensorFaults) -> FloatArray:
    """The surface under a probe: the y probe sees it a quarter turn later; then the amplifier's error."""
    station = _STATION[name]
    seen = angle - (0.5 * np.pi if name.endswith("y") else 0.0)
    value = centre
    for order, amplitude, phase in faults.runout.get(station, ()):
        value = value + amplitude * np.cos(order * seen + phase)
    if station in faults.scratch:
        depth, place, width = faults.scratch[station]
        value = value - depth * np.exp((np.cos(seen - place) - 1.0) / width**2)
    if name in faults.gain:
        error, curve = faults.gain[name]
        value = value * (1.0 + error) + curve * value**2
    return value


def measured(run: Run, faults: SensorFaults, rng: np.random.Generator, *, memory: float = 0.0) -> list[Column]:
    """The table of one record."""
    count = run.time.size
    columns = [Column(name="time", unit="s", values=run.time)]
    for name, clean in shown(run, faults).items():
        unit, noise, resolution = CHANNELS[name]
        value = clean + coloured(rng, noise, memory, count)
        if name in PROBES:
            value = value + OFFSET * rng.standard_normal()
        columns.append(Column(name=name, unit=unit, values=rounded(value, resolution), single=name != "spin_angle"))
    if run.hammer.any():
        for axis, name in enumerate(("hammer_x", "hammer_y")):
            columns.append(
                Column(name=name, unit=HAMMER[0], values=run.hammer[:, axis] + coloured(rng, HAMMER[1], memory, count), single=True)
            )
    return columns
