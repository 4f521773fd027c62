"""What a user makes with the installed package: an effect that explains a record of their own, and a bearing law."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from seal_drag import SealDrag

import hdrive_mbs as hm

PLANTED = 0.9
train = hm.Scene(
    name="fan",
    parts={
        "motor": hm.Motor(inertia=2e-3, characteristic=hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=0.0, end=60.0, duration=0.8))),
        "shaft": hm.Shaft(stiffness=50.0, damping=0.02),
        "fan": hm.Load(inertia=0.02, torque=hm.ConstantTorque(value=0.0)),
    },
    connections=[("motor", "shaft", "fan")],
)
hm.save_scene(train, "fan.toml")

run = hm.simulate(train.with_effect(SealDrag(scale=PLANTED), at="fan"), 1.0, sample_step=1e-3)
times, noise = 1e-3 * np.arange(1001), np.random.default_rng(3)
torque = run.at("shaft.torque", times) + 0.01 * noise.standard_normal(1001)
speed = run.at("fan.speed", times) + 0.05 * noise.standard_normal(1001)
columns = np.column_stack([times, torque, speed])
np.savetxt("log.csv", columns, delimiter=",", header="time [s],shaft.torque [N m],fan.speed [rad/s]", comments="")


@dataclass(frozen=True, kw_only=True)
class Cushion(hm.BearingLaw):
    """A spring that hardens with the distance from the middle, F = (k + q r^2) r, and a damper."""

    stiffness: float = hm.parameter("N/m", "k", above=0.0)
    hardening: float = hm.parameter("N/m^3", "q", low=0.0)
    damping: float = hm.parameter("N s/m", "damping", low=0.0)

    def forces(self, motion):
        spring = self.stiffness + self.hardening * (motion.x**2 + motion.y**2)
        return {"x": spring * motion.x + self.damping * motion.vx, "y": spring * motion.y + self.damping * motion.vy}


def line(law):
    bearing = hm.Bearing(law=law, mass=0.4, polar_inertia=8e-5, transverse_inertia=6e-5)
    return hm.rotor_line(
        "spindle",
        stations={
            "left": (0.0, bearing),
            "disc": (0.2, hm.Rotor.disc(diameter=0.15, thickness=0.02, density=7800.0, eccentricity=20e-6)),
            "right": (0.4, bearing),
        },
        shaft=hm.mm(30),
        material=hm.ShaftMaterial(youngs_modulus=2.1e11, shear_modulus=8.1e10, damping=1e-5),
    )


# a load of the disc's weight moves the cushion by d with (k + q d^2) d = F; about there its stiffness along the load is k + 3 q d^2
law = Cushion(stiffness=2e7, hardening=1e15, damping=500.0)
load, found = 60.0, law.linearised(load=(60.0, 0.0), speed=300.0)
roots = np.roots([law.hardening, 0.0, law.stiffness, -load])
moved = float(roots[np.abs(roots.imag) < 1e-12].real[0])
assert abs(found.stiffness_xx / (law.stiffness + 3.0 * law.hardening * moved**2) - 1.0) < 1e-6, found.stiffness_xx
plain = hm.LinearBearing.isotropic(radial=2e7, damping=500.0)
speeds = [hm.campbell(line(one), np.linspace(0.0, 1500.0, 16)).critical_speeds[0] for one in (law, plain)]
assert abs(speeds[0] / speeds[1] - 1.0) < 1e-6, speeds  # about rest the hardening does not count
print(f"own bearing: first critical speed {speeds[0]:.1f} rad/s")
