"""Harmonic-drive power trains and rotors on the multibody engine Exudyn.

    import hdrive_mbs as hm

    scene = hm.Scene(name=..., parts={...}, connections=[...])
    response = hm.simulate(scene, 2.0)
    hm.plot(response)

Names are imported when first used, so ``import hdrive_mbs`` itself loads next to nothing.
"""

from __future__ import annotations

import importlib
from typing import Any

__version__ = "0.1.0"

_WHERE: dict[str, tuple[str, ...]] = {
    "scene": ("Scene",),
    "scene_file": ("load_scene", "save_scene"),
    "rotor_line_builder": ("rotor_line", "ShaftMaterial"),
    "signals": ("TimeHistory",),
    "quantities": ("parameter", "table", "option", "rpm", "mm", "degrees", "arcmin"),
    "errors": (
        "HdriveError", "KeywordError", "ParameterError", "UnitError", "PlaceError", "SceneError", "LawError", "FileFormatError",
        "RecordError", "SimulationError", "AnalysisError",
    ),
    "components.component": ("Component", "Flange"),
    "components.motor": ("Motor",),
    "components.inertia": ("Inertia",),
    "components.shaft": ("Shaft",),
    "components.rigid_coupling": ("RigidCoupling",),
    "components.harmonic_drive": ("HarmonicDrive",),
    "components.tooth_errors": ("tooth_errors",),
    "components.rotor": ("Rotor",),
    "components.shaft_section": ("ShaftSection",),
    "components.rigid_section": ("RigidSection",),
    "components.simplified_section": ("SimplifiedSection",),
    "components.improved_section": ("ImprovedSection",),
    "components.flexible_coupling": ("FlexibleCoupling",),
    "components.bearing": ("Bearing",),
    "components.housing": ("Housing",),
    "components.drive_torque": ("DriveTorque",),
    "components.lateral_force": ("LateralForce",),
    "components.gravity": ("Gravity",),
    "bearings.law": ("BearingLaw", "RelativeMotion"),
    "bearings.linear": ("LinearBearing",),
    "bearings.power": ("PowerBearing",),
    "bearings.speed_table": ("TableBearing",),
    "bearings.ball": ("BallBearing",),
    "bearings.journal": ("JournalBearing",),
    "bearings.friction": ("WithFriction",),
    "teeth.deformation": ("DeformationLaw",),
    "teeth.cosine": ("CosineDeformation",),
    "teeth.rollers": ("TwoRollerDeformation", "FourForceDeformation"),
    "teeth.own_deformation": ("FunctionDeformation", "TableDeformation"),
    "teeth.wheel": ("ToothedWheel", "StraightToothWheel", "OutlinedWheel"),
    "teeth.stage": ("Stage",),
    "teeth.harmonic_gear": ("HarmonicGear",),
    "teeth.double_harmonic_gear": ("DoubleHarmonicGear",),
    "teeth.motion": ("ToothMotion", "tooth_motion"),
    "teeth.clearance": ("Clearances", "clearances"),
    "teeth.clearance_map": ("ClearanceMap", "clearance_map"),
    "teeth.zones": ("Zone", "zones"),
    "teeth.pitch_errors": ("WheelError", "eccentricity", "error_orders"),
    "teeth.design": ("DesignTask", "DesignWindow"),
    "components.load": ("Load",),
    "components.speed_controller": ("SpeedController",),
    "components.sensor": ("Sensor",),
    "flexsplines.law": ("StiffnessLaw",),
    "flexsplines.piecewise_linear": ("PiecewiseLinearStiffness",),
    "flexsplines.cubic": ("CubicStiffness",),
    "flexsplines.jump_torque": ("JumpTorqueStiffness",),
    "flexsplines.jump_secant": ("JumpSecantStiffness",),
    "flexsplines.continuous": ("ContinuousStiffness",),
    "flexsplines.table": ("TableStiffness",),
    "motors.characteristic": ("MotorCharacteristic",),
    "motors.asynchronous": ("AsynchronousMotor",),
    "motors.torque_history": ("TorqueHistory",),
    "motors.torque_speed_table": ("TorqueSpeedTable",),
    "motors.commanded": ("CommandedMotor",),
    "motors.servo": ("ServoMotor",),
    "motors.ideal_speed": ("IdealSpeedMotor",),
    "motors.inverter": ("InverterMotor",),
    "motors.profiles.profile": ("SpeedProfile",),
    "motors.profiles.constant": ("ConstantSpeed",),
    "motors.profiles.ramp": ("SpeedRamp",),
    "motors.profiles.angle_table": ("AngleTable",),
    "motors.profiles.table": ("SpeedTable",),
    "loads.law": ("LoadLaw",),
    "loads.constant": ("ConstantTorque",),
    "loads.sine": ("SineTorque",),
    "loads.ramp": ("RampTorque",),
    "loads.table": ("TableTorque",),
    "loads.torque_speed": ("TorqueSpeedLoad",),
    "loads.quadratic": ("QuadraticLoad",),
    "effects.effect": (
        "Effect", "TorqueEffect", "TwistEffect", "LawEffect", "MemoryTorqueEffect", "MemoryTwistEffect",
    ),
    "effects.bouc_wen_hysteresis": ("BoucWenHysteresis",),
    "effects.coulomb_stribeck_friction": ("CoulombStribeckFriction",),
    "effects.coupling_backlash": ("CouplingBacklash",),
    "effects.eccentric_load": ("EccentricLoad",),
    "effects.kinematic_error": ("KinematicError",),
    "effects.lugre_friction": ("LuGreFriction",),
    "effects.maxwell_slip_hysteresis": ("MaxwellSlipHysteresis",),
    "effects.mesh_friction": ("MeshFriction",),
    "effects.quadratic_drag": ("QuadraticDrag",),
    "effects.torque_ripple": ("TorqueRipple",),
    "effects.viscous_drag": ("ViscousDrag",),
    "effects.actuator_lag": ("ActuatorLag",),
    "effects.cogging": ("Cogging",),
    "effects.dahl_friction": ("DahlFriction",),
    "effects.encoder_eccentricity": ("EncoderEccentricity",),
    "effects.film_backlash": ("FilmBacklash",),
    "effects.flexible_inertia": ("FlexibleInertia",),
    "effects.harmonic_kinematic_error": ("HarmonicKinematicError",),
    "effects.hidden_mode": ("HiddenMode",),
    "effects.iwan_hysteresis": ("IwanHysteresis",),
    "effects.lost_motion": ("LostMotion",),
    "effects.motor_effect": ("MotorEffect",),
    "effects.motor_scale": ("MotorScale",),
    "effects.sensor_delay": ("SensorDelay",),
    "effects.sensor_effect": ("SensorEffect", "MemorySensorEffect"),
    "effects.sensor_gain": ("SensorGain",),
    "effects.sensor_lag": ("SensorLag",),
    "effects.sensor_offset": ("SensorOffset",),
    "effects.sensor_quantisation": ("SensorQuantisation",),
    "effects.series_compliance": ("SeriesCompliance",),
    "effects.stiffness_asymmetry": ("StiffnessAsymmetry",),
    "effects.stiffness_variation": ("StiffnessVariation",),
    "effects.supply_sag": ("SupplySag",),
    "effects.thermal_drift": ("ThermalDrift",),
    "records.record": ("Record",),
    "records.collection": ("Records",),
    "records.measurement": ("Measurement",),
    "records.finding": ("Finding",),
    "records.splitting": ("Split",),
    "records.reading": ("read_record", "read_records", "read_columns"),
    "records.repair": ("repaired",),
    "records.alignment": ("ClockMatch", "clock_match", "aligned"),
    "engine.solvers": ("Solver", "DormandPrince", "RungeKutta4", "Trapezoidal", "GeneralizedAlpha"),
    "engine.assembly": ("LoweringWarning",),
    "analysis.result": ("Result", "load"),
    "analysis.time_response": ("Response", "simulate"),
    "analysis.drive_train.start_up": ("StartUp", "start_up"),
    "analysis.drive_train.torsion": ("TorsionCurve", "torsion"),
    "analysis.operating_point": ("OperatingPoint", "operating_point"),
    "analysis.drive_train.modes": ("Modes", "modes"),
    "analysis.drive_train.campbell": ("Campbell", "torsional_campbell"),
    "analysis.whirl.whirl_modes": ("WhirlModes", "whirl_modes"),
    "analysis.whirl.whirl_campbell": ("WhirlCampbell", "campbell"),
    "analysis.signals.spectrum": ("Spectrum", "spectrum"),
    "analysis.signals.order_spectrum": ("OrderSpectrum", "order_spectrum"),
    "analysis.run_up.run_up": ("RunUp", "run_up", "coast_down"),
    "analysis.signals.orbit": ("Orbit", "orbit"),
    "analysis.signals.waterfall": ("Waterfall", "waterfall"),
    "analysis.signals.spectrogram": ("Spectrogram", "spectrogram"),
    "analysis.signals.order_tracking": ("OrderTracking", "order_tracking"),
    "analysis.energy": ("EnergyBalance", "energy_balance"),
    "analysis.drive_train.reduction": ("Reduction", "reduce", "with_rigid_shafts"),
    "analysis.whirl.bearing_models": ("BearingModelWarning", "with_bearings"),
    "analysis.whirl.critical_map": ("CriticalSpeedMap", "critical_speed_map"),
    "analysis.unbalance.deflection_line": ("StaticDeflection", "static_deflection"),
    "analysis.unbalance.unbalance_response": ("UnbalanceResponse", "unbalance_response"),
    "plots": ("plot", "save_figure"),
}  # fmt: skip
_MODULE_OF = {name: module for module, exported in _WHERE.items() for name in exported}

__all__ = ["__version__", *sorted(_MODULE_OF)]


def __getattr__(name: str) -> Any:
    module = _MODULE_OF.get(name)
    if module is None:
        raise AttributeError(f"module 'hdrive_mbs' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"hdrive_mbs.{module}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
