"""Something that hangs askew on a housing is found with both its frequencies.

The records are made by the multibody engine with a step of its own and noise; the search runs compiled lines.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record
from models import jeffcott

STEP, DURATION = 1e-3, 0.8
NOISE = {"disc.x": 1e-6, "disc.y": 1e-6, "right.housing.x": 2e-7, "right.housing.y": 2e-7}
PIPE = hm.HiddenModeSupport(mass=1.0, natural_frequency=150.0, ratio=1.54, damping_ratio=0.02, angle=1.24)


def scene() -> hm.Scene:
    """A disc between a stiff and a soft support, which runs up through its critical speed."""
    line = jeffcott.build(
        eccentricity=20e-6, damping_ratio=0.05, bearing_stiffness=5e6, bearing_damping=100.0, torque=40.0, final_speed=320.0
    )
    housing = hm.Housing.isotropic(mass=3.0, stiffness=2e6, damping=300.0)
    return dataclasses.replace(line, parts={**line.parts, "right": line.parts["right"].replacing(housing=housing)})


def record(effect: hm.HiddenModeSupport) -> Record:
    times = np.asarray(STEP * np.arange(round(DURATION / STEP) + 1), float)
    solver = hm.Trapezoidal(step=1e-4, newton_tolerance=1e-8)
    run = hm.simulate(scene().with_effect(effect, at="right"), DURATION, solver=solver, sample_step=STEP, progress=False)
    rng = np.random.default_rng(5)
    values = {name: run.at(name, times) + noise * rng.standard_normal(len(times)) for name, noise in NOISE.items()}
    return Record(name="run_up", times=times, channels={n: Measurement(name=n, unit="m", values=v) for n, v in values.items()})


@pytest.mark.slow
def test_a_mass_that_hangs_askew_is_found_with_both_frequencies_and_its_direction() -> None:
    bench = hm.Bench(
        scene=scene(),
        knowledge={"eccentricity": hm.Uncertain(paths=("disc.eccentricity",), sigma=0.1)},
        measured={name: hm.Measured(channel=name, noise=noise) for name, noise in NOISE.items()},
        settled=False,  # the record is of a model that starts undeflected; it has no weight
    )
    found = diagnose(bench, record(PIPE), candidates=[hm.HiddenModeSupport, hm.SupportStiffnessChange])
    [cause] = found.causes
    assert (cause.effect, cause.at) == ("hidden_mode_support", "right")
    values = {item.name.rpartition(".")[2]: item.value for item in cause.parameters}
    one, two = values["natural_frequency"], values["natural_frequency"] * values["ratio"]
    assert sorted((one, two)) == pytest.approx([150.0, 231.0], rel=0.01)
    first = values["angle"] if one < two else values["angle"] + 0.5 * math.pi
    assert math.remainder(first - PIPE.angle, math.pi) == pytest.approx(0.0, abs=0.03)
    assert values["mass"] == pytest.approx(PIPE.mass, rel=0.03)
    assert abs(found.gap.effect.value - 1.0) < 4.0 / math.sqrt(2.0 * len(NOISE) * 0.25 * DURATION / STEP)
    assert found.gap.refit.value > 5.0
