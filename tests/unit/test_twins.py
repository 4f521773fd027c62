"""Laws under two names that act exactly alike: an eccentric weight on the shaft of a motor, and a ripple once a turn."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis import from_the_best
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.from_the_best import twins
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.search import _Work, search
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect, suspects
from hdrive_mbs.diagnosis.tasks import Found, run_task
from hdrive_mbs.diagnosis.team import Team
from tests.unit.diagnosis_cases import bench, records, scene

BENCH = bench()
WEIGHT = hm.EccentricLoad(mass=0.8, radius=0.1, start_angle=0.7, second_torque=0.05, second_phase=-0.4)
RIPPLE = hm.TorqueRipple(amplitude=0.6, order=1.0, phase=-1.1, second_amplitude=0.04, second_phase=2.0)


@pytest.mark.parametrize("output_sense", ["same", "opposite"])
@pytest.mark.parametrize("place", ["motor", "load"])
@pytest.mark.parametrize("effect", [WEIGHT, RIPPLE], ids=["weight", "ripple"])
def test_a_twin_moves_a_line_exactly_alike(effect: hm.Effect, place: str, output_sense: str) -> None:
    """A load behind a gear that reverses turns forward in the other sense; a run of 0.4 s from 30 rad/s at the motor, to rounding."""
    line = scene()
    line = line.replacing({"gear.output_sense": output_sense})
    network = line.network()
    [body] = [body for body in network.bodies if body.name == network.places[place]]
    [twin] = effect.twins(body.sense)
    assert type(twin) is not type(effect)
    angles = []
    for item in (effect, twin):
        compiled = CompiledLine(line.with_effect(item, at=place, name="extra").network(), [f"{place}.angle", "extra.torque"])
        run = compiled.run(401, 1e-3, step=2e-4, speeds={"motor": 30.0})
        angles.append(np.array([run.values[f"{place}.angle"], run.values["extra.torque"]]))
    plain = CompiledLine(network, [f"{place}.angle"]).run(401, 1e-3, step=2e-4, speeds={"motor": 30.0}).values[f"{place}.angle"]
    largest = np.abs(angles[0]).max(axis=1, keepdims=True)
    np.testing.assert_allclose(angles[1] / largest, angles[0] / largest, rtol=0.0, atol=1e-10)
    assert np.abs(plain - angles[0][0]).max() > 1e-4 * np.abs(plain).max()  # the effect shows at all
    [back] = twin.twins(body.sense)
    assert type(back) is type(effect)


def test_what_grows_with_the_torque_or_comes_more_often_has_no_twin() -> None:
    assert dataclasses.replace(RIPPLE, relative=0.01).twins(1) == ()
    assert dataclasses.replace(RIPPLE, order=2.0).twins(1) == ()
    assert hm.ViscousDrag(coefficient=1e-3).twins(1) == ()


@pytest.fixture(scope="module")
def weighed() -> tuple[Simulator, Fitted, list[Suspect]]:
    """A record of the small bench with a ripple once a turn, its nominal model refitted, and both laws as suspects."""
    given = records((dataclasses.replace(RIPPLE, amplitude=0.2), "motor"))
    simulator = Simulator(BENCH.trials(given[0]), 2.5e-4, 4)
    hypothesis = Hypothesis(factors_of(BENCH))
    base = fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=10)
    return simulator, base, suspects(hypothesis, {}, candidates(BENCH.scene, [hm.EccentricLoad, hm.TorqueRipple]))


def _found(weighed: tuple[Simulator, Fitted, list[Suspect]]) -> Found:
    """The weight at the motor as a fit found it."""
    simulator, base, everything = weighed
    [suspect] = [item for item in everything if item.law == "EccentricLoad" and item.label[1] == "motor"]
    old = suspect.all[0]
    start = Hypothesis(old.factors, (*old.added[:-1], Added(WEIGHT.replacing(mass=0.2), "motor", old.added[-1].name)))
    return Found(suspect, fit(simulator, start, start.start(base.z), steps=25))


def test_a_twin_begins_where_the_best_ended_and_comes_out_as_good(weighed: tuple[Simulator, Fitted, list[Suspect]]) -> None:
    simulator, base, everything = weighed
    best = _found(weighed)
    assert best.fitted.cost < 0.5 * base.cost
    [(suspect, task)] = twins([best], base, everything, simulator)
    assert (suspect.law, suspect.label[1]) == ("TorqueRipple", "motor")
    begun = simulator.residuals(task.hypothesis, [task.z])[0]
    np.testing.assert_allclose(begun, best.fitted.residuals, rtol=0.0, atol=1e-5)
    fitted = run_task(simulator, task)
    assert fitted is not None
    assert fitted.cost == pytest.approx(best.fitted.cost, abs=from_the_best.ALIKE)
    assert twins([best, Found(suspect, fitted)], base, everything, simulator) == []  # it is there
    assert twins([], base, everything, simulator) == []


def test_a_search_that_passes_a_twin_over_names_it_beside_the_best(
    weighed: tuple[Simulator, Fitted, list[Suspect]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without any look at the ripple it is there at the end, and with the twins left out too it is not."""
    simulator, base, _ = weighed
    kinds = candidates(BENCH.scene, [hm.EccentricLoad, hm.TorqueRipple])
    looked = _Work._looked

    def without_ripple(*given: Any) -> Any:
        return [(suspect, look) for suspect, look in looked(*given) if suspect.law != "TorqueRipple"]

    monkeypatch.setattr(_Work, "_looked", without_ripple)
    costs = {item.suspect.label: item.fitted.cost for item in search(Team(1), simulator, base, {}, kinds).labels}
    assert abs(costs["eccentric_load", "motor"] - costs["torque_ripple", "motor"]) < from_the_best.ALIKE
    monkeypatch.setattr("hdrive_mbs.diagnosis.search.twins", lambda *_: [])
    assert ("torque_ripple", "motor") not in {item.suspect.label for item in search(Team(1), simulator, base, {}, kinds).labels}
