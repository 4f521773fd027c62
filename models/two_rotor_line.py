"""Two rotors on a shaft with two housed bearings: the example of seed M (Fig. 5), run up through its criticals.

The paper gives no numbers.  M-REF (``reference``) puts the damping into the foundation, M-REF2 into the bearings;
both are our proposals: a 22 mm steel shaft without mass; drive disc at 0, bearing A at 0.06, rotor 1 at 0.31,
bearing B at 0.56 and rotor 2 at 0.63 m.  Bearing A locates the shaft axially (1e8 N/m, 100 N s/m: ours too).

    from models.two_rotor_line import build
    response = hm.simulate(build(), 2.5)
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.expression import Value

POSITIONS = {"drive_disc": 0.0, "bearing_a": 0.06, "rotor_1": 0.31, "bearing_b": 0.56, "rotor_2": 0.63}
YOUNGS_MODULUS, SHEAR_MODULUS = 2.1e11, 8.1e10


@dataclass(frozen=True, kw_only=True)
class LimitedSpeedDrive(hm.MotorCharacteristic):
    """M = M_max clip((w_0 - w)/b, -1, 1): full torque up to the final speed, which it then holds."""

    torque_limit: float = hm.parameter("N m", "largest torque M_max", above=0.0)
    final_speed: float = hm.parameter("rad/s", "final speed w_0", above=0.0)
    band: float = hm.parameter("rad/s", "speed error b that asks for the full torque", above=0.0)

    def torque(self, time: Value, speed: Value) -> Value:
        return self.torque_limit * np.clip((self.final_speed - speed) / self.band, -1.0, 1.0)


def _section(length: float, diameter: float, damping: float) -> hm.ShaftSection:
    return hm.ShaftSection(length=length, diameter=diameter, youngs_modulus=YOUNGS_MODULUS, shear_modulus=SHEAR_MODULUS, damping=damping)


def build(
    bearing: str = "full",
    *,
    variant: str = "reference",
    diameter: float = 0.022,
    foundation_stiffness: float = 6e6,
    cubic: float = 0.0,
    torque: float = 20.0,
    final_speed: float = 1000.0,
) -> hm.Scene:
    """The line.

    bearing : "full", "merged" (bearing B with rotor 2), "simplified" (seed M section 5) or "improved" (condensed)
    variant : "reference" (M-REF) or "damped_bearings" (M-REF2)
    diameter : of the shaft [m];  foundation_stiffness : of each housing in x and y [N/m]
    cubic : cubic stiffness of the bearings [N/m^3];  torque, final_speed : of the drive
    """
    data = {
        "reference": {"radial": 1.2e8, "damping": 400.0, "foundation_damping": 800.0, "tilt_damping": 0.5, "shaft_damping": 1e-5},
        "damped_bearings": {"radial": 3e7, "damping": 2e4, "foundation_damping": 100.0, "tilt_damping": 0.5, "shaft_damping": 0.0},
    }
    if variant not in data:
        raise hm.ParameterError(f"variant = {variant!r}: must be one of {', '.join(data)}.")
    numbers = data[variant]
    housing = hm.Housing.isotropic(mass=2.5, stiffness=foundation_stiffness, damping=numbers["foundation_damping"])

    def support(*, locating: bool) -> hm.Bearing:
        linear = {
            "radial": numbers["radial"],
            "damping": numbers["damping"],
            "axial": 1e8 if locating else 0.0,
            "axial_damping": 100.0 if locating else 0.0,
            "tilt": 5e3,
            "tilt_damping": numbers["tilt_damping"],
        }
        law = hm.LinearBearing.isotropic(**linear) if cubic == 0.0 else hm.PowerBearing.isotropic(power_radial=cubic, **linear)
        return hm.Bearing(law=law, mass=0.35, polar_inertia=6e-5, transverse_inertia=5e-5, housing=housing)

    names = list(POSITIONS)
    parts: dict[str, hm.Component] = {
        "drive": hm.DriveTorque(characteristic=LimitedSpeedDrive(torque_limit=torque, final_speed=final_speed, band=5.0)),
        "drive_disc": hm.Rotor(mass=0.8, polar_inertia=4e-4, transverse_inertia=2.6e-4),
        "bearing_a": support(locating=True),
        "rotor_1": hm.Rotor(mass=8.0, polar_inertia=0.04, transverse_inertia=0.0206, eccentricity=20e-6, tilt=5e-4),
        "bearing_b": support(locating=False),
        "rotor_2": hm.Rotor(mass=3.0, polar_inertia=0.00735, transverse_inertia=0.00383),
    }
    chain = ["drive", names[0]]
    for k, (left, right) in enumerate(itertools.pairwise(names), start=1):
        parts[f"section_{k}"] = _section(POSITIONS[right] - POSITIONS[left], diameter, numbers["shaft_damping"])
        chain += [f"section_{k}", right]
    full = hm.Scene(name="two rotor line", parts=parts, connections=[tuple(chain)])
    if bearing == "full":
        return full
    return hm.with_bearings(full, bearing, ("bearing_b",) if bearing == "merged" else None, highest_speed=final_speed)
