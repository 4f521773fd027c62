"""A robot joint as one line: inverter-fed motor, input shaft on bearings, strain-wave gear, output shaft on bearings, arm.

    motor - coupling - hub =a= brake disc =b= wave generator - gear - output flange =c= encoder disc =d= arm

The input shaft (=) carries an unbalanced brake disc between two housed bearings, the wave generator sits overhung.  The
gear is made from its teeth: ratio and sense from the numbers of teeth, lost motion from the flank clearances, kinematic
error from the ovality of the circular spline, which passes its torque to a gear housing on an elastic foot.  The arm
hangs down at the start; as it turns past the top and the bottom its weight changes sides, and the mesh crosses its gap.

From the seeds: the structure (F: motor, shafts, inertias, flexspline with (7)-(10); M: rotors, bearings, housings; I: the
teeth of stage I of set C, 200/202 with m = 0.3 mm, r02 = 29.3 mm, w0 = 0.30 mm, of which m and r02 are the paper's).
Ours: everything else.  The gear is of size 25 (rated torque 67 N m, stiffness corners 14 and 48 N m in the order of what
makers print for that size, ratio 100); motor 0.4 kW at 100 Hz; masses, shafts, bearings, housings, dampings and errors are
sized so that the joint is plausible and the critical speeds lie in its speed range.

    from models.robot_joint_line import build
    result = hm.run_up(build("improved"), 3.0)

``torsional_line()`` is its torsion alone, stiff enough to be run thousands of times: the shafts as springs, their
bearings' rings beside the next body, nothing lateral.  ``bench()`` is what its builder knows of it, for
``hdrive-mbs diagnose models/robot_joint_line.py --records FOLDER``.

Left out: lateral forces of the teeth, the coupling and the wave generator's bearing (the input and the output shaft touch
each other through torque only), friction of the mesh, and what the arm does to its bearings as an eccentric body: it would
couple torsion with the bending of the output shaft, which changes the torque of the gear by some percent of its peak.  For
that put a Rotor with an eccentricity in place of ``arm`` and leave the effect ``weight_of_arm`` out.  For a Campbell
diagram give ``arm_angle=-pi/2``, so that the arm's weight loads the mesh; with the arm hanging the mesh lies in its gap.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from pathlib import Path

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.bench import Bench, Input, Uncertain
from hdrive_mbs.diagnosis.measured import Measured

YOUNGS_MODULUS, SHEAR_MODULUS = 2.1e11, 8.1e10
SHAFT_DAMPING = 1e-5
"""Of both shafts [s], over stiffness."""

INPUT = {"hub": 0.0, "bearing_a": 0.03, "brake_disc": 0.18, "bearing_b": 0.35, "wave_generator": 0.39}
OUTPUT = {"output_flange": 0.0, "bearing_c": 0.03, "encoder_disc": 0.07, "bearing_d": 0.11, "arm": 0.15}
"""Places on each shaft and their distances from its beginning [m]."""

INPUT_DIAMETER, OUTPUT_DIAMETER = hm.mm(12.0), hm.mm(32.0)
ARM_MASS, ARM_RADIUS = 4.0, 0.3
RING = 8e-6
"""Polar inertia of a bearing's inner ring [kg m^2]."""

POLAR_INERTIA = {
    "hub": 3e-5,
    "brake_disc": 3e-3,
    "wave_generator": 1.1e-4,
    "gear_housing": 0.05,
    "output_flange": 6e-4,
    "encoder_disc": 2e-4,
}
"""Of the bodies on the shafts and of the gear housing [kg m^2]."""

COUPLING = hm.Shaft(stiffness=120.0, damping=0.012)
HOUSING_FOOT = hm.Shaft(stiffness=2e6, damping=50.0)
ARM_DRAG = hm.ViscousDrag(coefficient=0.3)
OVALITY = 8e-6
"""Of the circular spline [m], amplitude of the second harmonic of its pitch deviation."""

FINAL_SPEED, RAMP = 480.0, 2.5
"""Synchronous speed of the inverter at the end of its ramp [rad/s], and how long that takes [s]."""


def gear() -> hm.HarmonicGear:
    """The teeth: 200/202, checked for interference when the drive is made."""
    return hm.HarmonicGear.standard(
        flexspline_teeth=200,
        circular_spline_teeth=202,
        module=hm.mm(0.3),
        profile_angle=hm.degrees(30.0),
        addendum=hm.mm(0.24),
        clearance=hm.mm(0.06),
        backlash=hm.mm(0.02),
        fibre_radius=hm.mm(29.3),
        deformation=hm.CosineDeformation(amplitude=hm.mm(0.30)),
    )


