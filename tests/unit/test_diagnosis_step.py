"""The step of a diagnosis: as long as the fastest vibration of the nominal model lets it be, and half of it for what stiffens the line."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.along import along
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor

EVERY, SAMPLES, INERTIA = 1e-3, 400, 1e-3
REACH = 2.0 * math.sqrt(2.0)
"""Step times angular frequency up to which the classical Runge-Kutta method does not let a vibration grow."""


def trial(rate: float) -> Trial:
    """Two inertias whose vibration against each other has this angular frequency [rad/s], turned by a steady torque."""
    scene = hm.Scene(
        name="pair",
        parts={
            "motor": hm.Motor(inertia=INERTIA, characteristic=hm.TorqueHistory(times=(0.0, 1.0), torques=(1e-3, 1e-3))),
            "shaft": hm.Shaft(stiffness=0.5 * INERTIA * rate**2, damping=0.0),
            "load": hm.Inertia(inertia=INERTIA),
        },
        connections=[("motor", "shaft", "load")],
    )
    return Trial(
        name="run",
        scene=scene,
        every=EVERY,
        columns={"angle": np.zeros(SAMPLES)},
        measured={"angle": Measured(channel="load.angle", noise=1e-3)},
        held_out=np.zeros(SAMPLES, bool),
    )


@pytest.mark.parametrize("parts", [2, 3, 4, 6, 8])
def test_a_step_is_the_longest_part_of_a_sample_at_which_nothing_grows(parts: int) -> None:
    longest = REACH * parts / EVERY  # of the angular frequencies that this part of a sample can follow
    assert suitable_step([trial(0.95 * longest)], ()) == pytest.approx(EVERY / parts)
    assert suitable_step([trial(1.1 * longest)], ()) < 0.9 * EVERY / parts


@pytest.mark.parametrize("z", [1.2, 2.0, 4.0])
def test_a_point_that_grows_at_the_step_is_run_with_half_of_it(z: float) -> None:
    """Slowly, so that it is finite in the end but far beyond the record, or beyond all numbers."""
    rate = 0.95 * REACH * 3 / EVERY
    given = [trial(rate)]
    stiff = Hypothesis(factors=(Factor("", name="stiffness", nominal={"shaft.stiffness": 0.5 * INERTIA * rate**2}, sigma=0.1),))
    nominal, stiffer = np.zeros(1), np.array([z])  # 1.4 times as stiff at 4: 1.18 times as fast
    step = suitable_step(given, ())
    alone = Simulator(given, step, again=False).residuals(stiff, [nominal, stiffer])
    assert alone[0] is not None
    assert alone[1] is None or np.max(np.abs(alone[1])) > 1e6
    first, second = Simulator(given, step).residuals(stiff, [nominal, stiffer])
    [halved] = Simulator(given, step, parts=2, again=False).residuals(stiff, [stiffer])
    np.testing.assert_array_equal(first, alone[0])
    np.testing.assert_array_equal(second, halved)


def late(rate: float, every: float, noise: float) -> Trial:
    """The trial with a column that is compared half a sample later: its samples are half as far apart as the others."""
    return dataclasses.replace(trial(rate), every=every, measured={"angle": Measured(channel="load.angle", noise=noise, late=0.5)})


@pytest.mark.parametrize(("noise", "whole"), [(1e-3, True), (1e-10, False)])
def test_a_step_beside_a_column_that_is_compared_later_is_checked_with_half_of_what_is_taken(noise: float, whole: bool) -> None:
    """A whole sample and a half of it are the same run there, which differs from itself by nothing."""
    every = 4e-4
    assert (suitable_step([late(1.2 * REACH / every, every, noise)], ()) == every) == whole


def test_a_point_that_grows_is_run_with_half_of_what_was_taken_beside_a_column_that_is_compared_later() -> None:
    rate = 1.95 * REACH / EVERY  # half a sample follows it, and not what is 1.18 times as fast
    stiff = Hypothesis(factors=(Factor("", name="stiffness", nominal={"shaft.stiffness": 0.5 * INERTIA * rate**2}, sigma=0.1),))
    first, second = Simulator([late(rate, EVERY, 1e-3)], EVERY).residuals(stiff, [np.zeros(1), np.array([4.0])])
    assert first is not None
    assert second is not None
    assert np.max(np.abs(second - first)) < 1.0


@pytest.mark.parametrize("shift", [0.0, 0.5])
def test_channels_along_a_trial_are_those_of_the_run_that_a_fit_compares(shift: float) -> None:
    """Also where that run took half of the step, because it grew."""
    rate = (1.95 if shift else 0.95 * 3) * REACH / EVERY
    given = late(rate, EVERY, 1e-3) if shift else trial(rate)
    given = dataclasses.replace(given, held_out=np.arange(SAMPLES) % 8 == 0)
    stiff = Hypothesis(factors=(Factor("", name="stiffness", nominal={"shaft.stiffness": 0.5 * INERTIA * rate**2}, sigma=0.1),))
    simulator = Simulator([given], EVERY if shift else suitable_step([given], ()))
    point = np.array([4.0])
    fitted = fit(simulator, stiff, point, steps=0)
    found = along(simulator, 0, fitted, ["load.speed", "load.angle", "no such channel"])
    assert set(found) == {"load.speed", "load.angle"}
    [own] = simulator.columns(stiff, point)
    at, compared = found["load.angle"], own["angle"]
    if shift:  # midway between samples a steady acceleration bends by a h^2/8, and the shaft twists by T/K at most while it vibrates
        acceleration, twist = 1e-3 / (2.0 * INERTIA), 1e-3 / (0.5 * INERTIA * rate**2)
        np.testing.assert_allclose(compared[:-1], 0.5 * (at[1:] + at[:-1]), rtol=0.0, atol=acceleration * EVERY**2 / 8.0 + twist)
    else:
        np.testing.assert_array_equal(compared, at)
    # both inertias under the torque alone, and the vibration on top
    assert np.max(np.abs(found["load.speed"])) == pytest.approx(1e-3 / (2.0 * INERTIA) * SAMPLES * EVERY, rel=0.02)
