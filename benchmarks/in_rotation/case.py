"""A fan that runs up slowly through its critical speed, logged from within the passage, and its bench."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.trial import Trial

NOISE = 2e-7
"""Of the probes [m]."""
LINES = 1024
"""Of the encoder."""
STEP, FOLD = 5e-5, 10
"""Step of the engine [s], and steps between two samples of the log."""
FIRST, LAST = 2.0, 4.0
"""What is logged of the run [s]."""
PLANTED = hm.ProbeRunout(once=6e-6, once_phase=0.8, twice=2e-6)
AT = "disc"
PROBES = ("de_r", "de_l", "disc_r", "disc_l")
MODULI = ("s1.youngs_modulus", "s2.youngs_modulus")
HOUSINGS = tuple(f"{end}.housing.stiffness_{axis}" for end in ("de", "nde") for axis in "xy")


def fan() -> hm.Scene:
    """A disc between two bearings in housings, with two probes at 45 degrees at the drive end and at the disc."""
    steel = {"diameter": hm.mm(30), "youngs_modulus": 2.06e11, "shear_modulus": 7.9e10, "density": 7850.0, "damping": 2e-5}
    law = hm.LinearBearing.isotropic(radial=2e7, damping=800.0, axial=1e7, axial_damping=100.0, tilt=500.0, tilt_damping=0.5)
    housing = hm.Housing.isotropic(mass=15.0, stiffness=3e7, damping=600.0)
    bearing = hm.Bearing(law=law, mass=1.0, polar_inertia=1e-3, transverse_inertia=8e-4, housing=housing)
    right, left = hm.degrees(45), hm.degrees(135)
    return hm.Scene(
        name="fan",
        parts={
            "drive": hm.DriveTorque(characteristic=hm.TorqueSpeedTable(speeds=(0.0, 400.0), torques=(8.0, 2.0))),
            "de": bearing,
            "s1": hm.ShaftSection(length=0.3, **steel),
            "disc": hm.Rotor(mass=12.0, polar_inertia=0.08, transverse_inertia=0.045, eccentricity=3e-5),
            "s2": hm.ShaftSection(length=0.35, **steel),
            "nde": bearing,
            "gravity": hm.Gravity(),
            "de_r": hm.Probe(at="de", angle=right, relative=True),
            "de_l": hm.Probe(at="de", angle=left, relative=True),
            "disc_r": hm.Probe(at="disc", angle=right),
            "disc_l": hm.Probe(at="disc", angle=left),
        },
        connections=[("drive", "de", "s1", "disc", "s2", "nde")],
    )


def log(scene: hm.Scene) -> hm.Record:
    """The log of a run of the multibody engine: angle of the encoder, and the probes with noise."""
    run = hm.simulate(scene, LAST, solver=hm.RungeKutta4(step=STEP), initial_speed=150.0, progress=False)
    samples = slice(round(FIRST / STEP), None, FOLD)
    times = run.times[samples]
    rng, step = np.random.default_rng(1), 2.0 * np.pi / LINES
    angle = step * np.round(run["drive.angle"].values[samples] / step)
    columns = [hm.TimeHistory(name, "m", times, run[name].values[samples] + NOISE * rng.standard_normal(len(times))) for name in PROBES]
    return hm.Record.of("log", [hm.TimeHistory("angle", "rad", times, angle), *columns])


@dataclass(frozen=True, kw_only=True)
class PlainBench(Bench):
    """A bench with its run-in alone: nothing is taken out."""

    def trials(self, record: hm.Record) -> tuple[Trial, ...]:
        return tuple(replace(trial, ringing=None) for trial in super().trials(record))


def bench(scene: hm.Scene, run_in: float, kind: type[Bench] = Bench) -> Bench:
    """The bench, held to the angle of the log."""
    return kind(
        scene=scene,
        knowledge={
            "disc": hm.Uncertain(paths=("disc.mass",), sigma=0.02),
            "shaft": hm.Uncertain(paths=MODULI, sigma=0.03),
            "housing": hm.Uncertain(paths=HOUSINGS, sigma=0.1),
        },
        measured={name: hm.Measured(channel=name, noise=NOISE) for name in PROBES},
        inputs={"angle": hm.Input(path="drive.characteristic", law=lambda t, a: hm.IdealSpeedMotor(motion=hm.smoothed_motion(t, a)))},
        run_in=run_in,
    )
