"""A small drive bench and records of it with a known cause, for tests of the diagnosis.

A servo motor turns a load through a strain-wave gear with an elastic flexspline: two inertias.  The records are made by
the multibody engine (variable step, 1e-8), which the search does not use, with parameters off by their tolerance, noise
and rounding.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.bench import Bench, Input, Uncertain
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Added, FloatArray, Hypothesis
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record

STEP, DURATION = 1e-3, 1.6
UNITS = {"motor_torque": "N m", "motor_angle": "rad", "load_angle": "rad", "speed_reference": "rad/s", "load_torque": "N m"}
NOISE = {"motor_torque": 2e-3, "motor_angle": 2e-4, "load_angle": 3e-6}
CHANNELS = {"motor_torque": "motor.torque", "motor_angle": "motor_encoder", "load_angle": "load_encoder"}
KNOWLEDGE = {
    "motor_inertia": ("motor.inertia", 0.03),
    "motor_viscous": ("motor.viscous", 0.1),
    "flexspline_stiffness": ("gear.stiffness.linear", 0.05),
    "flexspline_damping": ("gear.damping", 0.1),
    "load_inertia": ("load.inertia", 0.03),
    "load_viscous": ("load.viscous", 0.1),
}
DISTURBED = {
    "motor_inertia": 0.7,
    "motor_viscous": -1.1,
    "flexspline_stiffness": -0.8,
    "flexspline_damping": 0.6,
    "load_inertia": 0.5,
    "load_viscous": -0.4,
}
"""Errors of the parameters in every record, in their standard deviations."""
INPUTS: dict[str, tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...], tuple[float, ...]]] = {
    "staircase": (
        (0.0, 0.05, 0.2, 0.4, 0.55, 0.75, 1.1, 1.3, 1.6),
        (0.0, 0.0, 60.0, 60.0, 140.0, 140.0, -90.0, -90.0, 5.0),
        (0.0, 1.6),
        (2.0, 2.0),
    ),
    "load_cycle": (
        (0.0, 0.05, 0.25, 0.8, 1.1, 1.6),
        (0.0, 0.0, 40.0, 40.0, -25.0, -25.0),
        (0.0, 0.4, 0.5, 0.7, 0.8, 1.2, 1.3, 1.6),
        (0.0, 0.0, 25.0, 25.0, -10.0, -10.0, 15.0, 0.0),
    ),
}
"""Record -> times and values of the speed reference, times and values of the load torque."""


def scene(shaft: bool = False) -> hm.Scene:
    """The bench at rest; on request with a shaft and a hub between motor and gear, whose turning no column shows."""
    between: dict[str, hm.Component] = {
        "input_shaft": hm.Shaft(stiffness=400.0, damping=0.05),
        "wave_generator": hm.Inertia(inertia=1.5e-4),
    }
    return hm.Scene(
        name="small drive",
        parts={
            **(between if shaft else {}),
            "motor": hm.Motor(
                inertia=1.2e-3,
                viscous=1.5e-3,
                characteristic=hm.ServoMotor(
                    torque_limit=20.0,
                    proportional_gain=0.3,
                    integral_gain=4.0,
                    reference=hm.SpeedTable(times=(0.0, 1.0), speeds=(0.0, 0.0)),
                ),
            ),
            "gear": hm.HarmonicDrive(ratio=50.0, output_sense="same", stiffness=hm.CubicStiffness(linear=1.2e4, cubic=0.0), damping=6.0),
            "load": hm.Load(inertia=0.8, viscous=0.3, torque=hm.TableTorque(times=(0.0, 1.0), torques=(0.0, 0.0))),
            "motor_encoder": hm.Sensor(quantity="motor.angle"),
            "load_encoder": hm.Sensor(quantity="load.angle"),
        },
        connections=[("motor", *(between if shaft else ()), "gear", "load")],
    )


def bench(columns: Sequence[str] = tuple(CHANNELS), knowledge: Mapping[str, tuple[str, float]] = KNOWLEDGE, shaft: bool = False) -> Bench:
    """What is known of it, with these measured columns."""
    return Bench(
        scene=scene(shaft),
        knowledge={name: Uncertain(paths=(path,), sigma=sigma) for name, (path, sigma) in knowledge.items()},
        measured={name: Measured(channel=CHANNELS[name], noise=NOISE[name]) for name in columns},
        inputs={
            "speed_reference": Input(path="motor.characteristic.reference", law=lambda t, v: hm.SpeedTable(times=t, speeds=v)),
            "load_torque": Input(path="load.torque", law=lambda t, v: hm.TableTorque(times=t, torques=v)),
        },
    )


def driven(which: str, shaft: bool = False) -> hm.Scene:
    """The bench with the inputs of a record."""
    times, speeds, load_times, torques = INPUTS[which]
    return scene(shaft).replacing(
        {
            "motor.characteristic.reference": hm.SpeedTable(times=times, speeds=speeds),
            "load.torque": hm.TableTorque(times=load_times, torques=torques),
        }
    )


def records(
    *effects: tuple[Effect, str],
    errors: Mapping[str, float] = DISTURBED,
    seed: int = 1,
    columns: Sequence[str] = tuple(CHANNELS),
    step: float = STEP,
    names: Sequence[str] = tuple(INPUTS),
    shaft: bool = False,
) -> tuple[Record, ...]:
    """Records of the bench with these effects at places, parameters off by ``errors`` standard deviations."""
    return tuple(_record(name, driven(name, shaft), effects, errors, seed + k, columns, step) for k, name in enumerate(names))


def _record(
    which: str,
    plant: hm.Scene,
    effects: Sequence[tuple[Effect, str]],
    errors: Mapping[str, float],
    seed: int,
    columns: Sequence[str],
    step: float,
) -> Record:
    known = plant.parameters()
    plant = plant.replacing(
        {path: known[path].value * math.exp(sigma * errors.get(name, 0.0)) for name, (path, sigma) in KNOWLEDGE.items()}
    )
    for effect, place in effects:
        plant = plant.with_effect(effect, at=place)
    times = step * np.arange(round(DURATION / step) + 1)
    solver = hm.DormandPrince(relative_tolerance=1e-8, absolute_tolerance=1e-10)
    response = hm.simulate(plant, DURATION, solver=solver, sample_step=step, progress=False)
    rng = np.random.default_rng(seed)
    reference_times, speeds, load_times, torques = INPUTS[which]
    values = {name: response.at(CHANNELS[name], times) for name in columns}
    values = {name: clean + NOISE[name] * rng.standard_normal(len(times)) for name, clean in values.items()}
    values["speed_reference"] = np.interp(times, reference_times, speeds)
    values["load_torque"] = np.interp(times, load_times, torques)
    channels = {name: Measurement(name=name, unit=UNITS[name], values=item) for name, item in values.items()}
    return Record(name=which, times=times, channels=channels)


@cache
def quiet() -> tuple[Record, ...]:
    """Records without any cause."""
    return records()


def standing(hypothesis: Hypothesis, curvature: FloatArray) -> Fitted:
    """A hypothesis at its start values, as if records had left it there, with what they say of its parameters."""
    return Fitted(
        hypothesis=hypothesis,
        z=hypothesis.start(),
        residuals=np.zeros(0),
        cost=0.0,
        curvature=curvature,
        converged=True,
        steps=0,
        chi_fit=1.0,
        chi_held=1.0,
        typical=1.0,
        misfit_held=0.0,
    )


def fitted_pair(simulator: Simulator, factors: Sequence[Factor], first: Added, second: Added) -> Found:
    """Two causes, the second found last, fitted in a few steps."""
    hypothesis = Hypothesis(tuple(factors), (first, second))
    suspect = Suspect(second.label, type(second.effect).__name__, (hypothesis,), (hypothesis,))
    return Found(suspect, fit(simulator, hypothesis, hypothesis.start(), steps=12))