def drive(teeth: hm.HarmonicGear) -> hm.HarmonicDrive:
    """The gear with the three stiffnesses of its size and the lost motion of its teeth."""
    stiffness = hm.PiecewiseLinearStiffness(
        lost_motion=teeth.lost_motion, stiffness_1=3.1e4, stiffness_2=5.0e4, stiffness_3=5.7e4, torque_1=14.0, torque_2=48.0
    )
    return hm.HarmonicDrive.from_gear(teeth, stiffness=stiffness, damping=12.0)


def motor(feed: hm.SpeedProfile) -> hm.Motor:
    """0.4 kW, two poles, 100 Hz, 5700 rpm, breakdown ratio 2.5; fed by an inverter with this synchronous speed."""
    characteristic = hm.InverterMotor(
        rated_power=400.0,
        rated_speed=hm.rpm(5700.0),
        pole_pairs=1.0,
        line_frequency=100.0,
        breakdown_ratio=2.5,
        feed=feed,
    )
    return hm.Motor(inertia=3e-4, viscous=2e-4, characteristic=characteristic)


def _bearing(*, radial: float, tilt: float, housing: hm.Housing, locating: bool) -> hm.Bearing:
    law = hm.LinearBearing.isotropic(
        radial=radial,
        damping=200.0,
        axial=2e7 if locating else 0.0,
        axial_damping=200.0 if locating else 0.0,
        tilt=tilt,
        tilt_damping=0.02,
    )
    return hm.Bearing(law=law, mass=0.06, polar_inertia=RING, transverse_inertia=6e-6, housing=housing)


def _shaft(places: dict[str, float], diameter: float, number: int) -> tuple[dict[str, hm.Component], list[str]]:
    """Sections between the places of a shaft, and the chain through all of them."""
    parts: dict[str, hm.Component] = {}
    chain = [next(iter(places))]
    for k, (left, right) in enumerate(itertools.pairwise(places), start=number):
        parts[f"section_{k}"] = hm.ShaftSection(
            length=places[right] - places[left],
            diameter=diameter,
            youngs_modulus=YOUNGS_MODULUS,
            shear_modulus=SHEAR_MODULUS,
            damping=SHAFT_DAMPING,
        )
        chain += [f"section_{k}", right]
    return parts, chain


def _arm_inertia(arm_mass: float) -> float:
    return 0.04 + arm_mass * ARM_RADIUS**2


def _with_arm_and_ovality(scene: hm.Scene, teeth: hm.HarmonicGear, arm_mass: float, arm_angle: float, ovality: float) -> hm.Scene:
    """Weight and drag of the arm, and the kinematic error of the oval circular spline."""
    weight = hm.EccentricLoad(mass=arm_mass, radius=ARM_RADIUS, start_angle=arm_angle)
    scene = scene.with_effect(weight, at="arm", name="weight_of_arm").with_effect(ARM_DRAG, at="arm", name="drag_of_arm")
    for effect in hm.tooth_errors(teeth, [hm.WheelError(wheel="circular_spline", harmonic=2, amplitude=ovality)]):
        scene = scene.with_effect(effect, at="gear.mesh", name="ovality")
    return scene


