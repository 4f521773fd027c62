"""Scene files: every class comes back as it was, units are converted, and nothing else gets in."""

from __future__ import annotations

import copy
import functools
import json
import math
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import hdrive_mbs as hm
from hdrive_mbs.components.flexible_coupling import FlexibleCoupling
from hdrive_mbs.components.improved_section import ImprovedSection
from hdrive_mbs.components.rigid_coupling import RigidCoupling
from hdrive_mbs.components.sensor import Sensor
from hdrive_mbs.components.simplified_section import SimplifiedSection
from hdrive_mbs.components.speed_controller import SpeedController
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import FileFormatError, HdriveError, ParameterError, PlaceError, SceneError, UnitError
from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.law import StiffnessLaw
from hdrive_mbs.loads.law import LoadLaw
from hdrive_mbs.motors.characteristic import MotorCharacteristic
from hdrive_mbs.motors.commanded import CommandedMotor
from hdrive_mbs.motors.ideal_speed import IdealSpeedMotor
from hdrive_mbs.motors.inverter import InverterMotor
from hdrive_mbs.motors.profiles.constant import ConstantSpeed
from hdrive_mbs.motors.profiles.ramp import SpeedRamp
from hdrive_mbs.motors.profiles.table import SpeedTable
from hdrive_mbs.motors.servo import ServoMotor
from hdrive_mbs.motors.torque_speed_table import TorqueSpeedTable
from hdrive_mbs.quantities import Described
from hdrive_mbs.scene_file import FORMAT, all_types, scene_from_dict, scene_to_dict
from hdrive_mbs.units import to_si
from tests.verification.scenes import catalogue, kloss_motor, train

# -- one example of every class ---------------------------------------------------------------------

PLATE: dict[str, float] = {"rated_power": 550.0, "rated_speed": 147.65, "pole_pairs": 2.0, "breakdown_ratio": 2.4}
LAWS: tuple[Described, ...] = (
    catalogue(),
    hm.LinearStiffness(constant=1.1e4),
    hm.CubicStiffness(linear=1.1e4, cubic=2.2e8, largest_twist=0.004),
    hm.ContinuousStiffness(lost_motion=1e-3, edge_stiffness=1e4, quadratic=0.0, cubic=1e9, largest_twist=0.005),
    hm.JumpTorqueStiffness(lost_motion=1e-3, linear=2e4, cubic=1e8),
    hm.JumpSecantStiffness(lost_motion=1e-3, linear=2e6, cubic=1e10, constant=3e3),
    hm.TableStiffness(twists=(-2e-3, -1e-3, 0.0, 1e-3, 3e-3), torques=(-40.0, -15.0, 0.0, 10.0, 50.0)),
    hm.ConstantTorque(value=-3.5),
    hm.SineTorque(mean=4.0, amplitude=3.0, frequency=1.25, phase=0.1),
    hm.RampTorque(start=0.0, end=10.0, duration=0.5, begin=0.125),
    hm.TableTorque(times=(0.0, 0.1, 0.3), torques=(1.0, 2.0, 1.0), periodic=True),
    hm.QuadraticLoad(coefficient=40.0),
    hm.TorqueSpeedLoad(speeds=(0.0, 1.0, 2.0), torques=(0.5, 1.0, 4.0), symmetry="odd"),
    kloss_motor(),
    InverterMotor(**PLATE, feed=SpeedRamp(start=0.0, end=157.0, duration=0.5)),
    ServoMotor(torque_limit=5.0, current_lag=1e-3, proportional_gain=0.5, integral_gain=3.0, reference=ConstantSpeed(value=100.0)),
    TorqueSpeedTable(speeds=(-10.0, 0.0, 150.0), torques=(5.0, 4.0, 0.0), extrapolate=True),
    IdealSpeedMotor(motion=SpeedTable(times=(0.0, 1.0, 2.0), speeds=(0.0, 10.0, 10.0))),
    hm.TorqueHistory(times=(0.0, 1.0, 2.0), torques=(0.0, 3.0, -1.0), held=True),
)


def teeth(deformation: hm.DeformationLaw) -> hm.HarmonicGear:
    return hm.HarmonicGear.standard(
        flexspline_teeth=200,
        circular_spline_teeth=202,
        module=hm.mm(0.3),
        profile_angle=0.52,
        addendum=hm.mm(0.2),
        clearance=hm.mm(0.06),
        backlash=hm.mm(0.05),
        fibre_radius=hm.mm(29.3),
        deformation=deformation,
    )


def outlined(gear: hm.HarmonicGear) -> hm.HarmonicGear:
    """The same gear with the flexspline's tooth given by its points."""
    straight = gear.flexspline
    flank = straight.right_flank()
    heights = np.hypot(*flank.T) - straight.root_radius
    heights[0] = 0.0
    points = {"heights": tuple(heights), "half_widths": tuple(flank[:, 0])}
    wheel = hm.OutlinedWheel(teeth=straight.teeth, tip_radius=straight.tip_radius, root_radius=straight.root_radius, **points)
    return gear.replacing(flexspline=wheel)


@functools.cache
def gears() -> tuple[hm.HarmonicDrive, ...]:
    from models.double_harmonic_transmission import gear as double

    angles = tuple(np.linspace(0.0, math.pi, 37))
    w0 = hm.mm(0.3)
    shapes = (
        hm.CosineDeformation(amplitude=w0),
        hm.TwoRollerDeformation(amplitude=w0),
        hm.FourForceDeformation(amplitude=w0, force_angle=hm.degrees(30.0)),
        hm.TableDeformation(angles=angles, displacements=tuple(w0 * math.cos(2.0 * angle) for angle in angles)),
    )
    examples = [*map(teeth, shapes), outlined(teeth(shapes[0])), double("A")]
    return tuple(hm.HarmonicDrive.from_gear(gear, stiffness=catalogue(), flexspline_inertia=1e-3) for gear in examples)


