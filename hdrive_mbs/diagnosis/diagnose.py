"""The whole diagnosis: from a bench and its records to an answer."""

from __future__ import annotations

import dataclasses
import platform
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from importlib import metadata
from pathlib import Path

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.assumed_bench import assumed_bench
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidate_checks import check_candidates, left_out
from hdrive_mbs.diagnosis.candidates import candidates as all_candidates
from hdrive_mbs.diagnosis.domain import domain_map
from hdrive_mbs.diagnosis.driven import driven_scenes
from hdrive_mbs.diagnosis.estimates import effect_estimates, nominal_estimates
from hdrive_mbs.diagnosis.experiment.choose import next_records
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.gap import gaps
from hdrive_mbs.diagnosis.gather import Evidence, gather
from hdrive_mbs.diagnosis.input_checks import check_records, check_trials, not_compared, not_driven
from hdrive_mbs.diagnosis.journal import Journal
from hdrive_mbs.diagnosis.pictured import pictured
from hdrive_mbs.diagnosis.result import Cause, Diagnosis, Separation
from hdrive_mbs.diagnosis.scale_checks import looks_scaled
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.diagnosis.suspects import Label
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.traces import traces
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.diagnosis.verdict import NONE, UNKNOWN, Claim, judge, left
from hdrive_mbs.diagnosis.verify import engine_difference
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import HdriveError, ParameterError
from hdrive_mbs.freed_memory import give_back
from hdrive_mbs.records.collection import Records
from hdrive_mbs.records.record import Record
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
Report = Callable[[str, int, int], None]

EVERY = 4
"""Samples from one to the next that the search compares; the last fits take all."""
AGREES = 0.3
"""Standard deviations of the noise by which search and engine may differ before a note says so."""


def diagnose(
    bench: Bench | Scene,
    records: Records | Sequence[Record] | Record,
    *,
    candidates: Iterable[type[Effect]] | type[Effect] | None = None,
    workers: int | None = None,
    folder: str | Path | None = None,
    step: float | None = None,
    report: Report | None = None,
    pictures: bool = True,
    watch: Callable[[Evidence], object] | None = None,
) -> Diagnosis:
    """Say where a model and its records disagree, which cause explains it, and how far the gap shrinks.

    bench : what is known: scene, uncertain parameters, measured columns with their noise, inputs; of a scene alone the
        columns are those named like its channels, the noise is estimated and usual tolerances are assumed
    records : one or several, checked (see ``Record.checked``)
    candidates : effect classes to try; all of the library and whatever else has been imported if not given
    workers : processes; 1 if not given.  With more, a script needs the line ``if __name__ == "__main__":`` before the call
    folder : where fits are kept, so that an interrupted diagnosis goes on from there
    step : of the integration [s], chosen if not given (``suitable_step``); what grows with it is run again with half of it
    report : called with (stage, done, total)
    pictures : with histories, located forces and maps for the report
    watch : called with all fits, for those who want more figures than the answer holds

    Raises RecordError for records that do not fit the bench, ParameterError for a bad candidate, AnalysisError where
    the nominal model cannot be simulated.
    """
    started = time.monotonic()
    chosen = _records(records)
    known = bench if isinstance(bench, Bench) else assumed_bench(bench, chosen)
    check_records(known, chosen)
    trials_of = {record.name: known.trials(record) for record in chosen}
    trials = [trial for found in trials_of.values() for trial in found]
    searched = [trial for name in known.searched for trial in trials_of.get(name, ())] or trials
    if not trials:
        raise ParameterError("A diagnosis needs at least one record.")
    factors = factors_of(known)
    tried = all_candidates(trials[0].scene, candidates)
    step = suitable_step(trials, factors) if step is None else step
    coarse, fine = Simulator(searched, step, EVERY), Simulator(trials, step)
    check_trials(coarse, factors)
    warnings = (*not_driven(known, chosen, coarse, factors), *not_compared(known, chosen), *looks_scaled(coarse, factors))
    check_candidates(tried, coarse, factors)
    journal = None
    if folder is not None:
        inputs = {"records": chosen, "bench": known, "candidates": tried, "trials": (trials, factors, known.groups, step, EVERY)}
        journal = Journal(folder, inputs)
    with Team(workers or 1, journal) as team:
        evidence = gather(coarse, fine, factors, known.groups, tried, team, report)
    if watch is not None:
        watch(evidence)
    found = answer(known, chosen, evidence, started=started, pictures=pictures)
    notes = (*left_out(tried, evidence.single, step), *(() if journal is None else journal.said))
    driven = {name: item.path for name, item in known.inputs.items()}
    del evidence, coarse, fine, trials, trials_of, searched
    give_back()
    return dataclasses.replace(found, notes=(*found.notes, *notes), warnings=warnings, inputs=driven)


