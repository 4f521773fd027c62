"""Parts of the search on their own: the mended Jacobian, what is left out, when a search ends."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Sequence

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import all_samples, second_cause
from hdrive_mbs.diagnosis import gather as gather_
from hdrive_mbs.diagnosis.all_samples import Last, on_all_samples
from hdrive_mbs.diagnosis.at_the_place import at_the_place
from hdrive_mbs.diagnosis.candidates import Candidate, candidates
from hdrive_mbs.diagnosis.choosing import beyond, enough, not_begun, passed_over, picked, spread_out
from hdrive_mbs.diagnosis.diagnose import strongest_first
from hdrive_mbs.diagnosis.differences import jacobian
from hdrive_mbs.diagnosis.fit import Fitted, fit, mend
from hdrive_mbs.diagnosis.from_the_best import bent, elsewhere, other_laws, unfinished
from hdrive_mbs.diagnosis.gather import ALIKE, SINGLES, close_laws, serious
from hdrive_mbs.diagnosis.ground import LIKELY, held, is_bent, screen_from
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.lines import Lines
from hdrive_mbs.diagnosis.located import Located, located
from hdrive_mbs.diagnosis.normal_equations import STRETCH, normal_equations
from hdrive_mbs.diagnosis.pairs import alone, contenders, moved
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.result import Cause, Place
from hdrive_mbs.diagnosis.screening import FAINTEST, Look, Screen, _leading, _promising
from hdrive_mbs.diagnosis.search import ENOUGH, Depth, Search, _Work, fit_nominal, is_inexact, search
from hdrive_mbs.diagnosis.second_cause import slight, wants_second
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.starts import Starts
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect, at_first, simplest, suspects
from hdrive_mbs.diagnosis.tasks import FIRST, RIVAL, Found, Task, proven, run_task, scored
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import judge
from hdrive_mbs.errors import AnalysisError
from models import rotor_bench
from tests.unit.diagnosis_cases import bench, fitted_pair, quiet, records

BENCH = bench()
NOT_LOOKED = Located(places=(), doubt="", forces=(), turned=())


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    """One record of the small drive bench, its parameters off by their tolerance."""
    return Simulator(BENCH.trials(quiet()[0]), 2.5e-4, 4)


def test_normal_equations_in_stretches_are_those_of_the_whole() -> None:
    """Of more samples than a stretch has and not a multiple of it; sums of 50,000 terms agree to their rounding."""
    rng = np.random.default_rng(4)
    columns, weights, residuals = rng.standard_normal((50_000, 3)), rng.uniform(0.1, 1.0, 50_000), rng.standard_normal(50_000)
    squares, slope = normal_equations(columns, weights, residuals)
    assert len(columns) % STRETCH != 0
    np.testing.assert_allclose(squares, np.einsum("ni,n,nj->ij", columns, weights, columns), rtol=1e-10, atol=1e-9)
    np.testing.assert_allclose(slope, np.einsum("ni,n,n->i", columns, weights, residuals), rtol=1e-10, atol=1e-9)


def test_a_jacobian_along_axes_is_the_same_in_stretches_of_any_length(simulator: Simulator, monkeypatch: pytest.MonkeyPatch) -> None:
    hypothesis = Hypothesis(factors_of(BENCH))
    fitted = fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=2)
    metric = fitted.curvature + np.diag(hypothesis.curvatures(fitted.z))
    whole = jacobian(simulator, hypothesis, fitted.z, fitted.residuals, metric)
    monkeypatch.setattr("hdrive_mbs.diagnosis.differences.STRETCH", 37)
    monkeypatch.setattr("hdrive_mbs.diagnosis.differences.AT_ONCE", 2)
    parts = jacobian(simulator, hypothesis, fitted.z, fitted.residuals, metric)
    np.testing.assert_allclose(parts, whole, rtol=1e-9, atol=1e-9 * np.abs(whole).max())


def test_a_mended_jacobian_gives_the_change_that_was_seen_and_leaves_what_lies_across_the_move() -> None:
    rng = np.random.default_rng(1)
    columns, change, move, scale = rng.normal(size=(30, 4)), rng.normal(size=30), rng.normal(size=4), rng.uniform(0.1, 9.0, 4)
    mended = columns.copy()
    mend(mended, change, move, scale)
    np.testing.assert_allclose(mended @ move, change, rtol=1e-12)
    across = rng.normal(size=4)
    across -= move * (across @ (scale * move)) / (move @ (scale * move))
    np.testing.assert_allclose(mended @ across, columns @ across, rtol=0.0, atol=1e-12)


def test_a_mended_jacobian_ends_where_one_of_differences_does(simulator: Simulator, monkeypatch: pytest.MonkeyPatch) -> None:
    hypothesis = Hypothesis(factors_of(BENCH))
    start = np.full(hypothesis.size, 0.8)
    with_mending = fit(simulator, hypothesis, start, share=1e-7)
    monkeypatch.setattr("hdrive_mbs.diagnosis.fit.WELL_PROMISED", (np.inf, np.inf))
    without = fit(simulator, hypothesis, start, share=1e-7)
    assert with_mending.converged
    assert without.converged
    assert with_mending.cost == pytest.approx(without.cost, abs=0.2)  # what ends a fit
    np.testing.assert_allclose(with_mending.curvature, without.curvature, rtol=0.02, atol=0.02 * without.curvature.max())


def test_the_curvature_is_that_of_differences_at_the_end(simulator: Simulator) -> None:
    hypothesis = Hypothesis(factors_of(BENCH))
    fitted = fit(simulator, hypothesis, np.full(hypothesis.size, 0.8), share=1e-7)
    columns = jacobian(simulator, hypothesis, fitted.z, fitted.residuals)
    weighted = columns * simulator.blocks.weights(fitted.residuals[simulator.fit])[:, None]
    np.testing.assert_allclose(np.diag(fitted.curvature), np.diag(weighted.T @ columns), rtol=0.02)


def test_a_verdict_counts_how_well_a_law_tells_what_its_fit_did_not_see(simulator: Simulator) -> None:
    """Of two laws whose fits are as good the one that tells more of the rest comes first, by its logarithm of the likelihood."""
    hypothesis = Hypothesis(factors_of(BENCH))
    base, fitted = (fit(simulator, hypothesis, np.full(hypothesis.size, value), steps=0) for value in (0.0, 0.5))
    unseen = fitted.residuals[simulator.held_out]
    assert len(unseen) > 100
    numbers = simulator._numbered()[simulator.held_out]
    squares = [float(np.mean(unseen[numbers == k] ** 2)) * np.count_nonzero(numbers == k) for k in np.unique(numbers)]
    counts = [int(np.count_nonzero(numbers == k)) for k in np.unique(numbers)]
    expected = sum(0.5 * (s if s <= n else n * (1.0 + math.log(s / n))) for s, n in zip(squares, counts, strict=True))
    assert fitted.misfit_held == pytest.approx(expected)
    suspect = Suspect(("drag", "load"), "ViscousDrag", (hypothesis,), (hypothesis,))
    better = dataclasses.replace(fitted, misfit_held=fitted.misfit_held - 60.0)
    told = [proven(Found(suspect, item), base).log_odds for item in (fitted, better)]
    assert told[1] - told[0] == pytest.approx(60.0)
    assert told[0] - scored(Found(suspect, fitted), base).log_odds == pytest.approx(base.misfit_held - fitted.misfit_held)


def test_what_cannot_be_run_from_where_it_begins_is_left_out(simulator: Simulator) -> None:
    hypothesis = Hypothesis(factors_of(BENCH), (Added(hm.ViscousDrag(coefficient=900.0), "motor", "drag"),))
    # the rate drag/inertia times the step is 200; what steps of this method follow ends at 2.8
    task = Task(hypothesis, hypothesis.start(), None, 3, 1e-4)
    with pytest.raises(AnalysisError, match="cannot be simulated"):
        fit(simulator, hypothesis, hypothesis.start())
    assert run_task(simulator, task) is None


def test_more_is_left_over_beside_a_strong_cause(simulator: Simulator) -> None:
    hypothesis = Hypothesis(factors_of(BENCH))
    fitted = fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0)
    assert enough(dataclasses.replace(fitted, chi_fit=1.5), ENOUGH) == ENOUGH
    assert ENOUGH < enough(dataclasses.replace(fitted, chi_fit=1e4), ENOUGH) < 2.0


def test_a_first_look_begins_where_a_change_hardly_changes_anything_and_takes_every_decisive_start() -> None:
    scene = rotor_bench.bench().scene
    changes = {item.effect.change for one in candidates(scene, [hm.SupportStiffnessChange]) for item in one.first}  # type: ignore[attr-defined]
    assert changes == {1e-4}
    for one in candidates(scene, [hm.HiddenModeSupport]):
        assert {item.effect.natural_frequency for item in one.first} == set(hm.HiddenModeSupport.starts["natural_frequency"])  # type: ignore[attr-defined]


def test_held_parameters_stay_near_the_data_sheet(simulator: Simulator) -> None:
    """The drag that is missing would bend them farther."""
    missing = Simulator(BENCH.trials(records((hm.CoulombStribeckFriction(coulomb=8.0), "load"))[0]), 2.5e-4, 4)
    hypothesis = Hypothesis(factors_of(BENCH))
    free = fit(missing, hypothesis, np.zeros(hypothesis.size), steps=25)
    near = held(missing, free)
    assert np.max(np.abs(free.z)) > 2.5
    assert np.max(np.abs(near.z)) == pytest.approx(2.0)
    assert free.cost < near.cost < fit(missing, hypothesis, np.zeros(hypothesis.size), steps=0).cost
    assert near.hypothesis is free.hypothesis


def test_a_model_is_bent_where_a_parameter_that_nobody_suspects_is_far_off(simulator: Simulator) -> None:
    factors = factors_of(BENCH)
    plain, loose = Hypothesis(factors), Hypothesis(factors, (), {factors[0].name: 10.0})
    for hypothesis, deviations, bent_ in ((plain, 1.9, False), (plain, 2.1, True), (plain, -2.1, True), (loose, 2.1, False)):
        start = hypothesis.start(np.eye(len(factors))[0] * deviations)
        assert is_bent(fit(simulator, hypothesis, start, steps=0)) is bent_


@pytest.mark.parametrize(
    ("off", "taken", "grounds"),
    [
        (3.0, 0.5, ["held"]),  # takes half of what there is to take
        (3.0, 0.1, ["held", "as it is"]),
        (1.0, 0.1, ["as it is"]),  # nothing is bent
    ],
)
def test_a_second_cause_is_looked_for_from_held_parameters_first_where_the_first_has_bent_them(
    simulator: Simulator, monkeypatch: pytest.MonkeyPatch, off: float, taken: float, grounds: list[str]
) -> None:
    hypothesis = Hypothesis(factors_of(BENCH))
    noise = 0.5 * int(np.count_nonzero(simulator.fit))
    base = fit(simulator, hypothesis, hypothesis.start(np.eye(hypothesis.size)[0] * off), steps=0)
    base = dataclasses.replace(base, chi_fit=2.0, chi_held=2.0, cost=2.0 * noise)
    better = dataclasses.replace(base, cost=base.cost - taken * noise, chi_fit=1.01, chi_held=1.01, curvature=np.eye(hypothesis.size))
    seen: list[str] = []

    def from_ground(self: _Work, model: Fitted, base_: Fitted, everything: Sequence[Suspect], known: Sequence[Found] = ()) -> object:
        assert base_ is base
        seen.append("as it is" if model is base else "held")
        assert np.all(np.abs(model.z) <= (off if model is base else LIKELY))
        return [Found(everything[0], better)], []

    monkeypatch.setattr(_Work, "from_ground", from_ground)
    monkeypatch.setattr("hdrive_mbs.diagnosis.search.unfinished", lambda found: [])
    tried = candidates(BENCH.scene, [hm.QuadraticDrag])
    with Team(1, None) as team:
        search(team, simulator, base, {}, tried, depth=Depth(laws=1))
    assert seen == grounds


@pytest.mark.parametrize(("leaves", "asked"), [(1.15, [("friction", "load")]), (1.01, [])])
def test_other_laws_of_a_label_that_is_the_best_only_in_the_end_are_tried_too(
    simulator: Simulator, monkeypatch: pytest.MonkeyPatch, leaves: float, asked: list[tuple[str, str]]
) -> None:
    """A law stood for friction at the motor; moved to the load it leaves less, and what it leaves there another law may take."""
    hypothesis = Hypothesis(factors_of(BENCH))
    base = dataclasses.replace(fit(simulator, hypothesis, hypothesis.start(), steps=0), chi_fit=1e4, chi_held=1e4, cost=9e4)
    tried = candidates(BENCH.scene, [hm.DahlFriction, hm.CoulombStribeckFriction])
    everything = {(item.law, item.label[1]): item for item in suspects(hypothesis, {}, tried)}
    told: list[tuple[str, str]] = []

    def found(place: str, cost: float, chi: float) -> Found:
        suspect = everything["DahlFriction", place]
        curvature = np.eye(suspect.all[0].size)
        fitted = dataclasses.replace(
            base,
            hypothesis=suspect.all[0],
            z=suspect.all[0].start(),
            cost=cost,
            chi_fit=chi,
            chi_held=chi,
            typical=chi,
            curvature=curvature,
        )
        return Found(suspect, fitted)

    def fitted(self: _Work, tasks: Sequence[tuple[Suspect, Task]], words: str) -> list[Found]:
        if words == "trying other laws there":
            told.extend(suspect.label for suspect, _ in tasks)
            assert {suspect.law for suspect, _ in tasks} <= {"CoulombStribeckFriction"}
        return [found("load", 100.0, leaves)] if words == "trying the best elsewhere" else []

    monkeypatch.setattr(_Work, "from_ground", lambda *_, **__: ([found("motor", 200.0, 1.2)], []))
    monkeypatch.setattr(_Work, "fitted", fitted)
    monkeypatch.setattr(_Work, "other_ways", lambda self, known, *_: known)
    with Team(1, None) as team:
        search(team, simulator, base, {}, tried)
    assert sorted(set(told)) == asked


@pytest.mark.parametrize("order", [(0, 1), (1, 0)], ids=["first", "second"])
def test_each_cause_of_a_pair_is_tried_without_the_other(simulator: Simulator, order: tuple[int, int]) -> None:
    """The load's friction is missing, first or second in a pair beside a drag at the motor that is none, and its own fit had stopped."""
    missing = Simulator(BENCH.trials(records((hm.CoulombStribeckFriction(coulomb=4.0), "load"))[0]), 2.5e-4, 4)
    factors = factors_of(BENCH)
    tried = candidates(BENCH.scene, [hm.CoulombStribeckFriction, hm.QuadraticDrag])
    everything = suspects(Hypothesis(factors), {}, tried)
    [true] = [item for item in everything if item.label == ("friction", "load")]
    [false] = [item for item in everything if item.label == ("quadratic_drag", "motor")]
    one, two = (((true, false))[k] for k in order)
    both = Hypothesis(factors, (*one.first[0].added, *two.first[0].added))
    pair = Found(two, fit(missing, both, both.start(), steps=12))
    stopped = Hypothesis(factors, one.first[0].added)
    first = fit(missing, stopped, stopped.start(), steps=1)
    with Team(1) as team:
        found = {item.suspect.label: item.fitted for item in alone(team, missing, pair, everything, Found(one, first))}
        [other] = alone(team, missing, pair, everything, Found(one, first), known=[two.label])
    assert set(found) == {one.label, two.label}
    assert other.suspect.label == one.label
    single = found[true.label]
    assert len(single.hypothesis.added) == 1
    assert single.chi_fit == pytest.approx(pair.fitted.chi_fit, rel=0.02)
    assert single.chi_fit < first.chi_fit / 1.1