EFFECTS: tuple[tuple[Effect, str], ...] = (
    (hm.BoucWenHysteresis(torque_limit=2.0, yield_twist=1e-4, exponent=2.0, shape=0.6), "gear"),
    (hm.CoulombStribeckFriction(coulomb=1.0, breakaway=1.5, stribeck_speed=0.3), "load"),
    (hm.CouplingBacklash(backlash=hm.arcmin(3.0)), "output_shaft"),
    (hm.EccentricLoad(mass=2.0, radius=0.1, start_angle=0.3), "load"),
    (hm.KinematicError(amplitude=1e-4, order=2.0, phase=0.5, follows="flexspline"), "gear.mesh"),
    (hm.LuGreFriction(coulomb=1.0, breakaway=1.4, stiffness=500.0, damping=0.5, viscous=0.1), "load"),
    (hm.MaxwellSlipHysteresis(stiffness=(1e3, 2e3), torque_limit=(1.0, 3.0), rounding=0.2), "gear"),
    (hm.MeshFriction(loss_factor=0.1, no_load=0.01), "gear"),
    (hm.QuadraticDrag(coefficient=0.01), "load"),
    (hm.TorqueRipple(amplitude=0.01, relative=0.02, order=4.0, phase=0.2), "motor"),
    (hm.ViscousDrag(coefficient=0.2), "gear.flexspline"),
    (hm.DahlFriction(coulomb=1.0, presliding=1e-3, exponent=0.8), "load"),
    (hm.IwanHysteresis(torque_limit=2.0, slip_twist=1e-3), "gear"),
    (hm.StiffnessAsymmetry(asymmetry=-0.2), "gear"),
    (hm.LostMotion(width=1e-4, film=1e-5), "gear"),
    (hm.SoftWindup(width=1e-4, soft_twist=1e-5), "gear"),
    (hm.FilmBacklash(backlash=1e-3, film=1e-4, film_damping=0.1), "input_shaft"),
    (hm.StiffnessVariation(variation=0.1, order=2.0, follows="flexspline"), "gear"),
    (hm.ParallelStiffnessVariation(variation=0.1, order=1.0), "gear"),
    (hm.InertiaVariation(variation=0.2, order=1.0, phase=0.3), "load"),
    (hm.Cogging(amplitude=0.1, order=24.0, second_amplitude=0.02), "motor"),
    (hm.HarmonicKinematicError(amplitude=1e-4, third_amplitude=1e-5), "gear"),
    (hm.BeatingKinematicError(amplitude=1e-4, modulation=0.2, modulation_phase=0.7), "gear"),
    (hm.ActuatorLag(time_constant=2e-3), "motor"),
    (hm.SupplySag(sag=0.01, torque_limit=9.0), "motor"),
    (hm.MotorScale(error=-0.1), "motor"),
    (hm.MotorSaturation(saturation=0.02), "motor"),
    (hm.HiddenMode(inertia=0.1, natural_frequency=100.0), "load"),
    (hm.FlexibleInertia(share=0.2, natural_frequency=100.0), "load"),
    (hm.SeriesCompliance(compliance=1e-5), "output_shaft"),
    (hm.Creep(compliance=1e-5, relaxation_time=0.3), "output_shaft"),
    (hm.JointSlip(slip_torque=80.0, slip_rate=1e-3), "output_shaft"),
    (hm.LoadLag(time_constant=2e-3), "load"),
    (hm.ExternalTorque(amplitude=2.0, frequency=200.0, phase=0.3), "load"),
    (hm.UnequalDrag(viscous=0.1, friction=-0.2), "load"),
    (hm.FrictionByAngle(mean=1.0, once=0.3, twice_phase=0.2), "load"),
    (hm.RubAtAngle(friction=1.0, angle=0.3), "load"),
    (hm.ThermalDrift(viscous_change=-0.1, time_constant=10.0), "load"),
    (hm.PreslidingFriction(coulomb=1.0, presliding=1e-3, drop=0.3), "load"),
    (hm.LubricatedFriction(coulomb=1.0, smoothing_speed=0.1, drop=0.3), "load"),
    (hm.SpreadSlipFriction(coulomb=1.0, presliding=1e-3, spread=2.0), "load"),
    (hm.MeshPreslidingFriction(loss_factor=0.1, stiffness=30.0), "gear"),
    (hm.PowerDrag(drag=0.2, exponent=1.75), "load"),
    (hm.DahlHysteresis(torque_limit=2.0, yield_twist=1e-4), "gear"),
    (hm.SpreadSlipHysteresis(torque_limit=2.0, slip_twist=1e-3), "gear"),
    (hm.OneSidedStiffness(change=-0.2, side="forward"), "gear"),
    (hm.RippleSpectrum(order=6.0, third_amplitude=0.01), "motor"),
    (hm.SecondOrderLag(delay=2e-3), "motor"),
    (hm.SensorGain(error=0.1), "encoder"),
    (hm.SensorOffset(offset=-0.1), "encoder"),
    (hm.SensorLag(time_constant=1e-3), "encoder"),
    (hm.SensorDelay(delay=1e-3), "encoder"),
    (hm.EncoderEccentricity(amplitude=1e-4, phase=0.3), "encoder"),
    (hm.SensorQuantisation(resolution=1e-3), "encoder"),
    (hm.SensorDrift(offset=1e-3, time_constant=2.0), "encoder"),
)

