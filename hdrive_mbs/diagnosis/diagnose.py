"""The whole diagnosis: from a bench and its records to an answer."""

from __future__ import annotations

import dataclasses
import math
import platform
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from importlib import metadata
from pathlib import Path

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.let_go import let_go
from hdrive_mbs.compiled.threads import allowed
from hdrive_mbs.diagnosis.alternatives import Planned, fits_of, records_to_take
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidate_checks import left_out
from hdrive_mbs.diagnosis.deadline import Deadline
from hdrive_mbs.diagnosis.driven import driven_scenes
from hdrive_mbs.diagnosis.estimates import effect_estimates, nominal_estimates
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.gap import gaps
from hdrive_mbs.diagnosis.gather import Evidence, gather
from hdrive_mbs.diagnosis.journal import Journal
from hdrive_mbs.diagnosis.pictures import pictures_of
from hdrive_mbs.diagnosis.prepared import prepare
from hdrive_mbs.diagnosis.refusals import refused_words
from hdrive_mbs.diagnosis.result import Cause, Diagnosis
from hdrive_mbs.diagnosis.ringing import ringing_words
from hdrive_mbs.diagnosis.suspects import Label
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.unevenness import patch_words, patches, unevenness
from hdrive_mbs.diagnosis.verdict import NONE, UNKNOWN, Claim, judge, left
from hdrive_mbs.diagnosis.verify import Verified, verified
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.freed_memory import give_back
from hdrive_mbs.records.collection import Records
from hdrive_mbs.records.record import Record
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
Report = Callable[[str, int, int], None]


def diagnose(
    bench: Bench | Scene,
    records: Records | Sequence[Record] | Record,
    *,
    candidates: Iterable[type[Effect]] | type[Effect] | None = None,
    workers: int | None = None,
    folder: str | Path | None = None,
    step: float | None = None,
    every: int | None = None,
    held_out: Sequence[str] | str = (),
    report: Report | None = None,
    search_seconds: float | None = None,
    pictures: bool = True,
    watch: Callable[[Evidence], object] | None = None,
) -> Diagnosis:
    """Say where a model and its records disagree, which cause explains it, and how far the gap shrinks.

    bench : what is known: scene, uncertain parameters, measured columns with their noise, inputs; of a scene alone the
        columns are those named like its channels, the noise is estimated and usual tolerances are assumed
    records : one or several, checked (see ``Record.checked``); a column serves the bench under its name, or where it is mapped to
        that name or to the channel that it measures
    candidates : effect classes to try; all of the library and whatever else has been imported if not given
    workers : processes; 1 if not given.  With more, a script needs the line ``if __name__ == "__main__":`` before the call
    folder : where fits are kept, so that an interrupted diagnosis goes on from there
    step : of the integration [s], chosen if not given (``suitable_step``, and longer ones for the search on rotor lines, ``pace_of``);
        what grows with it is run again with half of it
    every : of so many samples the search compares one, and the last fits all; 4 if not given, 1 for records that are sparse already
    held_out : names of records that neither a fit nor the localisation may see, on which the gap is then measured, and which the
        verdict asks whether a claim holds there too; if not given, a quarter of every record, in stretches
    search_seconds : after which the search looks for no more where what it has found leaves something [s]; no end if not given.  What
        is begun is finished and the last fits follow, so an answer comes later; a warning says what was left out
    report : called with (stage, done, total)
    pictures : with histories, located forces and maps for the report
    watch : called with all fits, for those who want more figures than the answer holds

    Raises RecordError for records that do not fit the bench, ParameterError for a bad candidate, time or ``every``, PlaceError for the
    name of a record that there is not, AnalysisError where the nominal model cannot be simulated.
    """
    started = time.monotonic()
    deadline = Deadline(search_seconds)
    chosen = _records(records)
    aside = (held_out,) if isinstance(held_out, str) else tuple(held_out)
    others_run = (workers or 1) > 1
    with Team(workers or 1, deadline=deadline) as team:
        team.stand_by(gather.__module__, "scipy.signal")  # while the records are checked
        given = prepare(bench, chosen, candidates, step, aside, every)
        team.journal = None if folder is None else Journal(folder, given.inputs)
        if others_run:
            given.coarse.forget()
            let_go()  # what finding a step took, which the processes do not need from here
        give_back()
        evidence = gather(given.coarse, given.fine, given.factors, given.bench.groups, given.candidates, team, report)
        claim, best = _concluded(evidence)
        checked = _on_the_engine(team, evidence, best, report)
        planned = records_to_take(given.bench, given.records, evidence, claim, team, report)
    if watch is not None:
        watch(evidence)
    with allowed(lambda: workers or 1):  # its processes have ended
        found = answer(given.bench, given.records, evidence, claim, best, checked, planned, started=started, pictures=pictures)
    notes = (
        *left_out(given.candidates, evidence.single, given.step),
        *ringing_words(given.fine.trials),
        *team.lost,
        *(() if team.journal is None else team.journal.said),
        *given.notes,
    )
    found = dataclasses.replace(
        found,
        notes=(*found.notes, *notes),
        warnings=(*found.warnings, *given.warnings, *deadline.said(), *refused_words(team.refused)),
        inputs={name: item.path for name, item in given.bench.inputs.items()},
        files={item.name: {"source": item.source, "sha256": item.sha256} for item in given.records if item.sha256},
        settings=given.settings,
    )
    del evidence, given
    if others_run:
        let_go()
    give_back()
    return found


