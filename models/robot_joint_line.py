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

Left out: lateral forces of the teeth, the coupling and the wave generator's bearing (the input and the output shaft touch
each other through torque only), friction of the mesh, and what the arm does to its bearings as an eccentric body: it would
couple torsion with the bending of the output shaft, which changes the torque of the gear by some percent of its peak.  For
that put a Rotor with an eccentricity in place of ``arm`` and leave the effect ``weight_of_arm`` out.  For a Campbell
diagram give ``arm_angle=-pi/2``, so that the arm's weight loads the mesh; with the arm hanging the mesh lies in its gap.
"""

from __future__ import annotations

import itertools

import hdrive_mbs as hm

YOUNGS_MODULUS, SHEAR_MODULUS = 2.1e11, 8.1e10
SHAFT_DAMPING = 1e-5
"""Of both shafts [s], over stiffness."""

INPUT = {"hub": 0.0, "bearing_a": 0.03, "brake_disc": 0.18, "bearing_b": 0.35, "wave_generator": 0.39}
OUTPUT = {"output_flange": 0.0, "bearing_c": 0.03, "encoder_disc": 0.07, "bearing_d": 0.11, "arm": 0.15}
"""Places on each shaft and their distances from its beginning [m]."""

INPUT_DIAMETER, OUTPUT_DIAMETER = hm.mm(12.0), hm.mm(32.0)
ARM_MASS, ARM_RADIUS = 4.0, 0.3
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


def motor(final_speed: float = FINAL_SPEED, ramp: float = RAMP) -> hm.Motor:
    """0.4 kW, two poles, 100 Hz, 5700 rpm, breakdown ratio 2.5; fed with a frequency that rises in proportion to time."""
    characteristic = hm.InverterMotor(
        rated_power=400.0,
        rated_speed=hm.rpm(5700.0),
        pole_pairs=1.0,
        line_frequency=100.0,
        breakdown_ratio=2.5,
        feed=hm.SpeedRamp(start=0.0, end=final_speed, duration=ramp),
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
    return hm.Bearing(law=law, mass=0.06, polar_inertia=8e-6, transverse_inertia=6e-6, housing=housing)


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
        "motor": motor(final_speed, ramp),
        "coupling": hm.Shaft(stiffness=120.0, damping=0.012),
        "hub": hm.Rotor(mass=0.15, polar_inertia=3e-5, transverse_inertia=2.5e-5),
        "bearing_a": _bearing(**small, locating=True),
        "brake_disc": hm.Rotor(mass=2.0, polar_inertia=3e-3, transverse_inertia=1.6e-3, eccentricity=eccentricity),
        "bearing_b": _bearing(**small, locating=False),
        "wave_generator": hm.Rotor(mass=0.25, polar_inertia=1.1e-4, transverse_inertia=7e-5),
        **input_parts,
        "gear": drive(teeth),
        "gear_housing": hm.Inertia(inertia=0.05),
        "housing_foot": hm.Shaft(stiffness=2e6, damping=50.0),
        "output_flange": hm.Rotor(mass=0.8, polar_inertia=6e-4, transverse_inertia=4e-4),
        "bearing_c": _bearing(**large, locating=True),
        "encoder_disc": hm.Rotor(mass=0.3, polar_inertia=2e-4, transverse_inertia=1.1e-4),
        "bearing_d": _bearing(**large, locating=False),
        "arm": hm.Rotor(
            mass=1.0 + arm_mass, polar_inertia=0.04 + arm_mass * ARM_RADIUS**2, transverse_inertia=0.03 + 0.5 * arm_mass * ARM_RADIUS**2
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
    full = full.with_effect(hm.EccentricLoad(mass=arm_mass, radius=ARM_RADIUS, start_angle=arm_angle), at="arm", name="weight_of_arm")
    full = full.with_effect(hm.ViscousDrag(coefficient=0.3), at="arm", name="drag_of_arm")
    errors = hm.tooth_errors(teeth, [hm.WheelError(wheel="circular_spline", harmonic=2, amplitude=ovality)])
    for effect in errors:
        full = full.with_effect(effect, at="gear.mesh", name="ovality")
    return full if bearing == "full" else hm.with_bearings(full, bearing, highest_speed=2.0 * final_speed)