ROTOR_EFFECTS: tuple[tuple[Effect, str], ...] = (
    (hm.RotorUnbalance(unbalance=1e-5, phase=0.4, lever=0.01), "rotor"),
    (hm.DynamicUnbalance(couple=1e-6, phase=0.4), "rotor"),
    (hm.ShaftBow(amplitude=1e-5, phase=0.2), "rotor"),
    (hm.ShaftKink(angle=1e-4, phase=0.2, share=0.3), "shaft.element_2"),
    (hm.Misalignment(once=1.0, twice=2.0, twice_phase=0.3, roundness=0.5, lever=0.02), "bearing"),
    (hm.LoadedMisalignment(twice=2.0, growth=0.02, lever=0.02), "bearing"),
    (hm.OilWhirl(amplitude=3.0, ratio=0.46, onset=300.0), "bearing"),
    (hm.OilWhirlOnset(amplitude=3.0, ratio=0.46, onset=300.0), "bearing"),
    (hm.OilWhirlCycle(amplitude=3.0, ratio=0.46, onset=300.0, bound=0.5), "bearing"),
    (hm.VaryingOilWhirl(amplitude=3.0, ratio=0.46, onset=300.0, slope=0.01), "bearing"),
    (hm.BallPass(amplitude=3.0, order=3.57, sharpness=0.3), "bearing"),
    (hm.BallPassHarmonics(amplitude=3.0, order=3.57, second_amplitude=1.0), "bearing"),
    (hm.InnerRacePass(amplitude=3.0, order=5.43, load_direction=-1.0), "bearing"),
    (hm.InnerRacePulses(amplitude=3.0, order=5.43, load_zone=0.7), "bearing"),
    (hm.ExternalShock(amplitude=100.0, start=0.1), "bearing"),
    (hm.GroundVibration(amplitude=10.0, frequency=200.0), "bearing"),
    (hm.MagneticPull(stiffness=1e4, centre_y=1e-5, throb=3e3), "rotor"),
    (hm.PulsatingPull(stiffness=1e4, centre_y=1e-5, pulsation=3e3), "rotor"),
    (hm.ProbeRunout(once=1e-6, once_phase=0.3, twice=1e-7), "rotor"),
    (hm.ProbeGain(error=0.1, curvature=10.0), "probe"),
    (hm.ProbeCrossTalk(share=0.05), "probe"),
    (hm.BearingClearance(gap=1e-5, film_damping=0.3), "bearing"),
    (hm.DampedClearance(gap=1e-5, film_damping=0.3), "bearing"),
    (hm.HertzianClearance(gap=1e-5, reference_force=100.0), "bearing"),
    (hm.BearingCubicStiffness(stiffness=1e14, by_axis=True), "bearing"),
    (hm.BearingHardening(rate=1e4), "bearing"),
    (hm.BearingCrossCoupling(stiffness=1e5, exponent=1.0), "bearing"),
    (hm.FadingCrossCoupling(stiffness=1e5, asymmetry=-0.2, fading=1e8), "bearing"),
    (hm.BearingAnisotropy(asymmetry=0.1, angle=0.3), "bearing"),
    (hm.BearingStiffnessChange(change=0.1), "bearing"),
    (hm.BearingDampingChange(change=0.1), "bearing"),
    (hm.Looseness(share=0.3, lift_off=-1e-6, play=1e-5), "bearing"),
    (hm.LooseBolt(share=0.3, play=3e-6), "bearing"),
    (hm.LooseFit(share=0.3, half_play=1e-6), "bearing"),
    (hm.SupportStiffnessChange(change=0.1), "bearing"),
    (hm.SupportDampingChange(change=0.1, direction="y"), "bearing"),
    (hm.SupportMassChange(change=0.1), "bearing"),
    (hm.SupportStiffnessDrift(change=0.1, time_constant=2.0), "bearing"),
    (hm.SupportStiffnessStep(change=0.1, middle_time=2.0, length=0.5), "bearing"),
    (hm.SupportFriction(coulomb=3.0), "bearing"),
    (hm.SupportPresliding(coulomb=3.0, presliding=1e-6), "bearing"),
    (hm.SupportSquareDamping(coefficient=1e4, by_axis=True), "bearing"),
    (hm.HiddenModeSupport(mass=0.1, natural_frequency=300.0), "bearing"),
    (hm.BreathingCrack(compliance=1e-7, position=0.5), "shaft.element_2"),
    (hm.MomentCrack(compliance=1e-7, position=0.5, closing_moment=10.0), "shaft.element_2"),
    (hm.SteepCrack(compliance=1e-7, position=0.5, steepness=2.0, cross_share=0.2), "shaft.element_2"),
    (hm.ArcCrack(compliance=1e-7, position=0.5, steepness=2.0, opens_at=0.4), "shaft.element_2"),
    (hm.PhasedCrack(compliance=1e-7, position=0.5, phase=0.3), "shaft.element_2"),
    (hm.Keyway(compliance=1e-7, position=0.5, angle=0.3), "shaft.element_2"),
    (hm.InternalDamping(time=1e-6), "shaft.element_1"),
    (hm.RelaxingDamping(time=1e-6, relaxation_time=1e-3), "shaft.element_1"),
    (hm.ShaftStiffnessAsymmetry(asymmetry=0.01, angle=0.3), "shaft.element_1"),
    (hm.Rub(gap=1e-4, stiffness=1e6, friction=0.1, radius=0.05), "rotor"),
    (hm.DampedRub(gap=1e-4, stiffness=1e6, damping=100.0, friction=0.1, radius=0.05), "rotor"),
    (hm.HertzianRub(gap=1e-4, stiffness=1e6, loss=0.5, friction=0.1, radius=0.05), "rotor"),
    (hm.CoatedRub(gap=1e-4, stiffness=1e6, damping=100.0, coat_depth=5e-5, friction=0.1, radius=0.05), "rotor"),
)


LINEAR = hm.LinearBearing.isotropic(radial=1e7, damping=100.0, axial=1e6, tilt=2e3)
COUPLED = np.diag([2e6, 1e6, 0.0, 10.0, 20.0, 0.0]) + np.fliplr(np.diag([0.0, 30.0, 0.0, 0.0, 40.0, 0.0]))
"""y and theta act on each other, besides the diagonal [N/m, N/rad, N m/rad]."""
BEARINGS: tuple[hm.BearingLaw, ...] = (
    LINEAR,
    hm.LinearBearing.from_matrices(stiffness=COUPLED, damping=1e-4 * COUPLED),
    hm.PowerBearing.isotropic(power_radial=1e14, radial=1e7, damping=10.0, exponent=5.0),
    hm.BallBearing(balls=9.0, contact_stiffness=7e9, ball_diameter=8e-3, pitch_diameter=0.04, radial_clearance=5e-6, axial_stiffness=1e6),
    hm.JournalBearing(diameter=0.05, length=0.02, radial_clearance=5e-5, viscosity=0.03, wall_stiffness=1e9),
    hm.TableBearing(speeds=(0.0, 100.0), stiffness_xx=(1e6, 2e6), stiffness_yy=(1e6, 3e6), damping_xx=(10.0, 20.0), damping_yy=(5.0, 5.0)),
    hm.WithFriction(law=LINEAR, bore=0.03, friction=0.1, turning_friction=0.002),
)


