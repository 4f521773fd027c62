"""All fits of a case, from which its answer is drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.search import Found, Report, Search, Task, fit_nominal, run_task, scored, search
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.unknowns import Factor

LEFT = 1.03
"""Mean square left by the best single cause above which a second one is looked for."""
SINGLES, LAST, LONG = 3, 4, 20
"""Labels that are fitted on all samples, and steps that this may take for them and for the best."""
EXACT = 1e-5
"""Relative change of the cost that ends these last fits."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """What all fits of a case gave.

    fine : all samples;  nominal, null : the model as given and refitted, on these
    single : search for one cause;  pair : for a second one besides the best first, if that left something
    singles : the best labels on all samples, best first;  pairs : likewise with two causes; log odds over the null
    """

    fine: Simulator
    nominal: Fitted
    null: Fitted
    single: Search
    pair: Search | None
    singles: tuple[Found, ...]
    pairs: tuple[Found, ...]


def gather(
    coarse: Simulator,
    fine: Simulator,
    factors: Sequence[Factor],
    groups: Mapping[str, Sequence[str]],
    tried: Sequence[Candidate],
    team: Team,
    report: Report | None = None,
) -> Evidence:
    """Fit the nominal model, single causes and, where these leave something, pairs.

    coarse : the records with every few samples, on which the search works

    Raises AnalysisError where the nominal model cannot be simulated.
    """
    said = report or (lambda stage, done, total: None)
    said("fitting the nominal model", 0, 1)
    null = fit_nominal(coarse, factors)
    single = search(team, coarse, null, groups, tried, report=said)
    first = single.found[0] if single.found else None
    pair = None
    if first is not None and first.log_odds > 0.0 and first.fitted.chi_fit > LEFT:
        pair = search(team, coarse, first.fitted, groups, tried, report=lambda stage, k, n: said(f"second cause: {stage}", k, n))
    serious = single.labels[:SINGLES]
    double = () if pair is None else pair.labels[:1]
    tasks = [Task(null.hypothesis, np.zeros_like(null.z), None, 0, 1.0), Task(null.hypothesis, null.z, None, LAST, EXACT)]
    best = min((*serious, *double), key=lambda item: item.fitted.cost, default=None)
    for item in (*serious, *double):
        tasks.append(Task(item.fitted.hypothesis, item.fitted.z, None, LONG if item is best else LAST, EXACT))
    fits = team.map(run_task, fine, tasks, partial(said, "all samples"))
    pairs = list(zip((*serious, *double), fits[2:], strict=True))
    final = [scored(Found(item.suspect, fitted), fits[1]) for item, fitted in pairs]
    singles = sorted(final[: len(serious)], key=lambda item: -item.log_odds)
    return Evidence(fine, fits[0], fits[1], single, pair, tuple(singles), tuple(final[len(serious) :]))