def test_a_mass_on_a_spring_beside_a_wrong_inertia_is_tried_as_a_load_of_which_a_part_swings() -> None:
    """The pair is nearly that, and the load holds more than its tolerance alone: a search from the law's own start does not come there."""
    planted = hm.FlexibleInertia(share=0.4, natural_frequency=250.0, damping_ratio=0.05)
    missing = Simulator(BENCH.trials(records((planted, "load"))[0]), 2.5e-4, 4)
    factors = factors_of(BENCH)
    tried = candidates(BENCH.scene, [hm.HiddenMode, hm.FlexibleInertia, hm.QuadraticDrag])
    everything = suspects(Hypothesis(factors), {"load_inertia": ["load_inertia"]}, tried)
    law = Added(hm.HiddenMode(inertia=0.3, natural_frequency=250.0, damping_ratio=0.05), "load", "hidden_mode")
    both = Hypothesis(factors, (law,), {"load_inertia": 10.0})
    [suspect] = [item for item in everything if item.law == "HiddenMode" and item.label[1] == "load"]
    pair = Found(suspect, fit(missing, both, both.start(), steps=12))
    first = fit(missing, Hypothesis(factors), Hypothesis(factors).start(), steps=2)
    with Team(1) as team:
        found = {item.suspect.law: item for item in alone(team, missing, pair, everything, Found(suspect, first))}
    assert set(found) == {"HiddenMode", "FlexibleInertia", "parameter"}
    right = found["FlexibleInertia"].fitted
    assert right.chi_fit < 1.1 < found["HiddenMode"].fitted.chi_fit
    assert right.hypothesis.rescaled(right.z)[0].added[-1].effect.share == pytest.approx(0.4, rel=0.05)
    assert not right.hypothesis.loose


@pytest.mark.parametrize(("drop", "odds", "kind"), [(0.5e-4, 40.0, "none"), (2e-3, 40.0, "effect"), (2e-3, 12.0, "none")])
def test_an_effect_needs_odds_and_a_gap_that_it_closes(simulator: Simulator, drop: float, odds: float, kind: str) -> None:
    """Long records give high odds to what the steps of an integration leave."""
    hypothesis = Hypothesis(factors_of(BENCH), (Added(hm.ViscousDrag(coefficient=0.01), "load", "drag"),))
    fitted = dataclasses.replace(fit(simulator, hypothesis, hypothesis.start(), steps=0), chi_fit=0.9996 - drop, chi_held=1.0018 - drop)
    found = Found(Suspect(("viscous_drag", "load"), "ViscousDrag", (hypothesis,), (hypothesis,)), fitted, odds)
    claim = judge(math.sqrt(0.9996 * 1.0018), [found])
    assert claim.kind == kind
    assert max(claim.probabilities, key=lambda label: claim.probabilities[label]) == (
        ("none", "") if kind == "none" else found.suspect.label
    )


