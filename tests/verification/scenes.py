"""The scenes that the verification tests compare with the reference train, built by hand.

The numbers are written again here, not taken from ``models/``, so that a slip there shows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import hdrive_mbs as hm

LOST_MOTION = math.radians(9.0 / 60.0)
"""9 minutes of arc, Table 1 of seed F [rad]."""

SENSE = {"motor": 1.0, "gear.wave_generator": 1.0, "gear.flexspline": -1.0, "load": -1.0}
"""Seed F, Fig. 2: the flexspline, and all behind it, turns against the wave generator."""


def catalogue() -> hm.PiecewiseLinearStiffness:
    """HDUC 32-100, Table 1."""
    return hm.PiecewiseLinearStiffness(
        lost_motion=LOST_MOTION, stiffness_1=3.2e4, stiffness_2=6.4e4, stiffness_3=11e4, torque_1=23.5, torque_2=98.0
    )


def kloss_motor() -> hm.AsynchronousMotor:
    """0.55 kW, 4 poles, 1410 rpm, breakdown ratio 2.4."""
    return hm.AsynchronousMotor(rated_power=550.0, rated_speed=1410.0 * math.pi / 30.0, pole_pairs=2.0, breakdown_ratio=2.4)


def train(*, stiffness: object = None, motor: object = None, load: object = None, damping_in_gap: bool = True, **gear: float) -> hm.Scene:
    """Motor, input shaft, harmonic drive, output shaft, machine."""
    gear = {"ratio": 100.0, "damping": 20.0, "wave_generator_inertia": 1.69e-4, "flexspline_inertia": 4e-4} | gear
    return hm.Scene(
        name="train under verification",
        parts={
            "motor": hm.Motor(inertia=1.5e-3, characteristic=motor if motor is not None else kloss_motor()),
            "input_shaft": hm.Shaft(stiffness=1e4, damping=0.05, inertia=1e-5),
            "gear": hm.HarmonicDrive(stiffness=stiffness if stiffness is not None else catalogue(), damping_in_gap=damping_in_gap, **gear),
            "output_shaft": hm.Shaft(stiffness=5.1913e4, damping=5.0, inertia=2.465e-5),
            "load": hm.Load(inertia=0.5, torque=load if load is not None else hm.SineTorque(mean=20.0, amplitude=5.0, frequency=1.0)),
        },
        connections=[("motor", "input_shaft", "gear", "output_shaft", "load")],
    )


def chain(inertias: Sequence[float], stiffnesses: Sequence[float], dampings: Sequence[float] | None = None) -> hm.Scene:
    """A free chain of discs and massless shafts."""
    dampings = [0.0] * len(stiffnesses) if dampings is None else dampings
    parts: dict[str, hm.Component] = {"disc_1": hm.Inertia(inertia=inertias[0])}
    for k, (inertia, stiffness, damping) in enumerate(zip(inertias[1:], stiffnesses, dampings, strict=True), start=1):
        parts[f"shaft_{k}"] = hm.Shaft(stiffness=stiffness, damping=damping)
        parts[f"disc_{k + 1}"] = hm.Inertia(inertia=inertia)
    return hm.Scene(name="chain", parts=parts, connections=[tuple(parts)])
