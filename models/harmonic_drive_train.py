"""The power train of Folega, Wojnar, Burdzik, Konieczny (2014): motor, harmonic drive, machine.

P. Folega et al., "Dynamic model of a harmonic drive in a toothed gear transmission system",
Journal of Vibroengineering 16 (2014), paper 1401.  Flexspline data: HDUC 32-100, its Table 1
(Harmonic Drive AG, General Catalogue 05.2009).  The paper prints no inertias, shaft stiffnesses,
dampings or motor data; those below are ours, sized for a gear of this size (the output shaft is
the paper's: 26 mm diameter, 70 mm long, steel, G = 81 GPa -> 5.19e4 N m/rad).
"""

from __future__ import annotations

import hdrive_mbs as hm

RATIO = 100.0


def catalogue() -> hm.PiecewiseLinearStiffness:
    """HDUC 32-100, Table 1 of the paper."""
    return hm.PiecewiseLinearStiffness(
        lost_motion=hm.arcmin(9.0),
        stiffness_1=3.2e4,
        stiffness_2=6.4e4,
        stiffness_3=11.0e4,
        torque_1=23.5,
        torque_2=98.0,
    )


def motor() -> hm.AsynchronousMotor:
    """0.55 kW, 4 poles, 1410 rpm at 50 Hz, breakdown ratio 2.4."""
    return hm.AsynchronousMotor(rated_power=550.0, rated_speed=hm.rpm(1410.0), pole_pairs=2.0, line_frequency=50.0, breakdown_ratio=2.4)


def load_above_gap() -> hm.SineTorque:
    """20 + 5 sin(2 pi t) N m: stays above the torque at the edge of the gap."""
    return hm.SineTorque(mean=20.0, amplitude=5.0, frequency=1.0)


def load_in_gap() -> hm.SineTorque:
    """4 + 3 sin(2 pi t) N m: below the torque at which the jump law leaves its gap."""
    return hm.SineTorque(mean=4.0, amplitude=3.0, frequency=1.0)


def build(stiffness: hm.StiffnessLaw | None = None, load: hm.LoadLaw | None = None) -> hm.Scene:
    """The train; the catalogue law and a load of 20 + 5 sin(2 pi t) N m unless others are given."""
    return hm.Scene(
        name="harmonic drive train",
        parts={
            "motor": hm.Motor(inertia=1.5e-3, characteristic=motor()),
            "input_shaft": hm.Shaft(stiffness=1e4, damping=0.05, inertia=1e-5),
            "gear": hm.HarmonicDrive(
                ratio=RATIO,
                stiffness=stiffness or catalogue(),
                damping=20.0,
                wave_generator_inertia=1.69e-4,
                flexspline_inertia=4e-4,
            ),
            "output_shaft": hm.Shaft(stiffness=5.1913e4, damping=5.0, inertia=2.465e-5),
            "load": hm.Load(inertia=0.5, torque=load or load_above_gap()),
        },
        connections=[("motor", "input_shaft", "gear", "output_shaft", "load")],
        notes="Folega et al. 2014; HDUC 32-100; inertias, dampings and motor are assumed.",
    )