def test_no_second_cause_is_claimed_beside_one_that_leaves_noise(simulator: Simulator) -> None:
    """Half of the logarithm of 1.00004 is gone with any second parameter."""
    factors = factors_of(BENCH)
    first, second = suspects(Hypothesis(factors), {name: (name,) for name in ("load_inertia", "load_viscous")}, [])
    both = Hypothesis(factors, (), {**first.first[0].loose, **second.first[0].loose})
    for leaves, parts in ((1.00004, 1), (1.5, 2)):
        one, two = (
            dataclasses.replace(fit(simulator, item, item.start(), steps=0), chi_fit=chi, chi_held=chi)
            for item, chi in ((first.first[0], leaves), (both, 0.9988))
        )
        claim = judge(68000.0, [Found(first, one, 266_096.0)], [Found(second, two, 266_193.0)])
        assert claim.fit is not None
        assert len(claim.fit.fitted.hypothesis.loose) == parts


@pytest.mark.parametrize(("seen", "unseen", "kind"), [(0.9996, 1.0199, "effect"), (1.0085, 1.011, "unknown"), (1.0199, 0.9996, "effect")])
def test_what_is_left_of_a_faint_gap_has_to_show_in_both_parts_of_the_samples(
    simulator: Simulator, seen: float, unseen: float, kind: str
) -> None:
    """A quarter of the samples scatters by half a per cent: what stands above noise there alone may be noise."""
    hypothesis = Hypothesis(factors_of(BENCH), (Added(hm.ViscousDrag(coefficient=0.01), "load", "drag"),))
    fitted = dataclasses.replace(fit(simulator, hypothesis, hypothesis.start(), steps=0), chi_fit=seen, chi_held=unseen)
    claim = judge(1.0133, [Found(Suspect(("viscous_drag", "load"), "ViscousDrag", (hypothesis,), (hypothesis,)), fitted, 320.0)])
    assert claim.kind == kind


@pytest.mark.parametrize(
    ("null", "leaves", "kind"),
    [
        (1.022, 1.013, "unknown"),  # two fifths of a faint gap: a part of what something else does
        (1.0104, 1.0071, "effect"),  # half of what stands above what noise may leave
        (1.022, 1.009, "effect"),
        (1.0075, 1.0039, "effect"),  # what is left may be noise
        (1.14, 1.10, "unknown"),  # not faint
        (1.14, 1.06, "effect"),
        (1.437, 1.426, "unknown"),
        (1.662, 1.276, "effect"),
    ],
)
def test_of_a_faint_gap_too_an_effect_has_to_take_half(simulator: Simulator, null: float, leaves: float, kind: str) -> None:
    hypothesis = Hypothesis(factors_of(BENCH), (Added(hm.ViscousDrag(coefficient=0.01), "load", "drag"),))
    fitted = dataclasses.replace(fit(simulator, hypothesis, hypothesis.start(), steps=0), chi_fit=leaves, chi_held=leaves)
    claim = judge(null, [Found(Suspect(("viscous_drag", "load"), "ViscousDrag", (hypothesis,), (hypothesis,)), fitted, 400.0)])
    assert claim.kind == kind
    assert (max(claim.probabilities, key=lambda label: claim.probabilities[label])[0] == "unknown") == (kind == "unknown")


@pytest.mark.parametrize(
    ("single", "pair", "kind", "causes"),
    [
        (370.0, None, "effect", 1),  # 0.97 of a large gap, though less than half of its logarithm
        (7000.0, None, "unknown", 0),
        (7000.0, 1900.0, "unknown", 0),  # two laws together bend far
        (370.0, 100.0, "effect", 1),  # no second cause for what a law leaves that is not exact
    ],
)
def test_most_of_a_large_gap_is_enough_for_a_single_cause(
    simulator: Simulator, single: float, pair: float | None, kind: str, causes: int
) -> None:
    factors = factors_of(BENCH)
    [second] = suspects(Hypothesis(factors), {"load_inertia": ("load_inertia",)}, [])
    drag = Hypothesis(factors, (Added(hm.ViscousDrag(coefficient=0.01), "load", "drag"),))
    both = Hypothesis(factors, drag.added, second.first[0].loose)
    one, two = (
        dataclasses.replace(fit(simulator, item, item.start(), steps=0), chi_fit=chi, chi_held=chi)
        for item, chi in ((drag, single), (both, pair or 1.0))
    )
    effect = Found(Suspect(("viscous_drag", "load"), "ViscousDrag", (drag,), (drag,)), one, 1e5)
    claim = judge(14000.0, [effect], [] if pair is None else [Found(second, two, 1.05e5)])
    assert claim.kind == kind
    claimed = [label for label, chance in claim.probabilities.items() if label[0] not in ("none", "unknown") and chance > 0.4]
    assert len(claimed) == causes


def test_a_parameter_is_preferred_to_an_effect_that_does_hardly_better(simulator: Simulator) -> None:
    factors = factors_of(BENCH)
    [inertia] = suspects(Hypothesis(factors), {"load_inertia": ("load_inertia",)}, [])
    mode = Hypothesis(factors, (Added(hm.HiddenMode(inertia=0.1, natural_frequency=2e3), "load", "mode"),))
    hidden = Suspect(("hidden_mode", "load"), "HiddenMode", (mode,), (mode,))
    fits = [
        dataclasses.replace(fit(simulator, item, item.start(), steps=0), chi_fit=1.0, chi_held=1.0) for item in (mode, inertia.first[0])
    ]
    for better, kind in ((1.0003, "parameter"), (1.03, "effect")):
        claim = judge(50.0, [Found(hidden, fits[0], better * 1e5), Found(inertia, fits[1], 1e5)])
        assert claim.kind == kind
        assert max(claim.probabilities, key=lambda label: claim.probabilities[label])[0] == (
            "parameter" if kind == "parameter" else "hidden_mode"
        )


def test_a_parameter_that_the_nominal_model_has_bent_is_suspected_whatever_it_shows(simulator: Simulator) -> None:
    hypothesis = Hypothesis(factors_of(BENCH))
    z = np.zeros(hypothesis.size)
    z[[item.name for item in hypothesis.factors].index("load_inertia")] = -4.2
    base = dataclasses.replace(fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0), z=z)
    everything = suspects(
        hypothesis, {name: (name,) for name in ("load_inertia", "load_viscous")}, candidates(BENCH.scene, [hm.ViscousDrag])
    )
    [(suspect, task)] = bent(base, everything)
    assert suspect.label == ("parameter", "load_inertia")
    np.testing.assert_allclose(task.hypothesis.nominal_part(task.z), z)
    assert list(bent(dataclasses.replace(base, z=0.7 * z), everything)) == []


def test_two_causes_that_are_claimed_together_share_one_probability(simulator: Simulator) -> None:
    """Also where they are parameters, which a hypothesis has let loose and not added."""
    factors = factors_of(BENCH)
    everything = suspects(Hypothesis(factors), {"load_inertia": ("load_inertia",), "drag": ("load_viscous",)}, [])
    first, second = everything
    both = Hypothesis(factors, (), {**first.first[0].loose, **second.first[0].loose})
    fits = {
        name: dataclasses.replace(fit(simulator, hypothesis, hypothesis.start(), steps=0), chi_fit=left_, chi_held=left_)
        for name, hypothesis, left_ in (("first", first.first[0], 4.0), ("second", second.first[0], 6.0), ("both", both, 1.0))
    }
    singles = [Found(first, fits["first"], 900.0), Found(second, fits["second"], 300.0)]
    claim = judge(20.0, singles, [Found(second, fits["both"], 1500.0)])
    assert claim.fit is not None
    assert claim.fit.fitted is fits["both"]
    chances = claim.probabilities
    assert chances["parameter", "load_inertia"] == chances["parameter", "drag"] > 0.9


def test_a_size_of_zero_runs_on_the_same_machine_code_as_any_other(simulator: Simulator) -> None:
    added = Added(hm.KinematicError(amplitude=1e-5, order=2.0), "gear", "error")
    hypothesis = Hypothesis(factors_of(BENCH), (added,))
    nothing = hypothesis.start()
    nothing[len(hypothesis.factors) :] = 0.0
    along = nothing.copy()
    along[len(hypothesis.factors)] = 1.0
    [[one, other]] = Lines(simulator.trials).at(hypothesis, [nothing, along])
    assert one is not None
    assert other is not None
    assert one.line.structure is other.line.structure
    assert hypothesis.values(nothing)["error.amplitude"] == 0.0
    [bare] = simulator.residuals(Hypothesis(factors_of(BENCH)), [nothing[: len(hypothesis.factors)]])
    [zero] = simulator.residuals(hypothesis, [nothing])
    assert bare is not None
    assert zero is not None
    np.testing.assert_allclose(zero, bare, rtol=0.0, atol=1e-6)


