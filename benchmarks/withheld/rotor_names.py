"""Names of the rotor bench: which of our causes at which place is which (effect, at) of the answer format.

Where the table of names leaves the place open, it is taken by meaning:

* bow, crack, internal damping and shaft stiffness belong to the one ``shaft``, whatever section or rotor they sit at in our bench
* misalignment and torque ripple come in at the ``drive_end``, and so does what brakes the spin where the drive end is, at bearing 1
  (since own rotor set 15, whose labels were open by then; a station elsewhere keeps its name)
* what holds a housing (its stiffness, its looseness, a hidden mode) is at ``support_k``; what is between ring and housing at
  ``bearing_k``; both bearings together are ``bearings``
* an eccentricity out of its tolerance is ``unbalance``: so says the practice case of the unbalance
* the material damping of the data sheet out of its tolerance is ``internal_damping``
* a probe with a wrong scale is ``probe_gain``, by either of our laws
"""

from __future__ import annotations

from benchmarks.withheld.names import Label, Name, Names

SIDES = (1, 2)
SECTIONS = ("section_1", "section_2", "section_3")
PROBES = ("probe_r1_x", "probe_r1_y", "probe_r2_x", "probe_r2_y")

AT_SHAFT: dict[Label, Name] = {
    **{(family, section): (family, "shaft") for family in ("bow", "crack", "internal_damping") for section in SECTIONS},
    **{("bow", f"rotor_{k}"): ("bow", "shaft") for k in SIDES},
    ("parameter", "shaft_stiffness"): ("parameter_shaft_stiffness", "shaft"),
    ("parameter", "shaft_damping"): ("internal_damping", "shaft"),
    **{("misalignment", place): ("misalignment", "drive_end") for place in ("bearing_1", "bearing_2", "drive")},
    ("torque_ripple", "drive"): ("torque_ripple", "drive_end"),
}
AT_ROTORS: dict[Label, Name] = {
    **{(family, f"rotor_{k}"): (family, f"rotor_{k}") for family in ("unbalance", "rub") for k in SIDES},
    **{("parameter", f"rotor_{k}_eccentricity"): ("unbalance", f"rotor_{k}") for k in SIDES},
    **{("parameter", f"rotor_{k}_mass"): ("parameter_rotor_mass", f"rotor_{k}") for k in SIDES},
}
OF_BEARINGS = ("bearing_clearance", "bearing_cubic_stiffness", "bearing_cross_coupling", "oil_whirl", "ball_pass")
AT_BEARINGS: dict[Label, Name] = {
    **{(family, f"bearing_{k}"): (family, f"bearing_{k}") for family in OF_BEARINGS for k in SIDES},
    **{
        (f"bearing_{what}", f"bearing_{k}"): (f"parameter_bearing_{what}", f"bearing_{k}")
        for what in ("stiffness", "damping")
        for k in SIDES
    },
    **{("parameter", f"bearing_{what}"): (f"parameter_bearing_{what}", "bearings") for what in ("stiffness", "damping")},
}
AT_SUPPORTS: dict[Label, Name] = {
    **{(family, f"bearing_{k}"): (family, f"support_{k}") for family in ("looseness", "hidden_mode_support") for k in SIDES},
    **{("support_stiffness", f"bearing_{k}"): ("parameter_support_stiffness", f"support_{k}") for k in SIDES},
    ("parameter", "support_stiffness"): ("parameter_support_stiffness", "support_1"),
}
OF_SUPPORTS = (
    *("support_damping", "support_mass", "support_stiffness_drift", "support_friction", "support_square_damping"),
    *("ground_vibration", "external_shock"),
)
"""Families without a name that act on a housing from outside."""
OF_SPIN = ("quadratic_drag", "viscous_drag", "unequal_drag", "friction", "friction_by_angle")
"""Families without a name that brake how the shaft turns."""
AT_PROBES: dict[Label, Name] = {
    **{("probe_runout", f"rotor_{k}"): ("probe_runout", f"probe_rotor_{k}") for k in SIDES},
    **{(family, probe): ("probe_gain", probe) for family in ("probe_gain", "sensor_gain") for probe in PROBES},
}

NAMES = Names(
    causes={**AT_SHAFT, **AT_ROTORS, **AT_BEARINGS, **AT_SUPPORTS, **AT_PROBES},
    places={
        **dict.fromkeys((*SECTIONS, "shaft_damping", "shaft_stiffness"), "shaft"),
        "drive": "drive_end",
        **{f"bearing_{k}.law": f"bearing_{k}" for k in SIDES},
        **{f"bearing_{k}.housing": f"support_{k}" for k in SIDES},
        **{f"rotor_{k}.sensors": f"probe_rotor_{k}" for k in SIDES},
        "support_damping": "support_1",
        "support_stiffness": "support_1",
        "bearing_stiffness": "bearings",
        "bearing_damping": "bearings",
    },
    both={frozenset({"bearing_1", "bearing_2"}): "bearings"},
    elsewhere={
        **{(family, f"bearing_{k}"): f"support_{k}" for family in OF_SUPPORTS for k in SIDES},
        **{(family, "bearing_1"): "drive_end" for family in OF_SPIN},
    },
)
