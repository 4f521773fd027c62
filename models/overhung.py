"""An overhung rotor: a heavy disc beyond the second bearing, where gyroscopic moments split the modes.

Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines (2010), Example 5.9.9: shaft of 1.5 m x 50 mm, disc of 350 mm
x 70 mm at its end, bearings at 0 and 1.0 m with 10 MN/m; steel with E = 211 GPa, G = 81.2 GPa, 7810 kg/m^3.  Book values
with 6 elements at 4000 rpm, among them: 76.19, 103.91, 565.99, 647.75, 1174.2 rad/s.  Damping, unbalance, axial hold and
drive are ours.

    from models.overhung import build
    response = hm.simulate(build(), 2.0, solver=hm.Trapezoidal(step=2e-4, newton_tolerance=1e-6))
"""

from __future__ import annotations

import hdrive_mbs as hm

LENGTH, DIAMETER = 1.5, 0.05
STEEL = {"youngs_modulus": 211e9, "shear_modulus": 81.2e9, "density": 7810.0}
DISC = hm.Rotor.disc(diameter=0.35, thickness=0.07, density=STEEL["density"], bore=DIAMETER)


def build(
    *,
    eccentricity: float = 50e-6,
    tilt: float = 0.0,
    bearing_stiffness: float = 1e7,
    bearing_damping: float = 3e3,
    second_bearing: float = 1.0,
    largest_element: float = 0.25,
    torque: float = 100.0,
    final_speed: float = 300.0,
) -> hm.Scene:
    """The rotor with a drive at the end away from the disc.

    eccentricity, tilt : static and dynamic unbalance of the disc [m, rad]
    bearing_stiffness, bearing_damping : of each bearing in x and y [N/m, N s/m]; the book has no damping
    second_bearing : its position [m]; nearer to the disc at 1.5 m the overhang is shorter
    largest_element : longest beam element (Timoshenko) [m]; 0.25 m are the 6 elements of the book
    torque, final_speed : largest torque of the drive [N m], and the speed that it then holds within 5 rad/s [rad/s]
    """
    radial = {"radial": bearing_stiffness, "damping": bearing_damping}
    drive = hm.TorqueSpeedTable(speeds=(0.0, final_speed - 5.0, final_speed + 5.0), torques=(torque, torque, -torque))
    return hm.rotor_line(
        "overhung rotor",
        stations={
            "first_bearing": (0.0, hm.Bearing(law=hm.LinearBearing.isotropic(**radial, axial=1e8, axial_damping=1e3))),
            "second_bearing": (second_bearing, hm.Bearing(law=hm.LinearBearing.isotropic(**radial))),
            "disc": (LENGTH, DISC.replacing(eccentricity=eccentricity, tilt=tilt)),
        },
        shaft=DIAMETER,
        material=hm.ShaftMaterial(**STEEL, shear=True),
        largest_element=largest_element,
        attached={"drive": ("first_bearing", hm.DriveTorque(characteristic=drive))},
    )