def rotor_scene(law: hm.BearingLaw) -> hm.Scene:
    """A bearing in a housing, an unbalanced rotor, shafts of both kinds, a drive and weight."""
    housing = hm.Housing.isotropic(mass=2.0, stiffness=5e6, damping=100.0, power_stiffness=1e13, power=5.0)
    steel = {"youngs_modulus": 2.1e11, "shear_modulus": 8.1e10}
    ring = {"mass": 0.3, "polar_inertia": 3e-4, "transverse_inertia": 2e-4}
    parts = {
        "drive": hm.DriveTorque(characteristic=kloss_motor()),
        "bearing": hm.Bearing(law=law, housing=housing, **ring),
        "shaft": hm.ShaftSection(
            length=0.2, diameter=0.03, bore=0.01, density=7800.0, elements=3.0, shear=True, rotary_inertia=False, **steel
        ),
        "rotor": hm.Rotor(mass=5.0, polar_inertia=0.03, transverse_inertia=0.02, eccentricity=1e-5, angle=0.3, tilt=1e-4, tilt_angle=1.0),
        "piece": hm.RigidSection(length=0.05),
        "end": hm.Bearing(law=LINEAR),
        "gravity": hm.Gravity(y=-9.81),
        "probe": hm.Sensor(quantity="rotor.x"),
        "turned": hm.Probe(at="rotor", angle=0.75),
    }
    return hm.Scene(name="rotor line", parts=parts, connections=[("drive", "bearing", "shaft", "rotor", "piece", "end")])


def supported_scene() -> hm.Scene:
    """Two shafts on a coupling, each over a bearing that is no station."""
    half = hm.ShaftSection(length=0.1, diameter=0.03, youngs_modulus=2.1e11, shear_modulus=8.1e10)
    held = hm.Bearing(
        law=LINEAR, mass=0.3, polar_inertia=3e-4, transverse_inertia=2e-4, housing=hm.Housing.isotropic(mass=2.0, stiffness=5e6)
    )
    disc = hm.Rotor(mass=5.0, polar_inertia=0.03, transverse_inertia=0.02)
    coupling = FlexibleCoupling(torsional_stiffness=1e3, radial_stiffness=1e5, axial_stiffness=1e4, tilt_stiffness=10.0)
    parts = {
        "first": disc,
        "improved": ImprovedSection(left=half, bearing=held, right=half, highest_speed=500.0),
        "second": disc,
        "coupling": coupling,
        "third": disc,
        "simplified": SimplifiedSection(left=half, bearing=held, right=half),
        "fourth": disc,
    }
    return hm.Scene(name="supported", parts=parts, connections=[tuple(parts)])


def holding(law: Described) -> hm.Scene:
    """A train with the law where it belongs."""
    if isinstance(law, StiffnessLaw):
        return train(stiffness=law)
    if isinstance(law, LoadLaw):
        return train(load=law)
    assert isinstance(law, MotorCharacteristic)
    return train(motor=law)


@functools.cache
def example_scenes() -> dict[str, hm.Scene]:
    found = {type(law).__name__: holding(law) for law in LAWS}
    read = hm.Scene(name="read", parts={**train().parts, "encoder": Sensor(quantity="load.angle")}, connections=train().connections)
    found |= {type(effect).__name__: read.with_effect(effect, at=at, name="the_effect") for effect, at in EFFECTS}
    found |= {type(effect).__name__: rotor_scene(LINEAR).with_effect(effect, at=at, name="the_effect") for effect, at in ROTOR_EFFECTS}
    found |= {f"gear {k}": train().replacing(gear=drive.replacing(damping=2.0)) for k, drive in enumerate(gears())}
    controlled = dict(train(motor=CommandedMotor(torque_limit=5.0, current_lag=1e-3)).parts)
    controlled["control"] = SpeedController(
        motor="motor", feedback="load", proportional_gain=1.0, integral_gain=2.0, reference=ConstantSpeed(value=1.0)
    )
    controlled["encoder"] = Sensor(quantity="load.angle", gain=1e3, offset=0.5, resolution=1.0, unit="1")
    chain = ("motor", "input_shaft", "gear", "output_shaft", "load")
    found["supported"] = supported_scene()
    found |= {f"{type(law).__name__} {k}": rotor_scene(law) for k, law in enumerate(BEARINGS)}
    hammer, line = hm.LateralForce(times=(0.0, 1e-3, 2e-3), forces_y=(0.0, 9.0, 0.0), held=True), rotor_scene(LINEAR)
    drive = hm.DriveTorque(characteristic=IdealSpeedMotor(motion=hm.AngleTable(times=(0.0, 1.0, 2.0), angles=(0.0, 5.0, 15.0))))
    pushed = {**line.parts, "hammer": hammer, "drive": drive}
    found["pushed"] = hm.Scene(name="pushed", parts=pushed, connections=[*line.connections, ("hammer", "rotor")])
    found["controlled"] = hm.Scene(name="controlled", parts=controlled, connections=[chain], notes="a 'quoted' \"note\"\nof two lines, °µ")
    rigid = {"disc": hm.Inertia(inertia=0.1, viscous=0.2), "joint": RigidCoupling(inertia=0.01), "end": hm.Inertia(inertia=1.0)}
    found["rigid"] = hm.Scene(name="rigid", parts=rigid, connections=[("disc", "joint", "end")])
    return found


SHAPES = {
    "JumpStiffness": "what the two jump laws share",
    "SpeedLoop": "what servo motor and controller share",
    "DesignTask": "a question about teeth, not a part of a scene",
    "WheelError": "an argument of tooth_errors, which makes effects of it",
}
"""Described classes of the package that no scene can hold, and why."""


def described(item: Any) -> Iterator[Described]:
    """The object and all described objects in it."""
    if isinstance(item, Described):
        yield item
        for _, value, _ in item.fields():
            yield from described(value)
    elif isinstance(item, tuple):
        for entry in item:
            yield from described(entry)