def test_a_family_is_led_by_the_law_that_says_so() -> None:
    everything = suspects(Hypothesis(()), {}, candidates(rotor_bench.bench().scene, [hm.DynamicUnbalance, hm.RotorUnbalance, hm.ShaftBow]))
    assert {suspect.law for suspect in simplest(everything)} == {"RotorUnbalance", "ShaftBow"}


def test_a_family_gets_two_places_at_most_and_a_parameter_is_a_family_of_its_own() -> None:
    empty = Hypothesis(())
    look = Look(empty, np.zeros(0), 0.0, np.zeros(0), empty)
    labels = [("torque", "a"), ("torque", "b"), ("torque", "c"), ("crack", "shaft"), ("torque", "d"), ("rub", "a")]
    parameters = [("parameter", name) for name in ("mass", "stiffness", "damping")]
    looks = [(Suspect(label, "Law", (empty,), (empty,)), look) for label in labels]
    looks += [(Suspect(label, PARAMETER, (empty,), (empty,)), look) for label in parameters]
    assert [suspect.label for suspect, _ in spread_out(looks)] == [
        ("torque", "a"), ("torque", "b"), ("crack", "shaft"), ("rub", "a"), *parameters,
    ]  # fmt: skip


def test_a_look_also_runs_its_step_with_shapes_held_back_by_what_the_strength_grows(simulator: Simulator) -> None:
    """A shape's column is that of the strength at the start: the step of both overshoots in the shape."""
    base = fit(simulator, Hypothesis(factors_of(BENCH)), np.zeros(len(factors_of(BENCH))), steps=0)
    screen = screen_from(simulator, base)
    mode = Added(hm.HiddenMode(inertia=1e-5, natural_frequency=300.0, damping_ratio=0.05), "load", "mode")
    hypothesis = Hypothesis(factors_of(BENCH), (mode,))
    origin = hypothesis.start()
    step = np.arange(1.0, hypothesis.size + 1.0)
    first = len(hypothesis.factors)
    step[first] = 4.0 * origin[first]  # to five times the inertia
    [held_back] = screen._held_back(hypothesis, origin, step)
    np.testing.assert_allclose(held_back[: first + 1], step[: first + 1])
    np.testing.assert_allclose(held_back[first + 1 :], step[first + 1 :] / 5.0)
    step[first] = -0.5 * origin[first]
    assert list(screen._held_back(hypothesis, origin, step)) == []
    assert list(screen._held_back(base.hypothesis, base.z, base.z)) == []  # nothing was added


def test_of_many_starts_with_a_phase_those_that_promise_most_are_looked_at_whole() -> None:
    """An error of order 2 among starts at eight orders: found as from its own start, with fewer runs than all."""
    both = Simulator(BENCH.trials(records((hm.KinematicError(amplitude=2e-4, order=2.0, phase=0.4), "gear"))[0]), 2.5e-4, 4)
    factors = factors_of(BENCH)
    orders = (1.0, 3.0, 4.0, 5.0, 2.0, 6.0, 7.0, 8.0)
    starts = [Hypothesis(factors, (Added(hm.KinematicError(amplitude=1e-5, order=n), "gear", "error"),)) for n in orders]
    base = fit(both, Hypothesis(factors), np.zeros(len(factors)), steps=0)
    screen = screen_from(both, base)
    looks, runs = [], []
    for asked in (starts, *([start] for start in starts)):
        before = both.runs
        looks.append(screen.look(asked))
        runs.append(both.runs - before)
    of_all, own = looks[0], looks[1 + orders.index(2.0)]
    assert of_all is not None
    assert own is not None
    assert of_all.start is own.start
    assert of_all.cost == pytest.approx(own.cost, rel=1e-9)
    assert all(look is None or own.cost <= look.cost for look in looks[1:])
    whole = sum(runs[1:])
    assert runs[0] < whole


def test_what_adds_to_an_amplitude_counts_for_what_it_promises(monkeypatch: pytest.MonkeyPatch) -> None:
    """An error of the output in records that begin at zero: alone its amplitude would move their beginnings too."""
    amplitude, phase = 3e-4, 1.9
    put_in = hm.KinematicError(amplitude=amplitude, order=2.0, phase=phase, follows="flexspline", offset=-amplitude * np.sin(phase))
    both = Simulator(BENCH.trials(records((put_in, "gear"))[0]), 2.5e-4, 4)
    factors = factors_of(BENCH)
    base = fit(both, Hypothesis(factors), np.zeros(len(factors)), steps=25)
    screen, honest = screen_from(both, base), Screen._promise
    start = Hypothesis(factors, (Added(hm.KinematicError(amplitude=1e-6, order=2.0, follows="flexspline"), "gear", "error"),))
    orders = (1.0, 2.0, 3.0, 4.0)
    starts = [Hypothesis(factors, (Added(start.added[0].effect.replacing(order=n), "gear", "error"),)) for n in orders]
    first = len(factors)
    assert _leading(start, first) == [first, first + 1]
    assert _promising(start, first) == [first, first + 1, first + 2]
    assert "error.offset" in start.unknowns[-1].values([0.0])
    told: dict[float, float] = {}

    def promise(self: Screen, group: Starts, k: int, along: Sequence[int]) -> float:
        told[group.starts[k].added[-1].effect.order] = found = honest(self, group, k, along)
        return found

    monkeypatch.setattr(Screen, "_promise", promise)
    screen.look(starts)
    with_it = dict(told)
    monkeypatch.setattr(hm.KinematicError, "additive", ())
    screen.look(starts)
    assert sorted(with_it) == sorted(told) == list(orders)
    assert with_it[2.0] > 1.3 * told[2.0]
    assert with_it[2.0] > 0.9 * max(with_it.values())


