"""A diagnosis of a rotor line begins where the line rests, as a machine and a run-up do."""

from __future__ import annotations

import dataclasses
from functools import cache

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.run_up.run_up import RunUp
from hdrive_mbs.diagnosis.bench import Bench, Uncertain
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record

NOISE, EVERY, DURATION = 1e-6, 5e-4, 0.4


def line() -> hm.Scene:
    """An overhung wheel of 19.6 kg, driven by a steady torque; the wheel hangs 50 um below its bearings' line."""
    law = hm.LinearBearing.isotropic(radial=8e7, damping=600.0, axial=5e7, axial_damping=200.0)
    housing = hm.Housing.isotropic(mass=5.0, stiffness=3e7, damping=1500.0)
    bearing = hm.Bearing(law=law, mass=0.3, polar_inertia=8e-5, transverse_inertia=6e-5, housing=housing)
    other = bearing.replacing(law=hm.LinearBearing.isotropic(radial=8e7, damping=600.0))
    return hm.rotor_line(
        "overhung wheel",
        stations={
            "pulley": (0.0, hm.Rotor(mass=1.0, polar_inertia=1e-3, transverse_inertia=6e-4)),
            "drive_end": (0.1, bearing),
            "free_end": (0.4, other),
            "wheel": (0.58, hm.Rotor.disc(diameter=0.4, thickness=0.02, density=7800.0, eccentricity=1.5e-5)),
        },
        shaft=hm.mm(45),
        material=hm.ShaftMaterial(youngs_modulus=2.1e11, shear_modulus=8.1e10, damping=5e-6),
        parts={"drive": hm.DriveTorque(characteristic=hm.TorqueHistory(times=(0.0, 1.0), torques=(40.0, 40.0))), "weight": hm.Gravity()},
        connections=[("drive", "pulley")],
    )


@cache
def run_up() -> RunUp:
    return hm.run_up(line(), DURATION)


def bench() -> Bench:
    return Bench(
        scene=line(),
        knowledge={"eccentricity": Uncertain(paths=("wheel.eccentricity",), sigma=0.1)},
        measured={name: Measured(channel=channel, noise=NOISE) for name, channel in (("x", "wheel.x"), ("y", "wheel.y"))},
    )


def record() -> Record:
    rng = np.random.default_rng(5)
    times = EVERY * np.arange(round(DURATION / EVERY))
    read = {axis: run_up()[f"wheel.{axis}"].at(times) + rng.normal(0.0, NOISE, len(times)) for axis in "xy"}
    return Record(name="run up", times=times, channels={axis: Measurement(name=axis, unit="m", values=read[axis]) for axis in read})


def simulated(known: Bench) -> Simulator:
    trials = known.trials(record())
    return Simulator(trials, suitable_step(trials, factors_of(known)))


@pytest.mark.parametrize("settled", [True, False])
def test_a_record_that_begins_at_rest_is_noise_beside_the_model_that_made_it(settled: bool) -> None:
    """A line that starts undeflected falls by 50 um, fifty times the noise, and rings."""
    known = dataclasses.replace(bench(), settled=settled)
    simulator = simulated(known)
    fitted = fit(simulator, Hypothesis(factors_of(known)), np.zeros(1), steps=0)
    # the mean square of n normal numbers scatters by sqrt(2/n)
    assert (abs(fitted.chi_fit - 1.0) < 5.0 * np.sqrt(2.0 / np.count_nonzero(simulator.fit))) == settled


def test_a_drive_has_nothing_to_settle() -> None:
    from tests.unit.diagnosis_cases import bench as drive
    from tests.unit.diagnosis_cases import quiet

    assert [trial.settled for trial in drive().trials(quiet()[0])] == [False]