def can_be_in_a_file(kind: type[Described]) -> bool:
    import inspect

    functions = any(str(kind.__dataclass_fields__[name].type).startswith("Callable[") for name in kind.__dataclass_fields__)
    return not (inspect.isabstract(kind) or "_kind" in vars(kind) or functions)


def test_there_is_an_example_of_every_class_that_a_scene_file_can_hold() -> None:
    placeable = ("bearings", "components", "effects", "flexsplines", "loads", "motors", "teeth")
    wanted = {
        name
        for name, kind in all_types().items()
        if kind.__module__.startswith("hdrive_mbs.") and kind.__module__.split(".")[1] in placeable and can_be_in_a_file(kind)
    }
    shown = {
        type(item).__name__
        for scene in example_scenes().values()
        for top in (*scene.parts.values(), *(placed.effect for placed in scene.effects))
        for item in described(top)
    }
    missing = wanted - shown - set(SHAPES)
    assert not missing, f"add an example of {sorted(missing)}"
    assert len(shown) > 30
    assert set(SHAPES) <= wanted, "an exception that is none any more"


@pytest.mark.parametrize("suffix", [".toml", ".json"])
@pytest.mark.parametrize("name", list(example_scenes()))
def test_every_class_comes_back_equal_from_a_file(name: str, suffix: str, tmp_path: Path) -> None:
    scene = example_scenes()[name]
    path = hm.save_scene(scene, tmp_path / f"scene{suffix}")
    again = hm.load_scene(path)
    assert again == scene
    assert again.notes == scene.notes
    assert scene_to_dict(again) == scene_to_dict(scene)


def test_a_fresh_interpreter_reads_every_class_without_being_told_where_it_is(tmp_path: Path) -> None:
    for k, scene in enumerate(example_scenes().values()):
        hm.save_scene(scene, tmp_path / f"{k}.json")
    code = (
        "import pathlib, sys, hdrive_mbs\n"
        "files = sorted(pathlib.Path(sys.argv[1]).glob('*.json'))\n"
        "print(sum(len(hdrive_mbs.load_scene(file).parts) for file in files))"
    )
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert int(done.stdout) == sum(len(scene.parts) for scene in example_scenes().values())


def test_a_class_of_a_user_s_own_is_written_and_read(tmp_path: Path) -> None:
    @dataclass(frozen=True, kw_only=True)
    class SealDragOfThisTest(hm.TorqueEffect):
        scale: float = hm.parameter("N m", "drag at 1 rad/s", low=0.0)

        def torque(self, time: Value, angle: Value, speed: Value) -> Value:
            return -self.scale * np.sign(speed) * np.abs(speed) ** 0.4

    scene = train().with_effect(SealDragOfThisTest(scale=0.5), at="load")
    assert hm.load_scene(hm.save_scene(scene, tmp_path / "s.toml"), types=[SealDragOfThisTest]) == scene


# -- units ------------------------------------------------------------------------------------------


def document() -> dict[str, Any]:
    return copy.deepcopy(scene_to_dict(train().with_effect(hm.CoulombStribeckFriction(coulomb=1.0), at="load", name="drag")))


def with_entry(*path: Any) -> dict[str, Any]:
    """The example document with the entry at path[:-1] set to path[-1]."""
    *steps, last, value = path
    changed = document()
    inner = changed
    for step in steps:
        inner = inner[step]
    inner[last] = value
    return changed


@pytest.mark.parametrize(
    ("path", "text", "expected"),
    [
        (("motor", "characteristic", "rated_speed"), "1410 rpm", 1410.0 * math.pi / 30.0),
        (("motor", "characteristic", "rated_power"), "0.55 kW", 550.0),
        (("motor", "characteristic", "line_frequency"), "0.05 kHz", 50.0),
        (("motor", "inertia"), "1.5e4 g*cm^2", 1.5e4 * 1e-3 * 1e-4),
        (("motor", "inertia"), "1500 kg mm²", 1.5e-3),
        (("gear", "stiffness", "lost_motion"), "9 arcmin", math.radians(9.0 / 60.0)),
        (("gear", "stiffness", "lost_motion"), "0.15 deg", math.radians(0.15)),
        (("gear", "stiffness", "stiffness_1"), "5e5 N*mm/deg", 5e5 * 1e-3 * 180.0 / math.pi),
        (("gear", "stiffness", "torque_1"), "23.5 N·m", 23.5),
        (("gear", "damping"), "2e4 mN m s/rad", 20.0),
        (("load", "torque", "phase"), "-90 deg", -math.pi / 2.0),
    ],
)
def test_units_are_converted_at_the_door(path: tuple[str, ...], text: str, expected: float) -> None:
    found: Any = scene_from_dict(with_entry("parts", *path, text)).parts[path[0]]
    for name in path[1:]:
        found = getattr(found, name)
    assert found == pytest.approx(expected, rel=1e-14)


