"""The rotor of Laval and Jeffcott: an unbalanced disc in the middle of a light shaft on two bearings.

H. H. Jeffcott, Phil. Mag. (6) 37 (1919) 304.  The numbers are ours: a steel disc of 240 mm x 30 mm on a steel shaft of
20 mm between bearings 500 mm apart.  By symmetry the disc does not tilt while it whirls, so it is the textbook rotor,

    m r'' + c r' + k r = m e w^2 exp(i w t),   1/k = L^3/(48 E I) + 1/(2 k_b)

with k_b of each bearing and the damping c on the disc, as if it ran in oil.

    from models.jeffcott import build
    response = hm.simulate(build(), 2.0, solver=hm.Trapezoidal(step=2e-4, newton_tolerance=1e-6))
"""

from __future__ import annotations

import math

import hdrive_mbs as hm

SPAN, DIAMETER = 0.5, 0.02
YOUNGS_MODULUS, SHEAR_MODULUS, DENSITY = 2.1e11, 8.1e10, 7800.0
DISC = hm.Rotor.disc(diameter=0.24, thickness=0.03, density=DENSITY, bore=DIAMETER)
RING = {"mass": 0.1, "polar_inertia": 2e-5, "transverse_inertia": 2e-5}


def stiffness(bearing_stiffness: float) -> float:
    """Of shaft and bearings at the disc [N/m]."""
    bending = YOUNGS_MODULUS * math.pi * DIAMETER**4 / 64.0
    return 1.0 / (SPAN**3 / (48.0 * bending) + 0.5 / bearing_stiffness)


def critical_speed(bearing_stiffness: float = 1e8) -> float:
    """sqrt(k/m) [rad/s]; leaves out the mass of the rings, which is right to (m_ring/m) (k/2 k_b)^2."""
    return math.sqrt(stiffness(bearing_stiffness) / DISC.mass)


def build(
    *,
    eccentricity: float = 50e-6,
    damping_ratio: float = 0.03,
    bearing_stiffness: float = 1e8,
    bearing_damping: float = 1e3,
    torque: float = 20.0,
    final_speed: float = 500.0,
) -> hm.Scene:
    """The rotor with a drive at the disc.

    eccentricity : of the disc [m]
    damping_ratio : c/(2 m w_0) of the damping on the disc, w_0 its critical speed
    bearing_stiffness, bearing_damping : of each bearing in x and y [N/m, N s/m]; soft bearings lower the critical speed
    torque, final_speed : largest torque of the drive [N m], and the speed that it then holds within 5 rad/s [rad/s]
    """
    support = hm.Bearing(law=hm.LinearBearing.isotropic(radial=bearing_stiffness, damping=bearing_damping, axial=bearing_stiffness), **RING)
    oil = 2.0 * damping_ratio * DISC.mass * critical_speed(bearing_stiffness)
    drive = hm.TorqueSpeedTable(speeds=(0.0, final_speed - 5.0, final_speed + 5.0), torques=(torque, torque, -torque))
    return hm.rotor_line(
        "Jeffcott rotor",
        stations={"left": (0.0, support), "disc": (0.5 * SPAN, DISC.replacing(eccentricity=eccentricity)), "right": (SPAN, support)},
        shaft=DIAMETER,
        material=hm.ShaftMaterial(youngs_modulus=YOUNGS_MODULUS, shear_modulus=SHEAR_MODULUS, damping=1e-6),
        attached={
            "drive": ("disc", hm.DriveTorque(characteristic=drive)),
            "oil": ("disc", hm.Bearing(law=hm.LinearBearing.isotropic(radial=0.0, damping=oil))),
        },
    )
