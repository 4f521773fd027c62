"""A drive bench as its builder knows it: servo motor, shaft, strain-wave gear, shaft, and a load with a brake.

The numbers are those of the bench's data sheet (withheld cases, round 1, drive_bench.toml).  At 2 kHz it records the
commanded motor torque, an encoder at the motor and one at the load, and the torque of the output shaft, while a
speed reference and a brake torque are given: ``staircase``, ``load_cycle`` and ``sweep``, 9 s each, from rest.

    from models import drive_bench
    scene = drive_bench.build(speed_reference=(times, speeds), load_torque=(times, torques))
    response = hm.simulate(scene, 9.0, solver=drive_bench.SOLVER)

With ``motor_torque=(times, torques)`` the recorded torque drives the motor in place of its controller.  Its noise then
adds up in the absolute angles; twists and the output torque hardly see it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.bench import Bench, Input, Uncertain
from hdrive_mbs.diagnosis.measured import Measured

Table = tuple[Sequence[float], Sequence[float]]
"""Times [s] and values."""

RATIO, TORQUE_1, TORQUE_2 = 100.0, 23.5, 98.0
WAVE_GENERATOR_INERTIA, FLEXSPLINE_INERTIA = 4.5e-4, 0.012
GAIN, INTEGRAL_GAIN, TORQUE_LIMIT = 0.35, 4.0, 9.0
"""Of the speed control of the motor [N m s/rad, N m/rad, N m], continuous in time."""

NOMINAL: dict[str, float] = {
    "motor_inertia": 2.1e-3,
    "motor_viscous": 2.0e-3,  # every viscous on the absolute speed, every damping on the relative one
    "input_shaft_stiffness": 400.0,
    "input_shaft_damping": 0.05,
    "wave_generator_viscous": 1.5e-3,
    "flexspline_stiffness_1": 3.2e4,
    "flexspline_stiffness_2": 6.4e4,
    "flexspline_stiffness_3": 1.1e5,
    "lost_motion": 2.9e-4,
    "flexspline_damping": 12.0,
    "output_shaft_stiffness": 5.19e4,
    "output_shaft_damping": 6.0,
    "load_inertia": 1.8,
    "load_viscous": 0.4,
}
"""Parameters of the bench that are not known exactly, SI."""

KNOWLEDGE: dict[str, float] = {
    name: 0.05 if name == "lost_motion" else 0.09 if name.endswith(("viscous", "damping")) else 0.03 for name in NOMINAL
}
"""Standard deviation of the logarithm of each parameter, independent of each other: lost motion 0.05, damping and viscous
drag 0.09, inertias and stiffnesses 0.03."""

PATHS: dict[str, tuple[str, ...]] = {
    "motor_inertia": ("motor.inertia",),
    "motor_viscous": ("motor.viscous",),
    "input_shaft_stiffness": ("input_shaft.stiffness",),
    "input_shaft_damping": ("input_shaft.damping",),
    "wave_generator_viscous": ("wave_generator.viscous",),
    **{f"flexspline_stiffness_{k}": (f"gear.stiffness.stiffness_{k}",) for k in (1, 2, 3)},
    "lost_motion": ("gear.stiffness.lost_motion",),
    "flexspline_damping": ("gear.damping",),
    "output_shaft_stiffness": ("output_shaft.stiffness",),
    "output_shaft_damping": ("output_shaft.damping",),
    "load_inertia": ("load.inertia",),
    "load_viscous": ("load.viscous",),
}
"""Where each parameter sits in the scene, for ``scene.replacing``."""

CHANNELS: dict[str, str] = {
    "motor_torque": "motor.torque",
    "motor_angle": "motor_encoder",
    "load_angle": "load_encoder",
    "output_torque": "torque_sensor",
    "load_torque": "load.torque",
}
"""Column of a record -> channel of the scene: readings of its three sensors, the command of its motor, what is given."""

INPUTS = ("speed_reference", "load_torque")
OFFSETS: dict[str, float] = {"output_torque": 0.3}
"""Columns with an offset that is drawn for each record, and its standard deviation."""

NOISE: dict[str, float] = {"motor_torque": 0.02, "motor_angle": 0.0, "load_angle": 1.5e-6, "output_torque": 0.35}
"""Standard deviation of the noise of each column, SI."""

COLOURED: dict[str, tuple[float, float]] = {"output_torque": (0.21, 0.95)}
"""Part of the noise that is first-order coloured: standard deviation, and what a sample keeps of the one before."""

RESOLUTION: dict[str, float] = {
    "motor_torque": 0.005,
    "motor_angle": 2.0 * math.pi / 16384.0,
    "load_angle": 2.0 * math.pi / 4e6,
    "output_torque": 0.1,
}
"""Steps of the columns, which are rounded after the noise is added, SI."""

TOGETHER: dict[str, tuple[str, ...]] = {"flexspline_stiffness": tuple(f"flexspline_stiffness_{k}" for k in (1, 2, 3))}
"""Parameters that are wrong together, if they are wrong; of the others each may be wrong alone."""

SAMPLE_TIME, DURATION = 1.0 / 2000.0, 9.0
SOLVER = hm.DormandPrince(relative_tolerance=1e-7, absolute_tolerance=1e-9)


def noise() -> dict[str, float]:
    """Standard deviation of each column: noise and rounding (a uniform error of one step)."""
    return {name: math.hypot(sigma, RESOLUTION[name] / math.sqrt(12.0)) for name, sigma in NOISE.items()}


def build(
    *,
    speed_reference: Table | None = None,
    load_torque: Table | None = None,
    motor_torque: Table | None = None,
    **parameters: float,
) -> hm.Scene:
    """The bench with its inputs, straight lines between their points.

    speed_reference : of the motor [rad/s]; if not given, from rest to 100 rad/s in 0.5 s
    load_torque : brake torque on the load [N m]; if not given, none
    motor_torque : recorded torque of the motor [N m], which then drives it in place of the controller
    parameters : other values for those of NOMINAL

    Raises ParameterError for an unknown parameter, or for both a reference and a torque.
    """
    for name in parameters:
        if name not in NOMINAL:
            raise hm.ParameterError(f"No parameter {name!r}. The drive bench has: {', '.join(NOMINAL)}.")
    if speed_reference is not None and motor_torque is not None:
        raise hm.ParameterError("The drive bench follows either a speed_reference or a motor_torque; leave one out.")
    p = NOMINAL | parameters
    brake: hm.LoadLaw = hm.ConstantTorque(value=0.0)
    if load_torque is not None:
        brake = hm.TableTorque(times=tuple(load_torque[0]), torques=tuple(load_torque[1]))
    stiffness = hm.PiecewiseLinearStiffness(
        lost_motion=p["lost_motion"],
        stiffness_1=p["flexspline_stiffness_1"],
        stiffness_2=p["flexspline_stiffness_2"],
        stiffness_3=p["flexspline_stiffness_3"],
        torque_1=TORQUE_1,
        torque_2=TORQUE_2,
    )
    return hm.Scene(
        name="drive bench",
        parts={
            "motor": hm.Motor(inertia=p["motor_inertia"], viscous=p["motor_viscous"], characteristic=_motor(speed_reference, motor_torque)),
            "input_shaft": hm.Shaft(stiffness=p["input_shaft_stiffness"], damping=p["input_shaft_damping"]),
            "wave_generator": hm.Inertia(inertia=WAVE_GENERATOR_INERTIA, viscous=p["wave_generator_viscous"]),
            "gear": hm.HarmonicDrive(
                ratio=RATIO,
                output_sense="same",
                stiffness=stiffness,
                damping=p["flexspline_damping"],
                flexspline_inertia=FLEXSPLINE_INERTIA,
            ),
            "output_shaft": hm.Shaft(stiffness=p["output_shaft_stiffness"], damping=p["output_shaft_damping"]),
            "load": hm.Load(inertia=p["load_inertia"], viscous=p["load_viscous"], torque=brake),
            "motor_encoder": hm.Sensor(quantity="motor.angle"),
            "load_encoder": hm.Sensor(quantity="load.angle"),
            "torque_sensor": hm.Sensor(quantity="output_shaft.torque"),
        },
        connections=[("motor", "input_shaft", "wave_generator", "gear", "output_shaft", "load")],
    )


def bench() -> Bench:
    """What is known of the bench, for ``hdrive-mbs diagnose models/drive_bench.py --records FOLDER``."""
    still = ((0.0, 1.0), (0.0, 0.0))
    return Bench(
        scene=build(speed_reference=still, load_torque=still),
        knowledge={name: Uncertain(paths=PATHS[name], sigma=sigma) for name, sigma in KNOWLEDGE.items()},
        measured={name: _measured(name) for name in NOISE},
        inputs={
            "speed_reference": Input(
                path="motor.characteristic.reference", law=lambda times, speeds: hm.SpeedTable(times=times, speeds=speeds)
            ),
            "load_torque": Input(path="load.torque", law=lambda times, torques: hm.TableTorque(times=times, torques=torques)),
        },
        together=TOGETHER,
    )


def _measured(column: str) -> Measured:
    coloured = COLOURED.get(column, (0.0, 0.0))
    return Measured(
        channel=CHANNELS[column],
        noise=math.sqrt(NOISE[column] ** 2 - coloured[0] ** 2),
        resolution=RESOLUTION[column],
        coloured=coloured,
        offset=OFFSETS.get(column, 0.0),
    )


def _motor(speed_reference: Table | None, motor_torque: Table | None) -> hm.MotorCharacteristic:
    if motor_torque is not None:
        return hm.TorqueHistory(times=tuple(motor_torque[0]), torques=tuple(motor_torque[1]))
    reference: hm.SpeedProfile = hm.SpeedRamp(start=0.0, end=100.0, duration=0.5)
    if speed_reference is not None:
        reference = hm.SpeedTable(times=tuple(speed_reference[0]), speeds=tuple(speed_reference[1]))
    return hm.ServoMotor(torque_limit=TORQUE_LIMIT, proportional_gain=GAIN, integral_gain=INTEGRAL_GAIN, reference=reference)