def test_starts_that_promise_more_than_they_bring_hide_no_other_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three orders beyond all that is there to gain come first, and the right one is looked at as it promises more than they bring."""
    both = Simulator(BENCH.trials(records((hm.KinematicError(amplitude=2e-4, order=2.0, phase=0.4), "gear"))[0]), 2.5e-4, 4)
    factors = factors_of(BENCH)
    orders = (1.0, 3.0, 4.0, 5.0, 2.0, 6.0, 7.0, 8.0)
    starts = [Hypothesis(factors, (Added(hm.KinematicError(amplitude=1e-5, order=n), "gear", "error"),)) for n in orders]
    base = fit(both, Hypothesis(factors), np.zeros(len(factors)), steps=25)
    screen, honest = screen_from(both, base), Screen._promise

    def promise(self: Screen, group: Starts, k: int, along: Sequence[int]) -> float:
        kept = honest(self, group, k, along)
        return base.cost + kept if group.starts[k].added[-1].effect.order > 5.0 else kept

    monkeypatch.setattr(Screen, "_promise", promise)
    look, own = screen.look(starts), screen.look([starts[orders.index(2.0)]])
    assert look is not None
    assert own is not None
    assert look.start is own.start
    assert look.cost == pytest.approx(own.cost, rel=1e-9)


def test_a_start_that_changes_more_than_the_gap_begins_at_a_part_of_its_size(simulator: Simulator) -> None:
    """Far above what is there a step leads nowhere; a start that the gap has room for stays as it is."""
    factors = factors_of(BENCH)
    base = fit(simulator, Hypothesis(factors), np.zeros(len(factors)), steps=0)
    before = simulator.blocks.cost(base.residuals[simulator.fit])
    gap = before - 0.5 * np.count_nonzero(simulator.fit)
    assert gap > FAINTEST
    sizes = (5e-3, 1e-7)
    starts = [Hypothesis(factors, (Added(hm.KinematicError(amplitude=size, order=2.0), "gear", "error"),)) for size in sizes]
    screen = screen_from(simulator, base)
    origins = [screen._start(start, starts[0]) for start in starts]
    first = len(factors)

    def cost(origin: np.ndarray) -> float:
        [residuals] = simulator.residuals(starts[0], [origin])
        assert residuals is not None
        return simulator.blocks.cost(residuals[simulator.fit]) - before

    assert cost(origins[0]) > gap > cost(origins[1])
    group = Starts(starts, [origin.copy() for origin in origins], base)
    screen._begin_fainter(group)
    fainter, same = group.origins
    assert 0.0 < cost(fainter) < gap
    assert np.linalg.norm(fainter[first : first + 2]) < 0.5 * np.linalg.norm(origins[0][first : first + 2])
    np.testing.assert_array_equal(same, origins[1])


def test_a_first_look_finds_a_hidden_mode_whose_frequency_no_start_has() -> None:
    missing = Simulator(
        BENCH.trials(records((hm.HiddenMode(inertia=0.02, natural_frequency=310.0, damping_ratio=0.05), "load"))[0]), 2.5e-4, 4
    )
    hypothesis = Hypothesis(factors_of(BENCH))
    base = fit(missing, hypothesis, np.zeros(hypothesis.size), steps=25)
    [suspect] = [item for item in suspects(hypothesis, {}, candidates(BENCH.scene, [hm.HiddenMode])) if item.label[1] == "load"]
    look = screen_from(missing, base).look(suspect.first)
    assert look is not None
    best = fit(missing, look.hypothesis, look.z, steps=25)
    planted = Hypothesis(
        factors_of(BENCH), (Added(hm.HiddenMode(inertia=0.02, natural_frequency=310.0, damping_ratio=0.05), "load", "mode"),)
    )
    truth = fit(missing, planted, planted.start(), steps=25)
    assert look.cost < base.cost - 0.5 * (base.cost - truth.cost)
    # three standard deviations of one coordinate: this record leaves the frequency itself open by a fifth
    assert best.cost < truth.cost + 0.5 * 3.0**2 < base.cost


def test_a_first_look_finds_a_hidden_mode_from_a_start_that_is_a_third_off() -> None:
    missing = Simulator(
        BENCH.trials(records((hm.HiddenMode(inertia=0.05, natural_frequency=310.0, damping_ratio=0.05), "load"))[0]), 2.5e-4, 4
    )
    factors = factors_of(BENCH)
    base = fit(missing, Hypothesis(factors), np.zeros(len(factors)), steps=25)
    off = hm.HiddenMode(inertia=1e-5, natural_frequency=400.0, damping_ratio=0.05, hardening=0.1, square_damping=0.01)
    start = Hypothesis(factors, (Added(off, "load", "mode"),))
    look = screen_from(missing, base).look((start,))
    assert look is not None
    best = fit(missing, look.hypothesis, look.z, steps=25)
    # the step as it is, and parts of it, take 54 % of what there is to gain; held back it takes 97 %
    assert base.cost - look.cost > 0.9 * (base.cost - best.cost)
    assert base.cost - best.cost > 100.0


def with_ripple(**fields: float) -> tuple[Simulator, Fitted, tuple[Hypothesis, ...]]:
    """A record with a ripple of the motor, the refitted model without it, and the starts of a first look at such a ripple."""
    simulator = Simulator(BENCH.trials(records((hm.TorqueRipple(**fields), "motor"))[0]), 2.5e-4, 4)
    hypothesis = Hypothesis(factors_of(BENCH))
    [suspect] = suspects(hypothesis, {}, candidates(BENCH.scene, [hm.TorqueRipple]))
    return simulator, fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=25), suspect.first


def test_a_first_look_finds_a_ripple_whether_or_not_it_grows_with_the_torque() -> None:
    """Both parts share a phase, and one that grows with the torque, however small, spoils the column of the phase of one that does not."""
    simulator, base, starts = with_ripple(amplitude=0.05, order=6.0, phase=1.9, second_amplitude=0.0125, second_phase=0.6)
    growing = [start for start in starts if start.added[-1].effect.relative > 0.0]
    assert 0 < len(growing) < len(starts)
    screen = screen_from(simulator, base)
    look, without = screen.look(starts), screen.look(growing)
    assert look is not None
    assert without is not None
    assert look.hypothesis.added[-1].effect.order == 6.0
    best = fit(simulator, look.hypothesis, look.z, steps=25)
    assert base.cost - look.cost > 0.95 * (base.cost - best.cost)
    assert base.cost - without.cost < 0.7 * (base.cost - best.cost)


def test_orders_that_come_close_in_a_look_are_looked_at_once_more(monkeypatch: pytest.MonkeyPatch) -> None:
    """No fit goes from one order to another: what a first step of five coordinates takes for order 42 is a ripple of order 6."""
    fields = {"amplitude": 0.05, "relative": 0.05, "order": 6.0, "phase": 1.9, "second_amplitude": 0.0125, "second_phase": 0.6}
    simulator, base, starts = with_ripple(**fields)
    starts = tuple(start for start in starts if start.added[-1].effect.relative == 0.0)
    screen = screen_from(simulator, base)
    look = screen.look(starts)
    monkeypatch.setattr("hdrive_mbs.diagnosis.screening.RIVAL", math.inf)
    once = screen.look(starts)
    assert look is not None
    assert once is not None
    assert [item.hypothesis.added[-1].effect.order for item in (look, once)] == [6.0, 42.0]
    assert base.cost - look.cost > 3.0 * (base.cost - once.cost)


def test_other_parameters_are_tried_in_place_of_the_one_that_did_best(simulator: Simulator) -> None:
    """With what it had bent brought back, and given up where they do not come down to it; a cause of the base keeps its values."""
    factors = factors_of(BENCH)
    first, second, *_ = (item.name for item in factors)
    cause = Added(hm.QuadraticDrag(coefficient=1e-3), "load", "drag")
    plain = Hypothesis(factors, (cause,))
    base = fit(simulator, plain, plain.start(np.full(len(factors), 1.5)) + 0.25, steps=0)
    everything = suspects(plain, {first: [first], second: [second]}, candidates(BENCH.scene, [hm.CoulombStribeckFriction]))
    one, other = (item for item in everything if item.law == "parameter")
    z = one.all[0].start(np.full(len(factors), -2.0))
    best = Found(one, fit(simulator, one.all[0], z, steps=0))
    [(suspect, task)] = elsewhere(best, base, everything, simulator)
    assert suspect is other
    assert task.hypothesis is other.all[0]
    assert task.beat == pytest.approx(best.fitted.cost + RIVAL)
    loose = [item.name == second for item in factors]
    nominal = task.hypothesis.nominal_part(task.z)
    assert nominal[np.array(loose)] == pytest.approx(best.fitted.hypothesis.nominal_part(best.fitted.z)[np.array(loose)])
    assert not np.any(nominal[~np.array(loose)])
    np.testing.assert_array_equal(task.z[len(factors) :], base.z[len(factors) :])


def test_other_laws_of_the_best_label_begin_with_its_values(simulator: Simulator) -> None:
    everything = suspects(
        Hypothesis(factors_of(BENCH)), {}, candidates(BENCH.scene, [hm.DahlFriction, hm.PreslidingFriction, hm.CoulombStribeckFriction])
    )
    hypothesis = Hypothesis(factors_of(BENCH), (Added(hm.DahlFriction(coulomb=0.7, presliding=2e-3, exponent=1.6), "load", "drag"),))
    fitted = dataclasses.replace(fit(simulator, hypothesis, hypothesis.start(), steps=0), chi_fit=2.0, converged=False)
    dahl = Found(Suspect(("friction", "load"), "DahlFriction", (hypothesis,), (hypothesis,)), fitted)
    base = left_with(simulator, cost=1.0, chi_fit=5.0)
    asked = other_laws([dahl], base, everything)
    assert {suspect.label for suspect, _ in asked} == {("friction", "load")}
    assert {suspect.law for suspect, _ in asked} == {"PreslidingFriction", "CoulombStribeckFriction"}
    for suspect, task in asked:
        values = {path.split(".")[1]: value for path, value in task.hypothesis.values(task.z).items() if "friction" in path}
        assert values["coulomb"] == pytest.approx(0.7)
        if suspect.law == "PreslidingFriction":
            assert values["presliding"] == pytest.approx(2e-3)
            assert values["exponent"] == pytest.approx(1.6)
    # what the best one does not have comes from the next one
    smooth = Hypothesis(factors_of(BENCH), (Added(hm.CoulombStribeckFriction(coulomb=0.6, smoothing_speed=0.05), "load", "drag"),))
    second = Found(
        Suspect(("friction", "load"), "CoulombStribeckFriction", (smooth,), (smooth,)), fit(simulator, smooth, smooth.start(), steps=0)
    )
    presliding, *_ = (task for suspect, task in other_laws([second, dahl], base, everything) if suspect.law == "PreslidingFriction")
    effect = presliding.hypothesis.added[-1].effect
    assert (effect.coulomb, effect.presliding) == (pytest.approx(0.6), pytest.approx(2e-3))
    parameter = dataclasses.replace(dahl, suspect=dataclasses.replace(dahl.suspect, law="parameter"))
    assert other_laws([parameter], base, everything) == []
    assert [item.hypothesis for _, item in unfinished([dahl])] == [hypothesis]

    def ended(**how: float) -> list[bool]:
        """Of what is asked for once it has ended, whether with patience."""
        again = dataclasses.replace(fitted, converged=True, **how)
        return [task.patient for _, task in unfinished([dataclasses.replace(dahl, fitted=again)])]

    assert ended(chi_held=2.0) == [True]
    assert ended(chi_held=2.0, patient=True) == []
    assert ended(chi_fit=1.0, chi_held=1.0) == []


def test_a_finer_law_waits_until_the_others_of_its_label_leave_something(simulator: Simulator) -> None:
    def tried(*kinds: type[hm.Effect]) -> list[Suspect]:
        return suspects(Hypothesis(factors_of(BENCH)), {"inertia": ["load"]}, candidates(BENCH.scene, kinds))

    everything = tried(hm.DahlFriction, hm.SpreadSlipFriction)
    assert {item.law for item in at_first(everything)} == {"DahlFriction", "parameter"}
    alone = tried(hm.SpreadSlipFriction)
    assert at_first(alone) == alone  # what a user asks for alone is looked at
    hypothesis = Hypothesis(factors_of(BENCH), (Added(hm.DahlFriction(coulomb=0.7, presliding=2e-3), "load", "drag"),))
    fitted = fit(simulator, hypothesis, hypothesis.start(), steps=0)
    dahl = Found(Suspect(("friction", "load"), "DahlFriction", (hypothesis,), (hypothesis,)), fitted)
    asked = other_laws([dahl], left_with(simulator, cost=1.0, chi_fit=5.0), everything)
    assert {suspect.law for suspect, _ in asked} == {"SpreadSlipFriction"}
    assert [task.hypothesis.added[-1].effect.presliding for _, task in asked] == pytest.approx([2e-3] * len(asked))


def test_a_fit_beside_a_leading_one_is_given_up_early_where_it_is_hopeless() -> None:
    missing = Simulator(BENCH.trials(records((hm.CoulombStribeckFriction(coulomb=8.0), "load"))[0]), 2.5e-4, 4)
    hypothesis = Hypothesis(factors_of(BENCH), (Added(hm.QuadraticDrag(coefficient=1e-7), "motor", "drag"),))
    task = Task(hypothesis, hypothesis.start(), None, 8, 1e-9)
    full = run_task(missing, task)
    assert full is not None
    assert full.steps > FIRST
    assert full.chi_fit > 20.0  # the load's friction is no drag of the motor
    hopeless = run_task(missing, dataclasses.replace(task, leading=1.0))
    far = run_task(missing, dataclasses.replace(task, leading=0.2 * full.chi_fit))
    assert hopeless is not None
    assert far is not None
    assert hopeless.steps == FIRST
    assert far.cost == pytest.approx(full.cost, rel=0.02)


def test_what_a_search_chooses_among_counts_in_the_prior() -> None:
    one = Added(hm.KinematicError(amplitude=1e-5, order=2.0), "gear", "error")
    assert one.choices == 10  # five orders of either flange
    assert Added(hm.ViscousDrag(coefficient=0.1), "load", "drag").choices == 1
    assert Added(hm.LuGreFriction(coulomb=0.1, stiffness=30.0), "load", "drag").choices == 1  # its starts are searched on
    free = Hypothesis((), (one,))
    z = free.start()
    assert free.log_prior(z) == pytest.approx(
        sum(unknown.log_prior(z[part].tolist()) for unknown, part in zip(free.unknowns, free.slices, strict=True)) - math.log(10.0)
    )


def test_a_law_whose_every_start_was_looked_at_is_not_looked_at_again(simulator: Simulator, monkeypatch: pytest.MonkeyPatch) -> None:
    """And the search finds what it finds where all are looked at twice."""
    tried = candidates(BENCH.scene, [hm.ViscousDrag, hm.QuadraticDrag, hm.CoulombStribeckFriction, hm.DahlFriction])
    base = fit_nominal(simulator, factors_of(BENCH))
    asked: list[tuple[str, int]] = []
    look = Screen.look

    def counted(screen: Screen, starts: Sequence[Hypothesis]) -> Look | None:
        asked.append((starts[0].label, len(starts)))
        return look(screen, starts)

    monkeypatch.setattr(Screen, "look", counted)
    with Team(1) as team:
        found = search(team, simulator, base, {}, tried)
        once, asked = asked, []
        monkeypatch.setattr(Suspect, "is_looked_at_whole", False)
        again = search(team, simulator, base, {}, tried)
    assert len(set(once)) == len(once)
    assert {label for label, _ in once} == {label for label, _ in asked}
    assert len(asked) > len(once)
    assert [(item.suspect.label, item.suspect.law) for item in found.found] == [
        (item.suspect.label, item.suspect.law) for item in again.found
    ]
    assert [item.log_odds for item in found.found] == pytest.approx([item.log_odds for item in again.found])


def left_with(simulator: Simulator, *, cost: float, chi_fit: float) -> Fitted:
    """A fitted model that is said to leave so much."""
    hypothesis = Hypothesis(factors_of(BENCH))
    return dataclasses.replace(fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0), cost=cost, chi_fit=chi_fit, chi_held=chi_fit)


@pytest.mark.parametrize(
    ("leading", "other", "hopeless"),
    [(1.5, 16.0, True), (1.5, 14.0, False), (50.0, 5000.0, False)],  # nothing is hopeless beside one that is not near itself
)
def test_a_law_is_hopeless_beside_one_that_is_near(simulator: Simulator, leading: float, other: float, hopeless: bool) -> None:
    assert beyond(left_with(simulator, cost=1.0, chi_fit=other), left_with(simulator, cost=1.0, chi_fit=leading)) is hopeless


@pytest.mark.parametrize(
    ("before", "after", "held", "gain", "inexact"),
    [
        (5.0, 2.0, 2.0, 1e4, True),  # leaves much
        (5.0, 1.05, 1.05, 1e4, False),
        (5.0, 1.05, 2.0, 1e4, True),  # much of what no fit saw
        (1.013, 1.0095, 1.0095, 100.0, True),  # of a faint gap more than half, in logarithms above what noise may leave
        (1.013, 1.0077, 1.0077, 100.0, False),
        (1.013, 1.0095, 1.0095, 10.0, False),  # what does not show has no other law
        (1.013, 1.0035, 1.0035, 100.0, False),  # noise
    ],
)
def test_other_laws_are_tried_where_the_best_would_not_be_claimed(
    simulator: Simulator, before: float, after: float, held: float, gain: float, inexact: bool
) -> None:
    base = left_with(simulator, cost=1e5, chi_fit=before)
    hypothesis = Hypothesis(factors_of(BENCH), (Added(hm.QuadraticDrag(coefficient=1e-7), "motor", "drag"),))
    fitted = dataclasses.replace(fit(simulator, hypothesis, hypothesis.start(), steps=0), chi_fit=after, chi_held=held)
    # log odds are the gain but for what the one number that is searched costs, some ten at most
    fitted = dataclasses.replace(fitted, cost=1e5 - gain)
    found = Found(Suspect(("drag", "motor"), "QuadraticDrag", (hypothesis,), (hypothesis,)), fitted)
    assert is_inexact([found], base) is inexact
    assert not is_inexact([], base)


@pytest.mark.parametrize(
    ("best", "other", "close"), [(110.0, 106.0, True), (110.0, 104.0, False), (5000.0, 4910.0, True), (-3.0, -4.0, True)]
)
def test_a_law_that_the_search_can_hardly_tell_from_the_best_goes_on_to_all_samples(
    simulator: Simulator, best: float, other: float, close: bool
) -> None:
    hypothesis = Hypothesis(factors_of(BENCH))
    fitted = fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0)

    def law(name: str, at: str, odds: float) -> Found:
        return Found(Suspect(("friction", at), name, (hypothesis,), (hypothesis,)), fitted, odds)

    found = [
        law("A", "motor", best),
        law("A", "load", best - 0.1),
        law("A", "motor", best - 0.2),
        law("B", "motor", other),
        law("C", "motor", other - 0.1),
    ]
    assert [item.suspect.law for item in close_laws(found)] == (["B"] if close else [])
    assert close_laws([]) == ()


@pytest.mark.parametrize(
    ("cost", "odds", "leaves", "wants"),
    [
        (60_000.0, 900.0, 1.5, True),  # 9 % of the 10,000 above noise, 1.5 % of all
        (60_000.0, 400.0, 1.5, False),  # explains next to nothing: a second would be another first
        (60_000.0, 9_900.0, 1.05, True),  # leaves little
        (60_000.0, 9_900.0, 1.02, False),  # leaves nothing
        (49_000.0, 5.0, 1.5, True),  # less than noise: any gain is a share
    ],
)
def test_a_second_cause_is_asked_for_where_the_first_explains_something_and_leaves_something(
    simulator: Simulator, cost: float, odds: float, leaves: float, wants: bool
) -> None:
    null = left_with(simulator, cost=cost, chi_fit=1.6)
    hypothesis = Hypothesis(factors_of(BENCH), (Added(hm.ViscousDrag(coefficient=0.01), "load", "drag"),))
    found = Found(
        Suspect(("viscous_drag", "load"), "ViscousDrag", (hypothesis,), (hypothesis,)),
        left_with(simulator, cost=cost - odds, chi_fit=leaves),
        odds,
    )
    assert wants_second(null, found, samples=100_000) is wants


@pytest.mark.parametrize(("samples", "gap", "least"), [(100_000, 2.0, 1.03), (5000, 2.0, 1.08), (500, 2.0, 1.1), (500, 400.0, 400.0**0.03)])
def test_what_is_little_and_still_not_noise_depends_on_how_many_samples_there_are(
    simulator: Simulator, samples: int, gap: float, least: float
) -> None:
    assert slight(left_with(simulator, cost=1e5, chi_fit=gap), samples) == pytest.approx(least)


@pytest.fixture
def near(simulator: Simulator) -> Fitted:
    hypothesis = Hypothesis(factors_of(BENCH))
    return dataclasses.replace(fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0), cost=100.0, chi_fit=1.2)


def test_what_little_tells_apart_is_fitted_alike_on_all_samples(
    simulator: Simulator, near: Fitted, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Twenty of log-likelihood may be what a few steps more bring."""
    asked: list[Task] = []

    def run(fine: Simulator, task: Task) -> Fitted:
        asked.append(task)
        return dataclasses.replace(near, hypothesis=task.hypothesis)

    monkeypatch.setattr(all_samples, "run_task", run)
    found = [near, dataclasses.replace(near, cost=110.0), dataclasses.replace(near, cost=140.0, converged=True)]
    far = dataclasses.replace(near, cost=1e5, chi_fit=90.0)
    with Team(1) as team:
        last = on_all_samples(team, simulator, far, found, NOT_LOOKED, lambda done, total: None)
    given, best, rival, other, _ = asked
    assert given.steps == 0
    assert (best.steps, best.hops) == (rival.steps, rival.hops)
    assert other.steps < rival.steps
    assert other.hops == 0
    assert last.place is NOT_LOOKED


