"""What a diagnosis begins with: records that fit their bench, candidates, steps, and the records as search and last fits take them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from hdrive_mbs.diagnosis.assumed_bench import assumed_bench
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidate_checks import check_candidates
from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.candidates import candidates as all_candidates
from hdrive_mbs.diagnosis.column_names import as_the_bench_names_them
from hdrive_mbs.diagnosis.drive_scale_checks import drives_scaled
from hdrive_mbs.diagnosis.input_checks import check_records, check_trials, checked_every, not_compared, not_driven
from hdrive_mbs.diagnosis.pace import Pace, pace_of
from hdrive_mbs.diagnosis.record_words import record_words
from hdrive_mbs.diagnosis.scale_checks import looks_scaled
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.diagnosis.whole_records import split_up
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.records.record import Record
from hdrive_mbs.scene import Scene

EVERY = 4
"""Samples from one to the next that the search compares if nothing else is asked for; the last fits take all."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Prepared:
    """What is known before anything is fitted.

    records : with columns as the bench names them;  candidates : what may be missing;  factors : uncertain parameters
    step : of the last fits [s];  pace : steps of the search;  every : of so many samples the search compares one
    coarse, fine : the records for the search, and for the last fits
    searched : names of records of which the search sees something;  held_out : names of those that no fit sees
    warnings : of records and inputs;  notes : what was repaired in records
    """

    bench: Bench
    records: tuple[Record, ...]
    candidates: Sequence[Candidate]
    factors: tuple[Factor, ...]
    step: float
    pace: Pace
    every: int
    coarse: Simulator
    fine: Simulator
    searched: tuple[str, ...]
    held_out: tuple[str, ...]
    warnings: tuple[str, ...]
    notes: tuple[str, ...]

    @property
    def inputs(self) -> Mapping[str, Any]:
        """What the results depend on."""
        steps = self.step, self.pace.steps, len(self.pace.slowed)
        trials = self.fine.trials, self.factors, self.bench.groups, *steps, self.every
        return {"records": self.records, "bench": self.bench, "candidates": self.candidates, "trials": trials}

    @property
    def settings(self) -> Mapping[str, Any]:
        """How the search goes about it."""
        return {
            "step": self.step,
            "steps_of_search": dict(zip([trial.name for trial in self.coarse.trials], self.pace.steps, strict=True)),
            "slowed_in_search": len(self.pace.slowed),
            "every": self.every,
            "candidates": [f"{item.kind.__name__}@{item.at}" for item in self.candidates],
            "searched": list(self.searched),
            "held_out": list(self.held_out),
        }


def prepare(
    bench: Bench | Scene,
    records: Sequence[Record],
    candidates: Iterable[type[Effect]] | type[Effect] | None = None,
    step: float | None = None,
    held_out: Sequence[str] = (),
    every: int | None = None,
) -> Prepared:
    """Records held against their bench, and what is needed to fit them; arguments as for ``diagnose``.

    Raises RecordError for records that do not fit the bench, ParameterError for a bad candidate, time or ``every``, PlaceError for the
    name of a record that there is not, AnalysisError where the nominal model cannot be simulated.
    """
    known = bench if isinstance(bench, Bench) else assumed_bench(bench, records)
    chosen = tuple(as_the_bench_names_them(known, record) for record in records)
    check_records(known, chosen)
    trials_of = {record.name: known.trials(record) for record in chosen}
    searched, trials = split_up(trials_of, known.searched, held_out)
    every = EVERY if every is None else checked_every(every, searched)
    factors = factors_of(known)
    tried = all_candidates(trials[0].scene, candidates)
    if step is None:
        step = suitable_step(trials, factors)
        pace = pace_of(searched, factors, step)
    else:
        pace = Pace((step,) * len(searched))
    coarse, fine = Simulator(searched, pace.steps, every, slowed=pace.slowed, shortest=pace.shortest), Simulator(trials, step)
    check_trials(coarse, factors)
    if held_out:
        check_trials(Simulator([trial for trial in trials if trial.held_out.all()], step, every), factors, fitted=False)
    changed, reported = record_words(chosen)
    warnings = (
        *changed,
        *not_driven(known, chosen, coarse, factors, bare=not isinstance(bench, Bench)),
        *not_compared(known, chosen),
        *looks_scaled(coarse, factors),
        *drives_scaled(known, chosen, coarse, factors),
    )
    check_candidates(tried, coarse, factors)
    return Prepared(
        bench=known,
        records=chosen,
        candidates=tried,
        factors=factors,
        step=step,
        pace=pace,
        every=every,
        coarse=coarse,
        fine=fine,
        searched=tuple(name for name, own in trials_of.items() if any(trial in searched for trial in own)),
        held_out=tuple(held_out),
        warnings=warnings,
        notes=tuple(reported),
    )


def factors_of(bench: Bench) -> tuple[Factor, ...]:
    """The bench's uncertain parameters as unknowns."""
    found = []
    for name, item in bench.knowledge.items():
        nominal = dict(zip(item.paths, bench.nominal(name), strict=True))
        found.append(Factor(path=item.paths[0], name=name, nominal=nominal, sigma=item.sigma))
    return tuple(found)
