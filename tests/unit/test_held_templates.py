"""Templates of rotor lines: all numbers but those of the effect that was added last are held."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis import templates
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.lines import Lines, _compiled
from hdrive_mbs.diagnosis.templates import PAYS, Templates, alike
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.network.network import Network
from tests.unit.rotor_bench_records import bench, compiled, factors, recorded

LAWS = (hm.BallPassHarmonics, hm.OilWhirl, hm.Rub, hm.HiddenMode, hm.Misalignment, hm.GroundVibration, hm.BearingCubicStiffness)


@pytest.fixture(scope="module")
def trials() -> list[Trial]:
    return [item for name in ("run_up", "steps") for item in bench().trials(recorded(name, compiled(name, 0.05), noisy=False))]


@pytest.fixture(scope="module")
def hypotheses() -> dict[type[hm.Effect], Hypothesis]:
    found: dict[type[hm.Effect], Hypothesis] = {}
    for item in candidates(bench().scene, LAWS):
        found.setdefault(item.kind, Hypothesis(factors("bearing_stiffness", "youngs_modulus"), item.starts[:1]))
    return found


def about(hypothesis: Hypothesis, number: int, *, nominal: float = 0.0) -> list[np.ndarray]:
    """The start with both nominal parameters moved, then points that differ from it in what was added alone."""
    start = hypothesis.start()
    start[:2] = nominal
    rng = np.random.default_rng(3)
    moves = [np.zeros(len(start) - 2), *(0.3 * rng.standard_normal(len(start) - 2) for _ in range(number - 1))]
    return [hypothesis.clipped(np.append(start[:2], start[2:] + move)) for move in moves]


@pytest.mark.parametrize("law", LAWS)
def test_a_law_on_a_rotor_line_has_a_template_about_held_parameters(
    law: type[hm.Effect], hypotheses: dict[type[hm.Effect], Hypothesis], trials: list[Trial]
) -> None:
    """Also where it begins, with angles of zero, of which sine and cosine are numbers of their own in a built line."""
    hypothesis, trial = hypotheses[law], trials[0]

    def made(network: Network) -> CompiledLine:
        return _compiled(network, trial)

    points = about(hypothesis, PAYS, nominal=0.4)
    lines = Templates(large=True, held=True).lines(hypothesis, trial.scene, points, "lateral", made)
    assert sum(line is not None for line in lines) >= PAYS - 2  # a way may part where a size comes to its limit
    for z, line in zip(points[1:], lines[1:], strict=True):
        if line is not None:
            assert alike(line.program, made(hypothesis.scene(trial.scene, z, to_run=True).network()).program)
    if lines[0] is not None:
        built = made(hypothesis.scene(trial.scene, points[0], to_run=True).network())
        runs = [item.run(60, trial.every, step=trial.every / 6, speeds=trial.speeds).values for item in (lines[0], built)]
        for name, values in runs[1].items():
            # by one and with zero all is exact; what is gathered in another order rounds otherwise, by 1e-16 in each of 360 steps
            np.testing.assert_allclose(runs[0][name], values, rtol=0.0, atol=1e-13 * np.abs(values).max())


def test_one_is_made_where_it_pays_and_holds_for_its_own_parameters_alone(
    hypotheses: dict[type[hm.Effect], Hypothesis], trials: list[Trial], monkeypatch: pytest.MonkeyPatch
) -> None:
    hypothesis, trial = hypotheses[hm.OilWhirl], trials[0]
    built: list[Network] = []

    def made(network: Network) -> CompiledLine:
        built.append(network)
        return _compiled(network, trial)

    kept = Templates(large=True, held=True)
    points = about(hypothesis, PAYS)
    assert kept.lines(hypothesis, trial.scene, points[: PAYS - 1], "lateral", made) == [None] * (PAYS - 1)
    assert not built
    assert kept.lines(hypothesis, trial.scene, points[-1:], "lateral", made) != [None]  # asked for often enough by now
    assert len(built) == 2  # recorded, and checked farther off
    elsewhere = about(hypothesis, 1, nominal=1.0)
    assert kept.lines(hypothesis, trial.scene, elsewhere, "lateral", made) == [None]
    assert kept.lines(Hypothesis(hypothesis.factors), trial.scene, [np.zeros(2)] * PAYS, "lateral", made) == [None] * PAYS
    monkeypatch.setattr(templates, "KEPT_LARGE", 1)
    small = Templates(large=True, held=True)
    for nominal in (0.0, 1.0):
        small.lines(hypothesis, trial.scene, about(hypothesis, PAYS, nominal=nominal), "lateral", made)
    assert len(small._kept) == 1


@pytest.mark.parametrize("held", [True, False])
def test_a_law_whose_numbers_go_through_a_matrix_is_built_and_asked_for_once(trials: list[Trial], held: bool) -> None:
    [first, *_] = candidates(bench().scene, hm.HiddenModeSupport)
    hypothesis, trial = Hypothesis(factors("bearing_stiffness", "youngs_modulus"), first.starts[:1]), trials[0]
    built: list[Network] = []

    def made(network: Network) -> CompiledLine:
        built.append(network)
        return _compiled(network, trial)

    kept = Templates(large=True, held=held)
    assert kept.lines(hypothesis, trial.scene, about(hypothesis, PAYS), "lateral", made) == [None] * PAYS
    tried = len(built)
    assert tried > 0
    kept.lines(hypothesis, trial.scene, about(hypothesis, PAYS, nominal=1.0), "lateral", made)
    assert len(built) == tried


def test_beside_a_cause_whose_numbers_go_through_a_matrix_there_is_one_about_held_numbers(
    hypotheses: dict[type[hm.Effect], Hypothesis], trials: list[Trial]
) -> None:
    """A second cause is looked for beside a mass on springs too."""
    [first, *_] = candidates(bench().scene, hm.HiddenModeSupport)
    whirl, trial = hypotheses[hm.OilWhirl], trials[0]
    hypothesis = Hypothesis(whirl.factors, (*first.starts[:1], *whirl.added))
    own = whirl.size - whirl.nominal_size
    rng = np.random.default_rng(4)
    free = np.arange(hypothesis.size) >= hypothesis.size - own
    points = [hypothesis.clipped(hypothesis.start() + 0.2 * free * rng.standard_normal(hypothesis.size)) for _ in range(PAYS)]

    def made(network: Network) -> CompiledLine:
        return _compiled(network, trial)

    assert Templates(large=True).lines(hypothesis, trial.scene, points, "lateral", made) == [None] * PAYS
    lines = Templates(large=True, held=True).lines(hypothesis, trial.scene, points, "lateral", made)
    for z, line in zip(points, lines, strict=True):
        assert line is not None
        assert alike(line.program, made(hypothesis.scene(trial.scene, z, to_run=True).network()).program)


def test_lines_of_a_rotor_with_templates_are_those_without(
    hypotheses: dict[type[hm.Effect], Hypothesis], trials: list[Trial], monkeypatch: pytest.MonkeyPatch
) -> None:
    """All trials through one set of lines; residuals rest on nothing else."""
    hypothesis = hypotheses[hm.Rub]
    points = about(hypothesis, PAYS + 2)
    with_them = Lines(trials).at(hypothesis, points)
    monkeypatch.setattr(Templates, "of", lambda *_, **__: None)
    without = Lines(trials).at(hypothesis, points)
    for own, other in zip(with_them, without, strict=True):
        for a, b in zip(own[1:], other[1:], strict=True):
            assert a is not None
            assert b is not None
            assert alike(a.line.program, b.line.program)
            assert a.line.program.inputs == b.line.program.inputs
            assert a.angles == pytest.approx(b.angles, rel=1e-9, abs=1e-15)