def build(
    bearing: str = "full",
    *,
    eccentricity: float = 5e-6,
    arm_mass: float = ARM_MASS,
    arm_angle: float = 0.0,
    ovality: float = OVALITY,
    final_speed: float = FINAL_SPEED,
    ramp: float = RAMP,
) -> hm.Scene:
    """The joint.

    bearing : "full", "simplified" (seed M section 5) or "improved" (condensed)
    eccentricity : of the brake disc [m];  ovality : of the circular spline [m]
    arm_mass : of the arm, at ARM_RADIUS from the axis [kg];  arm_angle : of the arm at t = 0 from hanging down [rad]
    final_speed, ramp : synchronous speed of the inverter at the end [rad/s], and its time [s]
    """
    if bearing not in ("full", "simplified", "improved"):
        raise hm.ParameterError(f"bearing = {bearing!r}: must be one of full, simplified, improved.")
    teeth = gear()
    input_housing = hm.Housing(mass=0.9, stiffness_x=8e5, stiffness_y=2e6, damping_x=150.0, damping_y=150.0)
    output_housing = hm.Housing.isotropic(mass=1.5, stiffness=2e7, damping=1500.0)
    small = {"radial": 2e7, "tilt": 50.0, "housing": input_housing}
    large = {"radial": 1e8, "tilt": 5e3, "housing": output_housing}
    input_parts, input_chain = _shaft(INPUT, INPUT_DIAMETER, 1)
    output_parts, output_chain = _shaft(OUTPUT, OUTPUT_DIAMETER, len(INPUT))
    parts: dict[str, hm.Component] = {
        "gravity": hm.Gravity(),
        "motor": motor(hm.SpeedRamp(start=0.0, end=final_speed, duration=ramp)),
        "coupling": COUPLING,
        "hub": hm.Rotor(mass=0.15, polar_inertia=POLAR_INERTIA["hub"], transverse_inertia=2.5e-5),
        "bearing_a": _bearing(**small, locating=True),
        "brake_disc": hm.Rotor(mass=2.0, polar_inertia=POLAR_INERTIA["brake_disc"], transverse_inertia=1.6e-3, eccentricity=eccentricity),
        "bearing_b": _bearing(**small, locating=False),
        "wave_generator": hm.Rotor(mass=0.25, polar_inertia=POLAR_INERTIA["wave_generator"], transverse_inertia=7e-5),
        **input_parts,
        "gear": drive(teeth),
        "gear_housing": hm.Inertia(inertia=POLAR_INERTIA["gear_housing"]),
        "housing_foot": HOUSING_FOOT,
        "output_flange": hm.Rotor(mass=0.8, polar_inertia=POLAR_INERTIA["output_flange"], transverse_inertia=4e-4),
        "bearing_c": _bearing(**large, locating=True),
        "encoder_disc": hm.Rotor(mass=0.3, polar_inertia=POLAR_INERTIA["encoder_disc"], transverse_inertia=1.1e-4),
        "bearing_d": _bearing(**large, locating=False),
        "arm": hm.Rotor(
            mass=1.0 + arm_mass, polar_inertia=_arm_inertia(arm_mass), transverse_inertia=0.03 + 0.5 * arm_mass * ARM_RADIUS**2
        ),
        **output_parts,
    }
    full = hm.Scene(
        name="robot joint line",
        parts=parts,
        connections=[
            ("motor", "coupling", *input_chain),
            ("wave_generator", "gear", *output_chain),
            ("gear.circular_spline", "gear_housing", "housing_foot", "ground"),
        ],
        notes="Teeth: Ianici and Ianici 2017, stage I of set C; everything else is assumed for a gear of size 25, ratio 100.",
    )
    full = _with_arm_and_ovality(full, teeth, arm_mass, arm_angle, ovality)
    return full if bearing == "full" else hm.with_bearings(full, bearing, highest_speed=2.0 * final_speed)


def torsional_line(
    *,
    arm_mass: float = ARM_MASS,
    arm_angle: float = 0.0,
    ovality: float = OVALITY,
    feed: hm.SpeedProfile | None = None,
) -> hm.Scene:
    """The torsion of the joint as five bodies, with an encoder at the motor and one on the encoder disc.

    Bodies that sit close together are one: the hub with the brake disc, the output flange with the encoder disc.  The
    springs in line with the gear are in its stiffness: the shaft between flange and encoder disc, and the foot of the
    gear housing.  That is exact at rest (springs in line, K1 to K3 alike, between the same torques); the damping is that
    of the first branch.  Left out: bending, what the unbalance does to the spin, and vibration above some hundred hertz.

    feed : synchronous speed of the inverter; the ramp of ``build`` if not given.  The others as there
    """
    teeth = gear()
    parts: dict[str, hm.Component] = {
        "motor": motor(feed or hm.SpeedRamp(start=0.0, end=FINAL_SPEED, duration=RAMP)),
        "coupling": COUPLING,
        "brake_disc": hm.Inertia(inertia=POLAR_INERTIA["hub"] + POLAR_INERTIA["brake_disc"] + 2.0 * RING),
        "input_shaft": _spring(INPUT["wave_generator"] - INPUT["brake_disc"], INPUT_DIAMETER),
        "wave_generator": hm.Inertia(inertia=POLAR_INERTIA["wave_generator"]),
        "gear": _gear_and_springs(drive(teeth)),
        "encoder_disc": hm.Inertia(inertia=POLAR_INERTIA["output_flange"] + POLAR_INERTIA["encoder_disc"] + 2.0 * RING),
        "output_shaft": _spring(OUTPUT["arm"] - OUTPUT["encoder_disc"], OUTPUT_DIAMETER),
        "arm": hm.Inertia(inertia=_arm_inertia(arm_mass)),
        "motor_encoder": hm.Sensor(quantity="motor.angle"),
        "output_encoder": hm.Sensor(quantity="encoder_disc.angle"),
    }
    chain = ("motor", "coupling", "brake_disc", "input_shaft", "wave_generator", "gear", "encoder_disc", "output_shaft", "arm")
    scene = hm.Scene(name="robot joint line, torsion", parts=parts, connections=[chain])
    return _with_arm_and_ovality(scene, teeth, arm_mass, arm_angle, ovality)


