"""Lines from templates are the lines that are built, for every law and place that a search tries on a drive."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.candidates import Candidate, candidates
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.lines import Lines
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.templates import Templates, alike
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter
from models import drive_bench

BENCH = drive_bench.bench()
CHANNELS = ("motor.speed", "load.angle")
CANDIDATES = candidates(BENCH.scene)


def compiled(network: Network) -> CompiledLine:
    return CompiledLine(network, CHANNELS)


def hypothesis_of(candidate: Candidate) -> Hypothesis:
    return Hypothesis(factors_of(BENCH), candidate.starts[:1])


def beside(hypothesis: Hypothesis, number: int, size: float = 1.0) -> list[np.ndarray]:
    rng = np.random.default_rng(5)
    start = hypothesis.start()
    return [hypothesis.clipped(start + size * rng.standard_normal(len(start))) for _ in range(number)]


@pytest.mark.parametrize("candidate", CANDIDATES, ids=lambda item: f"{item.kind.__name__}-{item.at}")
def test_each_law_has_a_template_that_gives_the_lines_that_are_built(candidate: Candidate) -> None:
    hypothesis = hypothesis_of(candidate)
    points = beside(hypothesis, 3)
    template = Templates().of(hypothesis, BENCH.scene, points[0], "view", compiled)
    assert template is not None
    lines = template.lines([hypothesis.values(z, to_run=True) for z in points])
    assert any(line is not None for line in lines)
    for z, line in zip(points, lines, strict=True):
        if line is not None:
            assert alike(line.program, compiled(hypothesis.scene(BENCH.scene, z, to_run=True).network()).program)


def test_a_scene_as_it_is_has_none() -> None:
    """As in the plans of a next experiment, which search nothing."""
    kept = Templates()
    bare = Hypothesis(factors=())
    assert kept.of(bare, BENCH.scene, bare.start(), "view", compiled) is None
    assert kept.of(bare, BENCH.scene, bare.start(), "view", compiled) is None


def test_one_template_serves_all_that_differ_in_searched_numbers_and_no_others() -> None:
    kept = Templates()
    ripple = next(item for item in CANDIDATES if item.kind is hm.TorqueRipple)
    orders = {start.effect.order: Hypothesis(factors_of(BENCH), (start,)) for start in ripple.starts}
    assert len(orders) > 1
    found = [kept.of(item, BENCH.scene, item.start(), "view", compiled) for item in orders.values()]
    assert len(set(map(id, found))) == len(orders)
    first = next(iter(orders.values()))
    rescaled, start = first.rescaled(beside(first, 1)[0])
    assert kept.of(rescaled, BENCH.scene, start, "view", compiled) is found[0]
    assert kept.of(first, BENCH.scene, first.start(), "another view", compiled) is not found[0]
    nominal = Hypothesis(factors_of(BENCH))
    assert kept.of(nominal, BENCH.scene, nominal.start(), "view", compiled) is not None


@dataclass(frozen=True, kw_only=True)
class OutOfSight(TorqueEffect):
    """Drag whose size is taken to an array and back.

    tau = -c w

    Source: made up.  Leaves out all else.
    """

    drag: float = parameter("N m s/rad", "c", low=0.0, high=10.0, typical=(1e-3, 1.0))

    tried: ClassVar[bool] = False

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -float(np.array([self.drag])[0]) * speed


def test_a_law_that_computes_out_of_sight_has_none() -> None:
    hypothesis = Hypothesis(factors_of(BENCH), (Added(OutOfSight(drag=0.1), "load", "it"),))
    assert Templates().of(hypothesis, BENCH.scene, hypothesis.start(), "view", compiled) is None


@dataclass(frozen=True, kw_only=True)
class Particular(OutOfSight):
    """Drag that takes nothing but plain floats.

    tau = -c w

    Source: made up.  Leaves out all else.
    """

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        if type(self.drag) is not float:
            raise KeyError(self.drag)
        return -self.drag * speed


def test_a_law_that_fails_with_tracked_numbers_alone_has_none_and_is_built() -> None:
    hypothesis = Hypothesis(factors_of(BENCH), (Added(Particular(drag=0.1), "load", "it"),))
    assert Templates().of(hypothesis, BENCH.scene, hypothesis.start(), "view", compiled) is None
    assert compiled(hypothesis.scene(BENCH.scene, hypothesis.start()).network()).program.constants.size


@dataclass(frozen=True, kw_only=True)
class TurnsLater(OutOfSight):
    """Drag that computes out of sight beyond a size.

    tau = -c w

    Source: made up.  Leaves out all else.
    """

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -(self.drag if float(self.drag) < 0.5 else 3.0) * speed


def test_a_template_is_held_against_what_is_built_again_and_again_and_dropped_where_it_fails() -> None:
    """A way chosen by a number out of sight is found in its 2nd, 4th, 8th ... use."""
    hypothesis = Hypothesis(factors_of(BENCH), (Added(TurnsLater(drag=0.1), "load", "it"),))
    far = hypothesis.start()
    far[-1] *= 9.0
    assert hypothesis.values(far)["it.drag"] > 0.5
    kept = Templates()
    asked = [kept.of(hypothesis, BENCH.scene, z, "view", compiled) for z in (hypothesis.start(), hypothesis.start(), far, far, far)]
    assert [item is None for item in asked] == [False, False, False, True, True]


def test_lines_of_trials_are_the_same_with_and_without_templates(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two records with inputs of their own, through a search's lines: constants alike, each with its own inputs."""
    times = (0.0, 0.5, 1.0)
    references = [hm.SpeedTable(times=times, speeds=(0.0, top, 0.0)) for top in (30.0, 50.0)]
    scenes = [BENCH.scene.replacing({"motor.characteristic.reference": reference}) for reference in references]
    still = np.zeros(8)
    trials = [
        Trial(
            name=f"run {k}",
            scene=scene,
            every=1e-3,
            columns={"speed": still},
            measured={"speed": Measured(channel="motor.speed", noise=1e-3)},
            held_out=still > 0.0,
        )
        for k, scene in enumerate(scenes)
    ]
    hypothesis = hypothesis_of(next(item for item in CANDIDATES if item.kind is hm.ViscousDrag and item.at == "load"))
    points = beside(hypothesis, 4)
    made = Lines(trials).at(hypothesis, points)
    monkeypatch.setattr(Templates, "of", lambda *_, **__: None)
    built = Lines(trials).at(hypothesis, points)
    for trial, own in zip(made, built, strict=True):
        for a, b in zip(trial, own, strict=True):
            assert a is not None
            assert b is not None
            assert alike(a.line.program, b.line.program)
            assert a.line.program.inputs == b.line.program.inputs
    assert made[0][0].line.program.inputs != made[1][0].line.program.inputs  # type: ignore[union-attr]