def _records(records: Records | Sequence[Record] | Record) -> tuple[Record, ...]:
    found = (records,) if isinstance(records, Record) else tuple(records)
    if not found:
        raise ParameterError("A diagnosis needs at least one record.")
    for record in found:
        if not isinstance(record, Record):
            raise ParameterError(f"{record!r} is no record. Read it first: hm.diagnose(bench, hm.read_records({records!r})).")
        record.checked()  # before a bench is made from them
    return found


def factors_of(bench: Bench) -> tuple[Factor, ...]:
    """The bench's uncertain parameters as unknowns."""
    found = []
    for name, item in bench.knowledge.items():
        nominal = dict(zip(item.paths, bench.nominal(name), strict=True))
        found.append(Factor(path=item.paths[0], name=name, nominal=nominal, sigma=item.sigma))
    return tuple(found)


def answer(bench: Bench, records: Sequence[Record], evidence: Evidence, *, started: float, pictures: bool) -> Diagnosis:
    """The answer that the fits of a case give."""
    claim = judge(left(evidence.null), evidence.singles, evidence.pairs)
    best = evidence.null if claim.fit is None or claim.kind == "unknown" else claim.fit.fitted
    improved = best.hypothesis.scene(bench.scene, best.z)
    notes: list[str] = []
    claimed = () if claim.kind in ("none", "unknown") or claim.fit is None else _causes(claim.fit, claim, improved, bench.groups)
    extras: dict[str, object] = {}
    if evidence.place.doubt:
        notes.append(f"Place of the gap: {evidence.place.doubt}")
    if pictures:
        extras["traces"] = traces(evidence.fine, evidence.nominal, evidence.null, best)
        extras["domain"] = domain_map(evidence.fine, evidence.null, best)
        extras["forces"] = tuple(pictured(force) for force in evidence.place.forces)
    if claim.tied:
        extras["next_records"] = _next_records(bench, records, evidence, claim, notes)
    notes += _verified(evidence.fine, best)
    notes += [f"{best.hypothesis.label}: the fit had not converged when it stopped." for _ in range(not best.converged)]
    return Diagnosis(
        scene=bench.scene,
        improved=improved,
        records=tuple(record.name for record in records),
        verdict=claim.kind,
        causes=claimed,
        indistinguishable=claim.tied,
        ranking=_ranking(evidence, claim),
        where=evidence.place.places,
        gaps=gaps(evidence.fine, evidence.nominal.residuals, evidence.null.residuals, best.residuals),
        parameters=nominal_estimates(best, bench.scene),
        notes=tuple(notes),
        driven=driven_scenes(evidence.fine, best, [record.name for record in records]),
        seconds=time.monotonic() - started,
        versions=_versions(),
        **extras,  # type: ignore[arg-type]
    )


def _next_records(bench: Bench, records: Sequence[Record], evidence: Evidence, claim: Claim, notes: list[str]) -> tuple[Separation, ...]:
    """Records that would separate what these cannot tell apart; a note where none can be planned."""
    tied = _alternatives(evidence, claim)
    if len(tied) < 2:
        return ()
    try:
        return next_records(bench, tied, records=records, step=evidence.fine.step)
    except HdriveError as error:
        notes.append(f"No next record was planned: {error}")
        return ()