def _gear_and_springs(one: hm.HarmonicDrive) -> hm.HarmonicDrive:
    """The gear with the springs in line with it: 1/K' = 1/K + 1/k + (1 + 1/u)^2/k_foot."""
    law = one.law
    assert isinstance(law, hm.PiecewiseLinearStiffness)
    assert isinstance(HOUSING_FOOT.stiffness, float)
    shaft = _spring(OUTPUT["encoder_disc"] - OUTPUT["output_flange"], OUTPUT_DIAMETER).stiffness
    compliance = 1.0 / shaft + (1.0 + 1.0 / one.ratio) ** 2 / HOUSING_FOOT.stiffness
    softer = [1.0 / (1.0 / k + compliance) for k in (law.stiffness_1, law.stiffness_2, law.stiffness_3)]
    stiffness = dataclasses.replace(law, stiffness_1=softer[0], stiffness_2=softer[1], stiffness_3=softer[2])
    return dataclasses.replace(one, stiffness=stiffness, damping=one.damping * (softer[0] / law.stiffness_1) ** 2)


def _spring(length: float, diameter: float) -> hm.Shaft:
    stiffness = SHEAR_MODULUS * math.pi * diameter**4 / 32.0 / length
    return hm.Shaft(stiffness=stiffness, damping=SHAFT_DAMPING * stiffness)


KNOWLEDGE: dict[str, Uncertain] = {
    name: Uncertain(paths=(path,), sigma=sigma)
    for name, path, sigma in (
        ("motor inertia", "motor.inertia", 0.03),
        ("motor drag", "motor.viscous", 0.1),
        ("motor power", "motor.characteristic.rated_power", 0.03),
        ("coupling stiffness", "coupling.stiffness", 0.05),
        ("coupling damping", "coupling.damping", 0.1),
        ("brake disc inertia", "brake_disc.inertia", 0.03),
        ("gear stiffness 1", "gear.stiffness.stiffness_1", 0.04),
        ("gear stiffness 2", "gear.stiffness.stiffness_2", 0.04),
        ("lost motion", "gear.stiffness.lost_motion", 0.05),
        ("gear damping", "gear.damping", 0.1),
        ("ovality", "ovality.amplitude", 0.1),
        ("arm inertia", "arm.inertia", 0.03),
        ("arm weight", "weight_of_arm.mass", 0.02),
        ("arm drag", "drag_of_arm.coefficient", 0.1),
    )
}
"""Parameters that are not known exactly, with the standard deviation of their logarithm."""

MEASURED = {
    "motor_torque": Measured(channel="motor.torque", noise=0.01),
    "motor_angle": Measured(channel="motor_encoder", noise=1e-3),
    "output_angle": Measured(channel="output_encoder", noise=4e-5),
}
"""Columns of a record: torque that the inverter computes from its currents, an encoder on either side of the gear."""


def bench() -> Bench:
    """What is known of the joint's torsion.  Its records give the inverter's synchronous speed as ``feed_speed``."""
    return Bench(
        scene=torsional_line(),
        knowledge=KNOWLEDGE,
        measured=MEASURED,
        inputs={"feed_speed": Input(path="motor.characteristic.feed", law=lambda t, w: hm.SpeedTable(times=t, speeds=w))},
        together={"gear stiffness": ("gear stiffness 1", "gear stiffness 2")},
    )


def bundled_records() -> Path:
    """Folder with a record of this joint, simulated by another program (benchmarks/flagship), with a cause for ``bench()`` to miss."""
    return Path(hm.__file__).parent / "data" / "robot_joint_line"