def test_a_table_has_one_unit_for_all_its_values() -> None:
    law = {
        "type": "TableStiffness",
        "twists": {"unit": "arcmin", "values": [-5, 0.0, 10.0]},
        "torques": {"unit": "mN m", "values": [-2000, 0.0, 5e3]},
    }
    found = scene_from_dict(with_entry("parts", "gear", "stiffness", law)).parts["gear"].stiffness  # type: ignore[attr-defined]
    np.testing.assert_allclose(found.twists, np.radians(np.array([-5.0, 0.0, 10.0]) / 60.0), rtol=1e-14)
    np.testing.assert_allclose(found.torques, [-2.0, 0.0, 5.0], rtol=1e-14)


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("motor", "inertia"), "2 kg", r"parts\.motor\.inertia: unit 'kg' does not fit; it must be convertible to kg m\^2"),
        (("motor", "inertia"), "2", r"parts\.motor\.inertia = '2' has no unit; .* like '2 kg m\^2'"),
        (("motor", "inertia"), 2e-3, r"parts\.motor\.inertia = 0\.002 has no unit; write it as text, like '0\.002 kg m\^2'"),
        (("motor", "inertia"), "2 kgm2", r"unit 'kgm2' is not known"),
        (("motor", "inertia"), "two kg m^2", r"write a number and a unit, like '1\.5 kg m\^2'"),
        (("motor", "inertia"), "2,5 kg m^2", r"unit ',5 kg m\^2' cannot be read"),
        (("motor", "inertia"), "nan kg m^2", r"write a number and a unit"),
        (("motor", "inertia"), "", r"write a number and a unit"),
        (("gear", "stiffness", "stiffness_1"), "5 N/rad", r"does not fit; it must be convertible to N m/rad"),
        # the two traps of 2 pi, which pint alone converts as 1 Hz = 1 rad/s
        (("motor", "characteristic", "rated_speed"), "23.5 Hz", r"differ by 2 pi .*write it in rad/s"),
        (("motor", "characteristic", "line_frequency"), "3000 rpm", r"differ by 2 pi .*write it in Hz"),
        # a level is not a factor: 3 dB is not 3 times 1 dB
        (("gear", "ratio"), "40 dB", r"unit 'dB' is not proportional to 1"),
        (("gear", "ratio"), "9 9**9**9**9**9", r"cannot be read"),
        (("gear", "ratio"), "9 " + "a" * 300, r"cannot be read"),
        (("gear", "ratio"), "9 __import__('os')", r"cannot be read"),
    ],
)
def test_a_wrong_or_missing_unit_is_refused_with_the_entry_and_the_right_unit(path: tuple[str, ...], value: Any, message: str) -> None:
    with pytest.raises(UnitError, match=message):
        scene_from_dict(with_entry("parts", *path, value))


def test_units_are_what_a_pocket_calculator_says() -> None:
    assert to_si("1 turn", "rad", "x") == pytest.approx(2.0 * math.pi, rel=1e-15)
    assert to_si("5 %", "1", "x") == pytest.approx(0.05, rel=1e-15)
    assert to_si("1 kgf m", "N m", "x") == pytest.approx(9.80665, rel=1e-15)
    assert to_si("0.3 mm", "m", "x") == pytest.approx(3e-4, rel=1e-15)
    assert to_si("-7", "1", "x") == -7.0
    assert to_si("7 N m s^2/rad^2", "N m s^2/rad^2", "x") == 7.0


# -- what is refused ----------------------------------------------------------------------------------

BAD: dict[str, tuple[dict[str, Any], type[HdriveError], str]] = {
    "no format": (with_entry("format", None), FileFormatError, r"not a scene: 'format' must be 'hdrive-mbs scene 1', found None"),
    "newer format": (with_entry("format", "hdrive-mbs scene 2"), FileFormatError, r"found 'hdrive-mbs scene 2'"),
    "unknown entry": (with_entry("effect", {}), FileFormatError, r"unknown entry 'effect'; a scene has connections, effects, format"),
    "unknown field": (
        with_entry("parts", "motor", "mass", "1 kg"),
        FileFormatError,
        r"parts\.motor\.mass: unknown entry\. Motor has: inertia",
    ),
    "unknown part": (
        with_entry("parts", "motor", "type", "Moter"),
        PlaceError,
        r"No type 'Moter'\. parts\.motor: .*HarmonicDrive, .*Motor",
    ),
    "a law as a part": (with_entry("parts", "motor", "type", "SineTorque"), PlaceError, r"No type 'SineTorque'\. parts\.motor"),
    "a base class": (with_entry("parts", "motor", "type", "Component"), PlaceError, r"No type 'Component'"),
    "an abstract effect": (with_entry("effects", "drag", "type", "TorqueEffect"), PlaceError, r"No type 'TorqueEffect'"),
    "a part as an effect": (with_entry("effects", "drag", "type", "Inertia"), PlaceError, r"No type 'Inertia'\. effects\.drag"),
    "a load as a stiffness": (
        with_entry("parts", "gear", "stiffness", {"type": "ConstantTorque", "value": "1 N m"}),
        PlaceError,
        r"No type 'ConstantTorque'\. parts\.gear\.stiffness: .*PiecewiseLinearStiffness",
    ),
    "a law of functions": (with_entry("parts", "load", "torque", {"type": "LoadFunction"}), PlaceError, r"No type 'LoadFunction'"),
    "a base that is not abstract": (
        with_entry("parts", "gear", "stiffness", {"type": "JumpStiffness", "lost_motion": "1 mrad"}),
        FileFormatError,
        r"parts\.gear\.stiffness: no JumpStiffness can be made of these values",
    ),
    "no type": (with_entry("parts", "motor", {"inertia": "1 kg m^2"}), PlaceError, r"No type 'None'\. parts\.motor"),
    "type is a list": (with_entry("parts", "motor", "type", ["Motor"]), PlaceError, r"No type"),
    "missing field": (with_entry("parts", "motor", {"type": "Inertia"}), FileFormatError, r"parts\.motor: inertia of Inertia missing"),
    "no parts": ({"format": FORMAT, "name": "x", "connections": []}, FileFormatError, r"'parts' is missing"),
    "empty parts": (with_entry("parts", {}), SceneError, r"has no parts"),
    "parts is a list": (with_entry("parts", []), FileFormatError, r"parts: must be a table, found list"),
    "a part is a number": (
        with_entry("parts", "motor", 5),
        FileFormatError,
        r"parts\.motor = 5: must be a table with a type, one of: .*HarmonicDrive",
    ),
    "a law is a number": (
        with_entry("parts", "gear", "stiffness", 3.2e4),
        FileFormatError,
        r"parts\.gear\.stiffness = 32000\.0: must be a table",
    ),
    "a law is code": (
        with_entry("parts", "load", "torque", "lambda t: 5.0"),
        FileFormatError,
        r"parts\.load\.torque = 'lambda t: 5\.0': must be a table with a type, one of: ConstantTorque",
    ),
    "a law is a list": (
        with_entry("parts", "gear", "stiffness", [1]),
        FileFormatError,
        r"parts\.gear\.stiffness\[0\] = 1: must be a table",
    ),
    "teeth are a number": (with_entry("parts", "gear", "teeth", 5), FileFormatError, r"parts\.gear\.teeth = 5: .*HarmonicGear"),
    "a switch is a text": (
        with_entry("parts", "gear", "damping_in_gap", "no"),
        ParameterError,
        r"parts\.gear: .*'no': must be True or False",
    ),
    "a switch is a number": (with_entry("parts", "gear", "damping_in_gap", 1), ParameterError, r"= 1: must be True or False"),
    "a word is a number": (with_entry("parts", "gear", "output_sense", 1), ParameterError, r"output_sense = 1: must be a text"),
    "a number is a list": (with_entry("parts", "motor", "inertia", [1]), FileFormatError, r"inertia = \[1\]: must be a number with a unit"),
    "a number is a switch": (with_entry("parts", "gear", "ratio", True), FileFormatError, r"ratio = True: must be a number"),
    "a number is null": (with_entry("parts", "gear", "ratio", None), FileFormatError, r"ratio = None: must be a number"),
    "infinite": (
        with_entry("parts", "gear", "ratio", math.inf),
        ParameterError,
        r"parts\.gear: HarmonicDrive\.ratio = inf: must be a finite",
    ),
    "not a number": (with_entry("parts", "gear", "ratio", math.nan), ParameterError, r"ratio = nan: must be a finite number"),
    "too large for a float": (with_entry("parts", "gear", "ratio", 10**400), ParameterError, r"over 300 digits"),
    "infinite with a unit": (
        with_entry("parts", "motor", "inertia", "1e400 kg m^2"),
        ParameterError,
        r"inertia = inf kg m\^2: must be a finite",
    ),
    "out of range": (
        with_entry("parts", "input_shaft", "stiffness", "-5 N m/rad"),
        ParameterError,
        r"parts\.input_shaft: Shaft\.stiffness = -5",
    ),
    "unknown place": (
        with_entry("connections", [["motor", "input_shaft", "gaer", "output_shaft", "load"]]),
        PlaceError,
        r"No place 'gaer'",
    ),
    "loose end": (with_entry("connections", [["motor", "input_shaft", "gear", "output_shaft"]]), SceneError, r"Loose end"),
    "flat connections": (with_entry("connections", ["motor", "load"]), FileFormatError, r"connections: must be a list of lists of places"),
    "effect without a place": (
        with_entry("effects", "drag", {"type": "ViscousDrag", "coefficient": "1 N m s/rad"}),
        FileFormatError,
        r"effects\.drag: 'at' must name a place",
    ),
    "effect at no place": (with_entry("effects", "drag", "at", "lod"), PlaceError, r"No body 'lod'"),
    "effect name taken": (with_entry("effects", {"motor": document()["effects"]["drag"]}), SceneError, r"The name 'motor' is taken"),
    "name is a number": (with_entry("name", 5), FileFormatError, r"name and notes: must be texts"),
}


