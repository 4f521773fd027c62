"""Baselines: what simpler methods answer on the same cases."""

from __future__ import annotations

import json
import time
from pathlib import Path

import numpy as np

from benchmarks.withheld.answer import answer_of
from benchmarks.withheld.finding import Claimed, Finding
from benchmarks.withheld.methods import Solved, bench_of, records_of
from benchmarks.withheld.names import Label, names_of
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.evidence import log_evidence
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import EVERY, factors_of
from hdrive_mbs.diagnosis.screening import Look, Screen
from hdrive_mbs.diagnosis.simulator import Simulator, chi_square
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.diagnosis.suspects import LOOSE, Suspect, suspects
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.verdict import ODDS

FOLLOWED, STEPS = 4, 10
"""Laws that the fit without joint parameters follows to the end, and steps that each may take."""


def no_refit(bench: str, folder: Path) -> Solved:
    """Nominal parameters held at the data sheet, the effect alone fitted: evidence against the nominal model as given.

    A parameter is suspected alone, with all others held.  No second cause, no "unknown".
    """
    start = time.monotonic()
    known = bench_of(bench)
    trials = [trial for record in records_of(folder) for trial in known.trials(record)]
    factors = factors_of(known)
    step = suitable_step(trials, factors)
    coarse = Simulator(trials, step, EVERY)
    base = fit(coarse, Hypothesis(factors=()), np.zeros(0), steps=0)
    screen = Screen(coarse, base, np.zeros((int(coarse.fit.sum()), 0)))
    looked: list[tuple[Suspect, Look | Fitted]] = []
    for suspect in suspects(base.hypothesis, {}, candidates(trials[0].scene)):
        look = screen.look(suspect.first)
        if look is not None:
            looked.append((suspect, look))
    for group, names in known.groups.items():
        own = tuple(factor for factor in factors if factor.name in names)
        hypothesis = Hypothesis(own, (), dict.fromkeys(names, LOOSE))
        begun = fit(coarse, hypothesis, hypothesis.start(), steps=1, begin=base.residuals)
        looked.append((Suspect(("parameter", group), "parameter", (hypothesis,), (hypothesis,)), begun))
    looked.sort(key=lambda pair: pair[1].cost)
    ends = []
    for suspect, begun_at in looked[:FOLLOWED]:
        ended = fit(coarse, begun_at.hypothesis, begun_at.z, steps=STEPS, begin=begun_at.residuals)
        ends.append(Found(suspect, ended, log_evidence(ended) + base.cost))
    ends.sort(key=lambda item: -item.log_odds)
    return _claimed(bench, folder, ends, Simulator(trials, step), time.monotonic() - start)


def _claimed(bench: str, folder: Path, ends: list[Found], fine: Simulator, seconds: float) -> Solved:
    """The best of these fits as an answer, its gap on all samples."""
    names = names_of(bench)
    given = fit(fine, Hypothesis(factors=()), np.zeros(0), steps=0)
    gap = {"nominal": given.chi_held**0.5, "refit": given.chi_held**0.5, "effect": given.chi_held**0.5, "floor": 1.0}
    if not ends or ends[0].log_odds < ODDS:
        return Solved(answer=answer_of(folder.name, Finding(verdict="none", ranking={("none", ""): 1.0}, gap=gap, seconds=seconds), names))
    best = ends[0].fitted
    residuals = fine.residuals(best.hypothesis, [best.z])[0]
    if residuals is not None:
        gap["effect"] = chi_square(residuals, fine.held_out) ** 0.5
    weights = np.exp(np.clip([item.log_odds - ends[0].log_odds for item in ends], -50.0, 0.0))
    ranking: dict[Label, float] = {}
    for item, weight in zip(ends, weights / weights.sum(), strict=True):
        ranking[item.suspect.label] = ranking.get(item.suspect.label, 0.0) + float(weight)
    claimed = (Claimed(label=ends[0].suspect.label),)
    finding = Finding(verdict="effect", claimed=claimed, ranking=ranking, gap=gap, seconds=seconds)
    return Solved(answer=answer_of(folder.name, finding, names))


def training(bench: str, folder: Path, raw: Path | None = None) -> Solved:
    """Joint refit, then the single cause with the least misfit of the fitted samples: no evidence, no held-out, never "none".

    It takes the fits of the diagnosis itself, from its raw figures.
    """
    if raw is None:
        raise ValueError("the method training takes its fits from the raw figures of the diagnosis: give --raw answers.raw.")
    figures = json.loads((raw / f"{folder.name}.json").read_text(encoding="utf-8"))
    fits = figures["singles"]
    best = min(fits, key=lambda item: item["misfit"])
    label = (best["label"][0], best["label"][1])
    gap = {
        "nominal": figures["nominal"]["held"] ** 0.5,
        "refit": figures["null"]["held"] ** 0.5,
        "effect": best["held"] ** 0.5,
        "floor": 1.0,
    }
    finding = Finding(verdict="effect", claimed=(Claimed(label=label),), ranking={label: 1.0}, gap=gap, seconds=figures.get("seconds", 0.0))
    return Solved(answer=answer_of(folder.name, finding, names_of(bench)))


def chance(bench: str, folder: Path) -> Solved:
    """An answer drawn blindly: "none" and "unknown" as often as each single name."""
    names = names_of(bench)
    rng = np.random.default_rng(sum(ord(letter) * 31**k for k, letter in enumerate(folder.name)))
    effects = sorted({effect for effect, _ in names.causes.values()})
    share = 1.0 / (len(effects) + 2)
    drawn = [*effects, "none", "unknown"][rng.integers(len(effects) + 2)]
    labels: list[Label] = [label for label, (effect, _) in names.causes.items() if effect == drawn]
    ranking: dict[Label, float] = {("none", ""): share, ("unknown", ""): share}
    for label, (effect, _) in names.causes.items():
        ranking[label] = share / sum(other == effect for other, _ in names.causes.values())
    claimed = (Claimed(label=labels[rng.integers(len(labels))]),) if labels else ()
    verdict = drawn if drawn in ("none", "unknown") else "effect"
    return Solved(answer=answer_of(folder.name, Finding(verdict=verdict, claimed=claimed, ranking=ranking), names))
