"""The whole diagnosis: from a bench and its records to an answer."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidates import Candidate, candidates
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.search import Found, Label, Search, Task, fit_nominal, run_task, search
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.effects.effect import Effect

Report = Callable[[str, int, int], None]


@dataclass(frozen=True, eq=False)
class Evidence:
    """All fits of a case, from which the answer is drawn.

    coarse, fine : records with every few samples, and with all
    nominal, null : the model as given and refitted, on all samples
    single : what one cause explains;  pair : what a second one explains besides the best first, if that left something
    final : best single and best pair, on all samples, with their log odds against the null
    """

    fine: Simulator
    nominal: Fitted
    null: Fitted
    single: Search
    pair: Search | None
    final: tuple[Found, ...]


EVERY = 4
"""Samples from one to the next that the search compares; the last fits take all."""
LEFT = 1.03
"""Mean square left by the best single cause above which a second one is looked for."""


def factors_of(bench: Bench) -> tuple[Factor, ...]:
    """The bench's uncertain parameters as unknowns."""
    found = []
    for name, item in bench.knowledge.items():
        nominal = dict(zip(item.paths, bench.nominal(name), strict=True))
        found.append(Factor(path=item.paths[0], name=name, nominal=nominal, sigma=item.sigma))
    return tuple(found)


def gather(
    trials: Sequence[Trial],
    factors: Sequence[Factor],
    groups: Mapping[str, Sequence[str]],
    tried: Sequence[Candidate],
    team: Team,
    *,
    step: float,
    report: Report | None = None,
) -> Evidence:
    """Fit the nominal model, single causes and, where these leave something, pairs."""
    said = report or (lambda stage, done, total: None)
    coarse, fine = Simulator(trials, step, EVERY), Simulator(trials, step)
    said("fitting the nominal model", 0, 1)
    null = fit_nominal(coarse, factors)
    single = search(team, coarse, null, groups, tried, report=said)
    pair = None
    best = single.found[0] if single.found else None
    if best is not None and best.log_odds > 0.0 and best.fitted.chi_fit > LEFT:
        pair = search(team, coarse, best.fitted, groups, tried, report=lambda stage, k, n: said(f"second cause: {stage}", k, n))
    serious = [item for item in single.labels[:3]]
    if pair is not None and pair.found:
        serious.append(pair.found[0])
    origin = null.z * 0.0
    tasks = [Task(null.hypothesis, origin, None, 0, 1.0), Task(null.hypothesis, null.z, None, 6, 1e-5)]
    tasks += [Task(item.fitted.hypothesis, item.fitted.z, None, 6, 1e-5) for item in serious]
    fits = team.map(run_task, fine, tasks, partial(said, "all samples"))
    final = tuple(Found(item.suspect, fitted) for item, fitted in zip(serious, fits[2:], strict=True))
    return Evidence(fine=fine, nominal=fits[0], null=fits[1], single=single, pair=pair, final=final)


__all__ = ["Effect", "Evidence", "Iterable", "Label", "candidates", "factors_of", "fit", "gather", "time"]