@pytest.mark.parametrize("way", BAD)
def test_a_bad_entry_is_refused_by_its_path_with_the_way_out(way: str, tmp_path: Path) -> None:
    content, kind, message = BAD[way]
    with pytest.raises(kind, match=message):
        scene_from_dict(content)
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(content))
    with pytest.raises(kind, match=rf"scene\.json: .*{message}"):
        hm.load_scene(path)


def test_a_bad_value_in_a_table_is_named_by_its_index() -> None:
    law = {"type": "TableTorque", "times": {"unit": "s", "values": [0, 1]}, "torques": {"unit": "N m", "values": [0, "1"]}}
    with pytest.raises(FileFormatError, match=r"parts\.load\.torque\.torques\.values\[1\] = '1': must be a number"):
        scene_from_dict(with_entry("parts", "load", "torque", law))
    law["torques"] = {"unit": "N m", "values": [0.0, math.nan]}
    with pytest.raises(ParameterError, match=r"parts\.load\.torque: TableTorque\.torques\[1\] = nan N m"):
        scene_from_dict(with_entry("parts", "load", "torque", law))
    law["torques"] = {"unit": "kg", "values": [0.0, 1.0]}
    with pytest.raises(UnitError, match=r"parts\.load\.torque\.torques: unit 'kg' does not fit"):
        scene_from_dict(with_entry("parts", "load", "torque", law))
    law["torques"] = [0.0, 1.0]  # type: ignore[assignment]
    with pytest.raises(FileFormatError, match=r"must be a table \{ unit = 'N m', values = \[\.\.\.\] \}"):
        scene_from_dict(with_entry("parts", "load", "torque", law))


def test_code_in_a_file_is_never_run(tmp_path: Path) -> None:
    trap = tmp_path / "trap"
    code = f"__import__('pathlib').Path({str(trap)!r}).touch()"
    spots: tuple[tuple[Any, ...], ...] = (
        ("name",), ("notes",), ("connections",), ("parts",), ("parts", "motor"), ("parts", "motor", "type"), ("parts", "motor", "inertia"),
        ("parts", "gear", "stiffness"), ("parts", "gear", "stiffness", "type"), ("parts", "gear", "stiffness", "lost_motion"),
        ("parts", "gear", "output_sense"), ("parts", "gear", "damping_in_gap"), ("parts", "load", "torque"), ("effects", "drag", "at"),
    )  # fmt: skip
    for spot in spots:
        for text in (code, f"1 {code}", f"!!python/object/apply:os.system ['touch {trap}']"):
            path = tmp_path / "scene.json"
            path.write_text(json.dumps(with_entry(*spot, text)))
            if spot in (("name",), ("notes",)):
                hm.load_scene(path)
            else:
                with pytest.raises(HdriveError):
                    hm.load_scene(path)
    assert not trap.exists()