def test_the_same_effect_at_another_place_is_fitted_to_its_end(simulator: Simulator, near: Fitted, monkeypatch: pytest.MonkeyPatch) -> None:
    """Friction of a brake on a shaft was put to the wave generator beside it: at the brake its fit had stopped halfway, 200 behind."""
    asked: list[Task] = []

    def run(fine: Simulator, task: Task) -> Fitted:
        asked.append(task)
        return dataclasses.replace(near, hypothesis=task.hypothesis)

    monkeypatch.setattr(all_samples, "run_task", run)

    def at(effect: hm.Effect, place: str, cost: float, *, chi_fit: float = 1.2, converged: bool = False) -> Fitted:
        hypothesis = Hypothesis(factors_of(BENCH), (Added(effect, place, "cause"),))
        return dataclasses.replace(near, hypothesis=hypothesis, cost=cost, chi_fit=chi_fit, converged=converged)

    friction, drag = hm.CoulombStribeckFriction(coulomb=0.1), hm.ViscousDrag(coefficient=0.01)
    found = [
        at(friction, "load", 100.0, converged=True),
        at(friction, "motor", 300.0),
        at(friction, "motor", 300.0, converged=True),
        at(drag, "motor", 300.0),
        at(friction, "motor", 900.0, chi_fit=5.0),
    ]
    with Team(1) as team:
        on_all_samples(team, simulator, dataclasses.replace(near, cost=1e5, chi_fit=90.0), found, NOT_LOOKED, lambda done, total: None)
    best, elsewhere, *others = ((task.steps, task.hops) for task in asked[1:-1])
    assert elsewhere == best
    assert all(steps < best[0] and hops == 0 for steps, hops in others)


