"""What is claimed and what cannot be told from it, and the records that would separate them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.experiment.choose import Report, next_records
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.gather import Evidence
from hdrive_mbs.diagnosis.result import Separation
from hdrive_mbs.diagnosis.suspects import Label
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import Claim
from hdrive_mbs.errors import HdriveError
from hdrive_mbs.records.record import Record


def alternatives(evidence: Evidence, claim: Claim) -> dict[Label, Fitted]:
    """What is claimed and what cannot be told from it, each by the label that the others lack; nothing where nothing is claimed."""
    if claim.fit is None:
        return {}
    own = claim.fit.suspect.label
    if claim.fit not in evidence.pairs:
        return {item.suspect.label: item.fitted for item in evidence.singles if item.suspect.label in (own, *claim.tied)}
    found = {own: claim.fit.fitted}
    for item in evidence.pairs:
        labels = [added.label for added in item.fitted.hypothesis.added if added.label in claim.tied]
        found |= dict.fromkeys(labels[:1], item.fitted)
    return found


def fits_of(evidence: Evidence, claim: Claim) -> dict[Label, Fitted]:
    """Those, and the best other causes on all samples, most probable first; without residuals."""
    found = alternatives(evidence, claim)
    for item in evidence.singles:
        found.setdefault(item.suspect.label, item.fitted)
    return _short(found)


@dataclass(frozen=True)
class Planned:
    """Records that would separate what cannot be told apart, best first;  notes : why none could be planned."""

    records: tuple[Separation, ...] = ()
    notes: tuple[str, ...] = ()


def records_to_take(
    bench: Bench, records: Sequence[Record], evidence: Evidence, claim: Claim, team: Team, report: Report | None
) -> Planned:
    """Records that would separate what is claimed from what cannot be told from it; none where nothing is tied."""
    tied = alternatives(evidence, claim) if claim.tied else {}
    if len(tied) < 2:
        return Planned()
    try:
        return Planned(next_records(bench, _short(tied), records=records, step=evidence.fine.step, report=report, team=team))
    except HdriveError as error:
        return Planned(notes=(f"No next record was planned: {error}",))


def _short(fits: Mapping[Label, Fitted]) -> dict[Label, Fitted]:
    """Without residuals, which are long."""
    return {label: replace(fitted, residuals=np.empty(0)) for label, fitted in fits.items()}