@pytest.mark.parametrize(
    ("suffix", "content", "message"),
    [
        (".toml", b"", r"not a scene: 'format' must be"),
        (".json", b"", r"cannot be parsed"),
        (".toml", b"\x00\xff\xfe garbage", r"not a text file in UTF-8"),
        (".json", bytes(range(256)), r"not a text file in UTF-8"),
        (".toml", b"name = [1, 2", r"cannot be parsed"),
        (".json", b"[]", r"not a scene: .* found 'list'"),
        (".json", b"null", r"not a scene: .* found 'NoneType'"),
        (".json", b"[" * 100_000, r"cannot be parsed"),
        (".json", b'{"a":' * 100_000, r"cannot be parsed"),
        (".toml", b"a = " + b"[" * 10_000, r"cannot be parsed"),
        (".json", b'{"format": ' + b"9" * 5000 + b"}", r"cannot be parsed"),
        (".toml", b"[parts]\n[parts]\n", r"cannot be parsed"),
    ],
)  # fmt: skip
def test_a_file_that_is_no_scene_is_refused(suffix: str, content: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / f"scene{suffix}"
    path.write_bytes(content)
    with pytest.raises(FileFormatError, match=rf"scene\{suffix}.*{message}"):
        hm.load_scene(path)


@pytest.mark.parametrize("suffix", [".toml", ".json"])
def test_a_file_cut_off_anywhere_is_refused(suffix: str, tmp_path: Path) -> None:
    whole = hm.save_scene(train(), tmp_path / f"whole{suffix}").read_bytes()
    path = tmp_path / f"cut{suffix}"
    for cut in range(0, len(whole) - 2, 37):
        path.write_bytes(whole[:cut])
        with pytest.raises(HdriveError, match="cut"):
            hm.load_scene(path)


def test_values_nested_in_many_tables_are_refused(tmp_path: Path) -> None:
    inner: Any = "5"
    for _ in range(150):
        inner = {"type": "HarmonicDrive", "ratio": 50.0, "stiffness": inner}
    for value in (inner, json.loads("[" * 400 + "]" * 400)):
        path = tmp_path / "deep.json"
        path.write_text(json.dumps(with_entry("parts", "gear", "stiffness", value)))
        with pytest.raises(HdriveError):
            hm.load_scene(path)


def test_a_file_that_is_not_there_or_is_a_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"nothing\.toml: cannot be read \(No such file"):
        hm.load_scene(tmp_path / "nothing.toml")
    with pytest.raises(FileFormatError, match=r"cannot be read"):
        hm.load_scene(tmp_path)


def test_a_byte_order_mark_is_no_obstacle(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps(scene_to_dict(train())).encode())
    assert hm.load_scene(path) == train()


JSON = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=12)
    | st.sampled_from(["Motor", "5 N m", "gear", "ground", "nan"]),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["type", "at", "unit", "values", "inertia", "x"]), inner, max_size=3)
    ),
    max_leaves=6,
)


def spots(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in entries:
        yield (*path, key)
        yield from spots(inner, (*path, key))


@settings(max_examples=250, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(list(spots(document()))), JSON, st.sampled_from([".json", "dict"]))
def test_whatever_stands_in_an_entry_only_errors_of_the_library_come_out(
    tmp_path: Path, spot: tuple[Any, ...], value: Any, how: str
) -> None:
    changed = with_entry(*spot, value)
    try:
        if how == "dict":
            scene = scene_from_dict(changed)
        else:
            path = tmp_path / "fuzz.json"
            path.write_text(json.dumps(changed))
            scene = hm.load_scene(path)
    except HdriveError as error:
        assert str(error)  # noqa: PT017
    else:
        assert scene_from_dict(scene_to_dict(scene)) == scene


@settings(max_examples=150, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_whatever_bytes_are_changed_only_errors_of_the_library_come_out(tmp_path: Path, data: st.DataObject) -> None:
    suffix = data.draw(st.sampled_from([".toml", ".json"]))
    whole = bytearray(hm.save_scene(train(), tmp_path / f"whole{suffix}").read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path / f"changed{suffix}"
    path.write_bytes(bytes(whole))
    try:
        scene = hm.load_scene(path)
    except HdriveError as error:
        assert "changed" in str(error)  # noqa: PT017
    else:
        assert isinstance(scene, hm.Scene)


# -- writing ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"load.torque": lambda time: 5.0 + 0.0 * time}, r"load\.torque\.function is a Python function"),
        ({"motor.characteristic": lambda speed: -speed}, r"motor\.characteristic\.function is a Python function"),
        ({"gear.stiffness": np.sinh}, r"gear\.stiffness\.function is a Python ufunc"),
    ],
)
def test_a_scene_with_a_python_function_cannot_be_written_and_says_where(change: dict[str, Any], where: str, tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=rf"{where}, which a scene file cannot hold\. Write the law as a class"):
        hm.save_scene(train().replacing(change), tmp_path / "scene.toml")
    assert list(tmp_path.iterdir()) == []


def test_the_ending_of_the_name_decides_on_the_format(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"a scene file ends in \.toml or \.json"):
        hm.save_scene(train(), tmp_path / "scene.yaml")
    assert list(tmp_path.iterdir()) == []


def test_missing_folders_are_made(tmp_path: Path) -> None:
    assert hm.load_scene(hm.save_scene(train(), tmp_path / "a" / "b" / "scene.toml")) == train()


def test_a_folder_that_cannot_be_written_to_is_named_and_nothing_is_left(tmp_path: Path) -> None:
    blocker = tmp_path / "file"  # a file in place of the folder: that stops every user, root too
    blocker.write_text("in the way")
    with pytest.raises(
        FileFormatError, match=r"Cannot write .*file.scene\.toml: (File exists|Not a directory)\. Choose a folder that can be written to"
    ):
        hm.save_scene(train(), blocker / "scene.toml")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
    assert blocker.read_text() == "in the way"


def test_when_writing_fails_half_way_the_old_file_is_untouched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = hm.save_scene(train(), tmp_path / "scene.toml")
    before = path.read_bytes()

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(FileFormatError, match=r"Cannot write .*scene\.toml: No space left on device"):
        hm.save_scene(train(ratio=80.0), path)
    assert path.read_bytes() == before
    assert [item.name for item in tmp_path.iterdir()] == ["scene.toml"]


def test_a_folder_in_place_of_the_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").mkdir()
    with pytest.raises(FileFormatError, match="Cannot write"):
        hm.save_scene(train(), tmp_path / "scene.toml")
    assert [item.name for item in tmp_path.iterdir()] == ["scene.toml"]


def test_a_file_is_written_with_the_rights_of_the_user(tmp_path: Path) -> None:
    plain: Callable[[], Path] = lambda: tmp_path / "plain"  # noqa: E731
    plain().write_text("x")
    assert hm.save_scene(train(), tmp_path / "scene.toml").stat().st_mode == plain().stat().st_mode