def test_of_causes_claimed_together_the_one_that_explains_most_alone_comes_first(near: Fitted) -> None:
    def single(label: tuple[str, str], odds: float) -> Found:
        return Found(Suspect(label, "law", (near.hypothesis,), (near.hypothesis,)), near, odds)

    singles = [single(("looseness", "bearing_1"), 5.0), single(("looseness", "bearing_1"), 80.0), single(("bow", "shaft"), 40.0)]
    claimed = [
        Cause(
            effect=effect,
            at=at,
            kind="force",
            law="law",
            probability=0.9,
            log_odds=90.0,
            fit=1.0,
            held_out=1.0,
            signature="",
            parameters=(),
        )
        for effect, at in (("friction", "rotor"), ("bow", "shaft"), ("looseness", "bearing_1"))
    ]
    ordered = [cause.effect for cause in strongest_first(claimed, singles)]
    assert ordered == ["looseness", "bow", "friction"]


def test_a_gap_whose_place_cannot_be_looked_for_says_why(simulator: Simulator, near: Fitted, monkeypatch: pytest.MonkeyPatch) -> None:
    def raises(fine: Simulator, about: Fitted) -> None:
        raise AnalysisError("The model has no steady state.")

    monkeypatch.setattr("hdrive_mbs.diagnosis.located.Localiser", raises)
    found = located(simulator, near)
    assert found.places == found.forces == found.turned == ()
    assert found.doubt == "not looked for: The model has no steady state."
    with Team(1) as team:
        assert at_the_place(team, simulator, near, found, [], lambda stage, done, total: None) == ()