def _records(records: Records | Sequence[Record] | Record) -> tuple[Record, ...]:
    found = (records,) if isinstance(records, Record) else tuple(records)
    if not found:
        raise ParameterError("A diagnosis needs at least one record.")
    for record in found:
        if not isinstance(record, Record):
            raise ParameterError(f"{record!r} is no record. Read it first: hm.diagnose(bench, hm.read_records({records!r})).")
        record.checked()  # before a bench is made from them
    Records(records=found).checked()  # clocks of one run against each other
    return found


def _concluded(evidence: Evidence) -> tuple[Claim, Fitted]:
    """What the fits of a case say, and the fit that stands for it."""
    uneven = unevenness(evidence.fine, patches(evidence.fine, evidence.null))
    claim = judge(left(evidence.null), evidence.singles, evidence.pairs, uneven=uneven)
    return claim, evidence.null if claim.fit is None or claim.kind == "unknown" else claim.fit.fitted


def _on_the_engine(team: Team, evidence: Evidence, best: Fitted, report: Report | None) -> list[Verified]:
    """What is answered and what comes next, run on the engine; in processes if they are there still."""
    said = partial(report or (lambda stage, done, total: None), "verifying on the engine")
    fits = _winner_and_runner_up(evidence, best)
    if team.is_at_hand:
        return team.map(verified, evidence.fine, fits, said)
    found: list[Verified] = []
    for number, fitted in enumerate(fits):
        said(number, len(fits))
        found.append(verified(evidence.fine, fitted))
    return found


def answer(
    bench: Bench,
    records: Sequence[Record],
    evidence: Evidence,
    claim: Claim,
    best: Fitted,
    checked: Sequence[Verified],
    planned: Planned,
    *,
    started: float,
    pictures: bool,
) -> Diagnosis:
    """The answer that the fits of a case give.

    claim, best : what they say and the fit that stands for it;  checked : what the engine says of it
    planned : records to take next
    """
    improved = best.hypothesis.scene(bench.scene, best.z)
    notes = [*planned.notes]
    claimed = () if claim.kind in ("none", "unknown") or claim.fit is None else _causes(claim.fit, claim, improved, bench.groups)
    claimed = strongest_first(claimed, evidence.singles)
    if evidence.place.doubt:
        notes.append(f"Place of the gap: {evidence.place.doubt}")
    extras = pictures_of(evidence, best, [cause.at for cause in claimed]) if pictures else {}
    notes += [item.text for item in checked if not item.differs]
    told = "the refitted nominal model" if best.hypothesis.is_nominal else best.hypothesis.label
    notes += patch_words(evidence.fine, patches(evidence.fine, best), told)
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
        warnings=tuple(item.text for item in checked if item.differs),
        fits=fits_of(evidence, claim),
        next_records=planned.records,
        driven=driven_scenes(evidence.fine, best, [record.name for record in records]),
        seconds=time.monotonic() - started,
        versions=_versions(),
        **extras,
    )


def _winner_and_runner_up(evidence: Evidence, best: Fitted) -> list[Fitted]:
    """What is answered, and the best of what else was fitted to all samples."""
    others = [item for item in (*evidence.singles, *evidence.pairs) if item.fitted is not best]
    return [best, *(item.fitted for item in sorted(others, key=lambda item: -item.log_odds)[:1])]


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


def strongest_first(causes: Sequence[Cause], singles: Sequence[Found]) -> tuple[Cause, ...]:
    """Causes that are claimed together, the one that explains most by itself first; those that were not fitted alone last.

    singles : single causes on all samples
    """
    alone: dict[Label, float] = {}
    for item in singles:
        alone[item.suspect.label] = max(item.log_odds, alone.get(item.suspect.label, -math.inf))
    return tuple(sorted(causes, key=lambda cause: -alone.get((cause.effect, cause.at), -math.inf)))


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


def _versions() -> Mapping[str, str]:
    found = {"python": platform.python_version()}
    for name in ("hdrive_mbs", "exudyn", "numpy", "scipy"):
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = "not installed"
    return found
