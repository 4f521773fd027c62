"""What a fit reaches that knows the cause: the yardstick of the held-out gap.

The nominal model is refitted with every law of the right causes at the right place, from every start; the best of them
is fitted on all samples.  Of two causes the one that explains more by itself comes first, then the other beside it.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.withheld.answer import answer_of
from benchmarks.withheld.finding import Claimed, Finding
from benchmarks.withheld.methods import Solved, bench_of, records_of
from benchmarks.withheld.names import Label, names_of
from benchmarks.withheld.truths import read_truths
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidates import Candidate, candidates
from hdrive_mbs.diagnosis.fit import Fitted, fit, jacobian
from hdrive_mbs.diagnosis.hypothesis import FloatArray
from hdrive_mbs.diagnosis.prepared import EVERY, factors_of
from hdrive_mbs.diagnosis.screening import Screen
from hdrive_mbs.diagnosis.search import fit_nominal
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.diagnosis.suspects import suspects

STEPS, SHARE = 30, 1e-4
"""Steps of each law on a part of the samples, and the relative change of the cost that ends them."""
LAST, EXACT = 25, 1e-6
"""The same of the last fit on all samples."""


def oracle(bench: str, folder: Path, truths: Path | None = None) -> Solved:
    """The gap that is left when the cause is known; of a cause without a name it knows nothing."""
    if truths is None:
        raise ValueError("the oracle has to know the causes: give --truths.")
    truth = read_truths(truths)[folder.name]["truth"]
    start, names, known = time.monotonic(), names_of(bench), bench_of(bench)
    trials = [trial for record in records_of(folder) for trial in known.trials(record)]
    step = suitable_step(trials, factors_of(known))
    coarse, fine = Simulator(trials, step, EVERY), Simulator(trials, step)
    null = fit_nominal(coarse, factors_of(known))
    given = fit(fine, null.hypothesis, np.zeros_like(null.z), steps=0)
    refit = fit(fine, null.hypothesis, null.z, steps=LAST, share=EXACT)
    wanted = [labels for item in truth if (labels := names.labels((item["effect"], item["at"])))]
    best, claimed = refit, []
    if wanted:
        found, claimed = _knowing(coarse, null, known, wanted, candidates(trials[0].scene))
        best = fit(fine, found.hypothesis, found.z, steps=LAST, share=EXACT)
    gap = {"nominal": given.chi_held**0.5, "refit": refit.chi_held**0.5, "effect": best.chi_held**0.5, "floor": 1.0}
    verdict = "effect" if claimed else "none" if not truth else "unknown"
    finding = Finding(
        verdict=verdict,
        claimed=tuple(Claimed(label=label) for label in claimed),
        ranking=dict.fromkeys(claimed or [(verdict, "")], 1.0),
        gap=gap,
        seconds=time.monotonic() - start,
    )
    return Solved(answer=answer_of(folder.name, finding, names))


def _knowing(
    simulator: Simulator, null: Fitted, bench: Bench, wanted: list[tuple[Label, ...]], tried: list[Candidate]
) -> tuple[Fitted, list[Label]]:
    """The best fit with one law of each cause, the cause that gains most first."""
    base, left, claimed = null, list(wanted), []
    while left:
        columns = jacobian(simulator, base.hypothesis, base.z, base.residuals)
        ends = [
            (fitted, label, k) for k, labels in enumerate(left) for fitted, label in _laws(simulator, base, columns, bench, labels, tried)
        ]
        if not ends:
            break
        base, label, number = min(ends, key=lambda item: item[0].cost)
        claimed.append(label)
        del left[number]
    return base, claimed


def _laws(
    simulator: Simulator, base: Fitted, columns: FloatArray, bench: Bench, labels: tuple[Label, ...], tried: list[Candidate]
) -> Iterator[tuple[Fitted, Label]]:
    """Every law of some labels, fitted to the end beside a base."""
    groups = {group: own for group, own in bench.groups.items() if ("parameter", group) in labels}
    screen = Screen(simulator, base, columns)
    for suspect in suspects(base.hypothesis, groups, [item for item in tried if item.label in labels]):
        look = screen.look(suspect.all)
        if look is not None:
            yield fit(simulator, look.hypothesis, look.z, steps=STEPS, share=SHARE, begin=look.residuals), suspect.label