def test_what_swings_unseen_at_the_place_of_the_gap_begins_at_frequencies_close_together(
    simulator: Simulator, near: Fitted, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A pipe on a housing that swings at 284 rad/s did not show in looks that began at 200 and 400 rad/s; nor one at 890 in ours to 800."""
    found = Located(places=(Place(at="bearing_1.housing", probability=0.9, gain=1e3, share=0.9),), doubt="", forces=(), turned=())
    tried = candidates(rotor_bench.bench().scene, [hm.HiddenModeSupport, hm.SupportStiffnessChange, hm.GroundVibration, hm.BallPass])
    asked: list[Candidate] = []

    def keep(team: Team, coarse: Simulator, base: Fitted, groups: object, there: list[Candidate], **more: object) -> Search:
        asked.extend(there)
        return Search(base, ())

    monkeypatch.setattr("hdrive_mbs.diagnosis.at_the_place.search", keep)
    with Team(1) as team:
        assert at_the_place(team, simulator, near, found, tried, lambda stage, done, total: None) == ()
    assert {(item.kind, item.at) for item in asked} == {(hm.HiddenModeSupport, "bearing_1"), (hm.GroundVibration, "bearing_1")}
    [hidden] = [item for item in asked if item.kind is hm.HiddenModeSupport]
    [plain] = [item for item in tried if item.kind is hm.HiddenModeSupport and item.at == "bearing_1"]
    for starts, given in ((hidden.first, plain.first), (hidden.starts, plain.starts)):
        rates = sorted({item.effect.natural_frequency for item in starts})  # type: ignore[attr-defined]
        assert (rates[0], rates[-1]) == (pytest.approx(100.0), pytest.approx(1500.0))  # all that the field says is typical
        assert max(b / a for a, b in itertools.pairwise(rates)) < 1.2
        ratios = {item.effect.ratio for item in given}  # type: ignore[attr-defined]
        assert len(starts) == len(rates) * len(ratios)
        assert {item.effect.ratio for item in starts} == ratios  # type: ignore[attr-defined]


def drags(*places: str) -> Hypothesis:
    """The small bench with a drag at each place."""
    return Hypothesis(factors_of(BENCH), tuple(Added(hm.QuadraticDrag(coefficient=1e-3), place, f"drag_{place}") for place in places))


def suspected(place: str) -> Suspect:
    return Suspect(("quadratic_drag", place), "QuadraticDrag", (drags(place),), (drags(place),))


@pytest.mark.parametrize(("behind", "tied"), [(2.0, (("quadratic_drag", "motor"),)), (50.0, ())])
def test_of_two_pairs_that_cannot_be_told_apart_the_part_that_differs_is_tied(
    near: Fitted, behind: float, tied: tuple[tuple[str, str], ...]
) -> None:
    single = Found(suspected("load"), dataclasses.replace(near, hypothesis=drags("load"), chi_fit=30.0, chi_held=30.0), 1000.0)
    leaves = {"chi_fit": 1.0, "chi_held": 1.0}
    best, other = (
        Found(suspected(place), dataclasses.replace(near, hypothesis=drags("load", place), **leaves), odds)
        for place, odds in (("wave_generator", 5000.0), ("motor", 5000.0 - behind))
    )
    claim = judge(900.0, [single], [best, other])
    assert claim.fit is best
    assert claim.tied == tied


def test_a_cause_of_a_pair_is_tried_at_its_other_places() -> None:
    """Drag of the load and friction of the motor, of a pair that has them the other way round for one."""
    planted = ((hm.QuadraticDrag(coefficient=0.3), "load"), (hm.CoulombStribeckFriction(coulomb=0.05), "motor"))
    both = Simulator(BENCH.trials(records(*planted)[0]), 2.5e-4, 4)
    factors, tried = factors_of(BENCH), candidates(BENCH.scene, [hm.CoulombStribeckFriction, hm.QuadraticDrag])
    found = [
        Added(hm.QuadraticDrag(coefficient=0.3), "load", "drag"),
        Added(hm.CoulombStribeckFriction(coulomb=2.5), "load", "friction"),  # 50 times the motor's, as the gear reduces 50 : 1
    ]
    for first, second in (found, found[::-1]):
        pair = fitted_pair(both, factors, first, second)
        with Team(1) as team:
            others = moved(team, both, [pair], tried)
        best = min(others, key=lambda item: item.fitted.cost)
        assert best.fitted.hypothesis.labels == {("quadratic_drag", "load"), ("friction", "motor")}
        assert best.fitted.cost < pair.fitted.cost - 100.0
        assert best.suspect.label == best.fitted.hypothesis.added[-1].label  # the second cause keeps its name, wherever it is
        places = {item.fitted.hypothesis.labels for item in others}
        assert pair.fitted.hypothesis.labels not in places
        assert len(places) == len(others)
        with Team(1) as team:
            more = moved(team, both, [pair, *others], tried)  # from the best of them, and nothing that was tried
        assert more
        assert not {item.fitted.hypothesis.labels for item in more} & {pair.fitted.hypothesis.labels, *places}


def test_pairs_that_lie_close_together_are_fitted_to_the_end_before_one_is_chosen(
    simulator: Simulator, near: Fitted, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A few joint steps leave a pair of a thousand within ten of another one; the worse of them may end as the better."""
    first = Found(suspected("load"), dataclasses.replace(near, hypothesis=drags("load"), cost=2000.0))
    begun = {("load", "motor"): 1000.0, ("load", "wave_generator"): 1008.0, ("motor", "wave_generator"): 1300.0}
    pairs = [Found(suspected(places[1]), dataclasses.replace(near, hypothesis=drags(*places), cost=cost)) for places, cost in begun.items()]
    again = dataclasses.replace(pairs[0], fitted=dataclasses.replace(pairs[0].fitted, cost=1001.0))
    asked: list[Hypothesis] = []

    def run(coarse: Simulator, task: Task) -> Fitted:
        asked.append(task.hypothesis)
        ends = {"drag_motor": 995.0, "drag_wave_generator": 990.0}
        return dataclasses.replace(near, hypothesis=task.hypothesis, cost=ends[task.hypothesis.added[-1].name])

    monkeypatch.setattr("hdrive_mbs.diagnosis.pairs.run_task", run)
    with Team(1) as team:
        found = contenders(team, simulator, [*pairs, again], first)
    assert [item.suspect.label[1] for item in found] == ["wave_generator", "motor"]
    assert [[added.at for added in item.added] for item in asked] == [["load", "motor"], ["load", "wave_generator"]]


@pytest.mark.parametrize(
    ("leaves", "above", "again"), [(1.6, 5000.0, True), (1.05, 5000.0, True), (1.0, 5000.0, False), (1.6, 5990.0, False)]
)
def test_the_first_of_two_causes_is_looked_for_again_beside_the_second_where_both_leave_something(
    simulator: Simulator, near: Fitted, monkeypatch: pytest.MonkeyPatch, leaves: float, above: float, again: bool
) -> None:
    """The best single cause stands at the load while the second is missing; beside that one, at the motor, it is the wave generator's.

    Not where the two leave noise alone, and not where the second takes next to nothing.
    """

    noise = 0.5 * np.count_nonzero(simulator.fit)

    def found(chi: float, above: float, *places: str) -> Found:
        fitted = dataclasses.replace(near, hypothesis=drags(*places), chi_fit=chi, chi_held=chi, cost=noise + above)
        return Found(suspected(places[-1]), fitted, 1e4)

    null = dataclasses.replace(near, chi_fit=4.0, chi_held=4.0, cost=noise + 9000.0)
    second, first_alone = found(3.6, 8500.0, "motor"), found(2.0, 6000.0, "load")
    pairs = {"load": found(leaves, above, "load", "motor"), "motor": found(1.0, 4000.0, "motor", "wave_generator")}
    asked: list[str] = []
    ends: list[tuple[Found, ...]] = []  # pairs of which causes are moved: fitted to the end

    def search(team: Team, coarse: Simulator, base: Fitted, *more: object, **how: object) -> Search:
        asked.append(base.hypothesis.added[-1].at)
        return Search(base, (pairs[asked[-1]],))

    for name, made in {
        "search": search,
        "joined": lambda *some: [],
        "swapped": lambda *some: [],
        "recast": lambda *some: [],
        "with_other_laws": lambda *some: [],
        "moved": lambda team, coarse, some, tried: ends.append(some) or [],
        "both_moved": lambda *some: [],
        "alone": lambda *some: [] if some[5:] else [second, first_alone],
        "contenders": lambda team, coarse, some, first: tuple(sorted(some, key=lambda item: item.fitted.cost))[:1],
    }.items():
        monkeypatch.setattr(f"hdrive_mbs.diagnosis.second_cause.{name}", made)
    single = Search(null, (found(2.0, 6000.0, "load"),))
    with Team(1) as team:
        _, best, others = second_cause.second_cause(team, simulator, null, {}, [], single, (), (), lambda *said: None)
    assert asked == (["load", "motor"] if again else ["load"])
    assert best == (pairs["motor" if again else "load"],)
    assert ends == [best]
    assert others[0] is second


@pytest.mark.parametrize(("alone_leaves", "kept"), [(1.02, 0), (1.5, 1)])
def test_a_pair_is_given_up_where_its_second_cause_does_without_the_first(
    simulator: Simulator, near: Fitted, monkeypatch: pytest.MonkeyPatch, alone_leaves: float, kept: int
) -> None:
    """A wrong stiffness came out beside backlash alone at first; a pair with it takes the rounded corners of the machine besides."""

    def found(chi: float, odds: float, *places: str) -> Found:
        cost = 0.5 * np.count_nonzero(simulator.fit) * chi
        return Found(
            suspected(places[-1]), dataclasses.replace(near, hypothesis=drags(*places), chi_fit=chi, chi_held=chi, cost=cost), log_odds=odds
        )

    null = dataclasses.replace(near, chi_fit=70.0, chi_held=70.0, cost=9e6)
    pair = found(1.003, 5200.0, "load", "motor")
    asked: list[Fitted] = []

    def on_all(team: Team, fine: Simulator, base: Fitted, fits: list[Fitted], *more: object) -> Last:
        asked.extend(fits)
        return Last(base, base, tuple(fits), NOT_LOOKED)

    for name, made in {
        "fit_nominal": lambda coarse, factors: null,
        "search": lambda *some, **how: Search(null, (found(3.4, 4400.0, "load"),)),
        "_there": lambda *some: (),
        "second_cause": lambda *some: (None, (pair,), (found(alone_leaves, 0.0, "motor"),)),
        **dict.fromkeys(("scored", "proven"), lambda item, base: dataclasses.replace(item, log_odds=base.cost - item.fitted.cost)),
        "on_all_samples": on_all,
    }.items():
        monkeypatch.setattr(f"hdrive_mbs.diagnosis.gather.{name}", made)
    with Team(1) as team:
        evidence = gather_.gather(simulator, simulator, factors_of(BENCH), {}, [], team)
    assert len(evidence.pairs) == kept
    assert (pair.fitted in asked) == bool(kept)
    assert evidence.single.found[0].suspect.label == ("quadratic_drag", "motor")


def test_every_label_gets_its_best_law_before_any_gets_its_second() -> None:
    empty = Hypothesis(())
    look = Look(empty, np.zeros(0), 0.0, np.zeros(0), empty)
    laws = [("crack", "Steep"), ("crack", "Open"), ("crack", "Phased"), ("gain", "Probe"), ("gain", "Sensor"), ("bearing", "Stiffness")]
    looks = [(Suspect((family, "there"), law, (empty,), (empty,)), look) for family, law in laws]
    assert [suspect.law for suspect, _ in picked(looks, laws=2)] == ["Steep", "Probe", "Stiffness", "Open", "Sensor"]
    assert [suspect.law for suspect, _ in picked(looks, laws=1)] == ["Steep", "Probe", "Stiffness"]


def test_further_laws_of_the_best_label_that_got_no_steps_are_named(near: Fitted) -> None:
    empty = Hypothesis(())
    look = Look(empty, np.zeros(0), 0.0, np.zeros(0), empty)
    laws = [("crack", "Steep"), ("crack", "Open"), ("gain", "Probe"), ("crack", "Phased"), ("gain", "Sensor")]
    looks = [(Suspect((family, "there"), law, (empty,), (empty,)), look) for family, law in laws]
    crack, gain = Found(looks[0][0], near), Found(looks[2][0], near)
    assert [suspect.law for suspect, _ in not_begun([crack, gain], looks, [looks[0], looks[2]])] == ["Open", "Phased"]
    assert [suspect.law for suspect, _ in not_begun([gain, crack], looks, [looks[0], looks[2]])] == ["Sensor"]
    assert not_begun([crack], looks, looks) == []


def test_other_places_of_the_best_families_that_looks_passed_over_are_named(near: Fitted) -> None:
    """A drag of the load that the refitted model hides looked worse there than at the two places that were taken."""
    looks = [(suspected(place), look_at(place)) for place in ("motor", "wave_generator", "load")]
    inertia = Suspect(("parameter", "load_inertia"), PARAMETER, (drags(),), (drags(),))
    found = [Found(inertia, near), Found(suspected("motor"), near)]
    taken = [("quadratic_drag", "motor"), ("quadratic_drag", "wave_generator"), ("parameter", "load_inertia")]
    assert passed_over(found, [*looks, (inertia, look_at("motor"))], taken) == [looks[2]]


def look_at(place: str) -> Look:
    return Look(drags(place), np.zeros(1), 1.0, np.zeros(1), drags(place))


@pytest.mark.parametrize(("tied", "kept"), [(1, SINGLES), (SINGLES + 1, SINGLES + 1), (ALIKE + 2, ALIKE)])
def test_places_that_the_search_cannot_tell_apart_all_go_on_to_all_samples(simulator: Simulator, tied: int, kept: int) -> None:
    hypothesis = Hypothesis(factors_of(BENCH))
    fitted = fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0)
    odds = [50.0 - 0.01 * k if k < tied else 10.0 - k for k in range(ALIKE + 4)]
    labels = [Found(Suspect(("drag", f"place {k}"), "A", (hypothesis,), (hypothesis,)), fitted, some) for k, some in enumerate(odds)]
    assert serious(labels) == tuple(labels[:kept])
    assert serious([]) == ()


def test_a_place_that_fits_better_than_the_best_goes_on_to_all_samples_whatever_its_log_odds(simulator: Simulator) -> None:
    hypothesis = Hypothesis(factors_of(BENCH))
    fitted = fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0)
    better = dataclasses.replace(fitted, chi_fit=0.99 * fitted.chi_fit)
    fits = [fitted, fitted, fitted, fitted, better, fitted]
    labels = [Found(Suspect(("drag", f"place {k}"), "A", (hypothesis,), (hypothesis,)), item, -7.0 * k) for k, item in enumerate(fits)]
    assert serious(labels) == (*labels[:SINGLES], labels[4])
