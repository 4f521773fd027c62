"""The double harmonic transmission of Ianici and Ianici, and a drive with it.

Draghita Ianici, Sava Ianici, Studying the relative positions of the teeth of conjugated wheels in
the double harmonic transmission, Analele Universitatii "Eftimie Murgu" Resita (2017).  The paper gives
the structure, |i14| = 50, m = 0.3 mm and r02 = 29.3 mm; tooth numbers, w0 and radii are not in it, and
the three numbers cannot be kept together with one unshifted module.  Two sets that can:

A  |i| = 50 exactly: 202/204 with m = 0.3 mm, 202/200 with m = 0.28 mm, w0 = 0.30 mm
C  one module of 0.3 mm: 200/202 and 190/188, i = -48.205, w0 = 0.30 mm

Addendum 0.8 m, clearance 0.2 m.  Profile angle 30 degrees and the backlashes are ours, chosen with
``hdrive-mbs teeth design``: of set A stage II needs 30 um because w0 is 0.02 mm larger than its
module, so that its teeth go 0.02 mm deeper than their reference circles.
"""

from __future__ import annotations

import hdrive_mbs as hm
from hdrive_mbs.errors import ParameterError

FIBRE_RADIUS = hm.mm(29.3)
PROFILE_ANGLE = hm.degrees(30.0)

SETS = {
    # (z2, z3, module, backlash) and (z2', z4, module, backlash), lengths in mm
    "A": ((202, 204, 0.30, 0.010), (202, 200, 0.28, 0.040)),
    "C": ((200, 202, 0.30, 0.010), (190, 188, 0.30, 0.015)),
}


def gear(name: str = "A", deformation: hm.DeformationLaw | None = None) -> hm.DoubleHarmonicGear:
    """The teeth of set A or C; w0 cos 2s with w0 = 0.30 mm unless another law is given."""
    if name not in SETS:
        raise ParameterError(f"There is no set {name!r}; there are {', '.join(SETS)}.")
    law = deformation or hm.CosineDeformation(amplitude=hm.mm(0.30))
    first, second = (
        hm.Stage.standard(
            flexible_teeth=flexible,
            rigid_teeth=rigid,
            module=hm.mm(module),
            profile_angle=PROFILE_ANGLE,
            addendum=hm.mm(0.8 * module),
            clearance=hm.mm(0.2 * module),
            backlash=hm.mm(backlash),
            fibre_radius=FIBRE_RADIUS,
            deformation=law,
        )
        for flexible, rigid, module, backlash in SETS[name]
    )
    return hm.DoubleHarmonicGear(
        flexspline_outer=first.flexible,
        circular_spline=first.rigid,
        flexspline_inner=second.flexible,
        output_wheel=second.rigid,
        fibre_radius=FIBRE_RADIUS,
        deformation=law,
    )


def build(name: str = "A") -> hm.Scene:
    """A servo motor, the gear, and a machine that resists with 5 N m.  Inertias and stiffnesses are assumed."""
    teeth = gear(name)
    stiffness = hm.PiecewiseLinearStiffness(
        lost_motion=teeth.lost_motion, stiffness_1=4e3, stiffness_2=6e3, stiffness_3=8e3, torque_1=4.0, torque_2=15.0
    )
    return hm.Scene(
        name=f"double harmonic transmission, set {name}",
        parts={
            "motor": hm.Motor(
                inertia=1e-4,
                characteristic=hm.AsynchronousMotor(
                    rated_power=180.0, rated_speed=hm.rpm(1370.0), pole_pairs=2.0, line_frequency=50.0, breakdown_ratio=2.2
                ),
            ),
            "gear": hm.HarmonicDrive.from_gear(
                teeth, stiffness=stiffness, damping=2.0, wave_generator_inertia=4e-5, flexspline_inertia=1e-4
            ),
            "load": hm.Load(inertia=0.05, torque=hm.ConstantTorque(value=5.0)),
        },
        connections=[("motor", "gear", "load")],
        notes="Teeth: Ianici and Ianici 2017, missing numbers proposed; everything else is assumed.",
    )