def _alternatives(evidence: Evidence, claim: Claim) -> dict[Label, Fitted]:
    """What is claimed and what cannot be told from it, each by the label that the others lack."""
    assert claim.fit is not None
    own = claim.fit.suspect.label
    if claim.fit not in evidence.pairs:
        return {item.suspect.label: item.fitted for item in evidence.singles if item.suspect.label in (own, *claim.tied)}
    found = {own: claim.fit.fitted}
    for item in evidence.pairs:
        labels = [added.label for added in item.fitted.hypothesis.added if added.label in claim.tied]
        found |= dict.fromkeys(labels[:1], item.fitted)
    return found


def _causes(found: Found, claim: Claim, improved: Scene, groups: Mapping[str, Sequence[str]]) -> tuple[Cause, ...]:
    """What is claimed: every loosened group and every added effect of the chosen hypothesis."""
    fitted = found.fitted
    causes = []
    for item in fitted.hypothesis.added:
        kind = type(item.effect)
        causes.append(
            Cause(
                effect=kind.family,
                at=item.at,
                kind=kind.kind,
                law=kind.__name__,
                signature=kind.signature,
                probability=claim.probabilities.get(item.label, claim.probabilities.get(found.suspect.label, 0.0)),
                parameters=effect_estimates(fitted, improved, item.name),
                log_odds=found.log_odds,
                fit=fitted.chi_fit,
                held_out=fitted.chi_held,
            )
        )
    for group, names in groups.items():
        if not set(names) & set(fitted.hypothesis.loose):
            continue
        estimates = tuple(item for item in nominal_estimates(fitted, improved) if item.name in names)
        label = ("parameter", group)
        causes.append(
            Cause(
                effect="parameter",
                at=group,
                kind="parameter",
                law="parameter",
                probability=claim.probabilities.get(label, claim.probabilities.get(found.suspect.label, 0.0)),
                parameters=estimates,
                log_odds=found.log_odds,
                fit=fitted.chi_fit,
                held_out=fitted.chi_held,
            )
        )
    return tuple(causes)


def _ranking(evidence: Evidence, claim: Claim) -> tuple[Cause, ...]:
    """Every label that was fitted, and "none" and "unknown", most probable first."""
    fits: dict[Label, Found] = {item.suspect.label: item for item in (*evidence.singles, *evidence.single.labels)[::-1]}
    causes = []
    for label, probability in claim.probabilities.items():
        found = fits.get(label)
        if found is None:
            null = evidence.null
            kind = "none" if label == NONE else "unknown" if label == UNKNOWN else ""
            causes.append(
                Cause(
                    effect=label[0],
                    at=label[1],
                    kind=kind,
                    law="",
                    probability=probability,
                    log_odds=0.0,
                    fit=null.chi_fit,
                    held_out=null.chi_held,
                )
            )
            continue
        added = found.fitted.hypothesis.added
        kind = type(added[-1].effect).kind if added else "parameter"
        signature = type(added[-1].effect).signature if added else ""
        causes.append(
            Cause(
                effect=label[0],
                at=label[1],
                kind=kind,
                law=found.suspect.law,
                signature=signature,
                probability=probability,
                log_odds=found.log_odds,
                fit=found.fitted.chi_fit,
                held_out=found.fitted.chi_held,
            )
        )
    return tuple(causes)


def _verified(simulator: Simulator, fitted: Fitted) -> list[str]:
    """A note on how far the multibody engine is from the compiled run of the answer."""
    try:
        difference = engine_difference(simulator, fitted)
    except HdriveError as error:
        return [f"Not verified on the engine: {error}"]
    agrees = "agree" if difference < AGREES else "DIFFER"
    return [f"Search and multibody engine {agrees}: rms difference {difference:.2g} of the noise at most, {fitted.hypothesis.label}."]


def _versions() -> Mapping[str, str]:
    found = {"python": platform.python_version()}
    for name in ("hdrive_mbs", "exudyn", "numpy", "scipy"):
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = "not installed"
    return found
