"""Names of the drive bench: which of our causes at which place is which (effect, at) of the answer format.

Where the table of names leaves the place open, it is taken by meaning:

* what sits between wave generator and flexspline (transmission error, load-dependent loss of the teeth) is at ``mesh``:
  so says the practice case of the kinematic error
* what belongs to the torsion spring of the gear (hysteresis, its dead zone, its asymmetry, its stiffness) is at
  ``flexspline``: so says the practice case of the hysteresis
* the lost motion of the data sheet out of its tolerance is the effect ``lost_motion``, not a parameter: the table has no
  parameter of that name
* drag in proportion to speed is ``parameter_viscous`` at its body, whether our bench's own drag is off or drag is added
* an extra compliance in line with a shaft is a softer shaft; in line with the gear it bends the stiffness curve in a way
  that no change of K1 to K3 does, and has no name
* a torque of the angle at the load is ``gravity_load``; at other bodies there is no name for it
"""

from __future__ import annotations

from benchmarks.withheld.names import Label, Name, Names

BODIES = ("motor", "wave_generator", "load")
SHAFTS = ("input_shaft", "output_shaft")

GEAR: dict[Label, Name] = {
    ("mesh_friction", "gear"): ("friction_mesh_load", "mesh"),
    ("kinematic_error", "gear"): ("kinematic_error", "mesh"),
    ("hysteresis", "gear"): ("hysteresis_flexspline", "flexspline"),
    ("backlash", "gear"): ("lost_motion", "flexspline"),
    ("stiffness_asymmetry", "gear"): ("stiffness_asymmetry", "flexspline"),
    ("parameter", "flexspline_stiffness"): ("parameter_flexspline_stiffness", "flexspline"),
    ("parameter", "lost_motion"): ("lost_motion", "flexspline"),
}
AT_BODIES: dict[Label, Name] = {
    **{("friction", body): (f"friction_{body}", body) for body in BODIES},
    **{("quadratic_drag", body): ("quadratic_drag", body) for body in BODIES},
    ("quadratic_drag", "gear.flexspline"): ("quadratic_drag", "flexspline"),
    **{("viscous_drag", body): ("parameter_viscous", body) for body in BODIES},
    **{("parameter", f"{body}_viscous"): ("parameter_viscous", body) for body in BODIES},
    ("parameter", "motor_inertia"): ("parameter_motor_inertia", "motor"),
    ("parameter", "load_inertia"): ("parameter_load_inertia", "load"),
    ("torque_ripple", "motor"): ("torque_ripple", "motor"),
    ("actuator_lag", "motor"): ("actuator_lag", "motor"),
    ("eccentric_load", "load"): ("gravity_load", "load"),
    ("hidden_mode", "load"): ("hidden_mode_load", "load"),
}
AT_SHAFTS: dict[Label, Name] = {
    **{("backlash", shaft): ("coupling_backlash", shaft) for shaft in SHAFTS},
    **{("stiffness_asymmetry", shaft): ("stiffness_asymmetry", shaft) for shaft in SHAFTS},
    **{("parameter", f"{shaft}_stiffness"): (f"parameter_{shaft}_stiffness", shaft) for shaft in SHAFTS},
    **{("extra_compliance", shaft): (f"parameter_{shaft}_stiffness", shaft) for shaft in SHAFTS},
}
AT_SENSORS: dict[Label, Name] = {
    **{("encoder_eccentricity", sensor): ("encoder_eccentricity", sensor) for sensor in ("motor_encoder", "load_encoder")},
    ("sensor_delay", "load_encoder"): ("load_encoder_delay", "load_encoder"),
    ("sensor_gain", "torque_sensor"): ("torque_sensor_gain", "torque_sensor"),
}

NAMES = Names(
    causes={**GEAR, **AT_BODIES, **AT_SHAFTS, **AT_SENSORS},
    places={
        "gear": "flexspline",
        "gear.flexspline": "flexspline",
        "lost_motion": "flexspline",
        "flexspline_damping": "flexspline",
        **{f"{shaft}_damping": shaft for shaft in SHAFTS},
    },
)
