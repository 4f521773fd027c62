"""What a diagnosis found, in the words of our library and in the few figures that an answer needs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from benchmarks.withheld.names import Label
from hdrive_mbs.diagnosis.result import Cause, Diagnosis


@dataclass(frozen=True, kw_only=True)
class Claimed:
    """A cause that is claimed, with its identified parameters by name, SI."""

    label: Label
    parameters: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Verdict and figures of one case.

    verdict : of the diagnosis;  claimed : causes of the claim, empty for "none" and "unknown"
    tied : labels that cannot be told from the claim;  ranking : probability of each label, ("none", "") and ("unknown", "") included
    where : located place -> probability;  elsewhere : place at which the gap lies though the claim, which leaves something, is at another
    gap : "nominal", "refit", "effect", "floor"; empty where they are not known
    """

    verdict: str
    claimed: tuple[Claimed, ...] = ()
    tied: tuple[Label, ...] = ()
    ranking: Mapping[Label, float] = field(default_factory=dict)
    where: Mapping[str, float] = field(default_factory=dict)
    elsewhere: str = ""
    gap: Mapping[str, float] = field(default_factory=dict)
    seconds: float = 0.0


def finding_of(diagnosis: Diagnosis) -> Finding:
    """What a diagnosis says."""
    gap, other = diagnosis.gap, diagnosis.elsewhere
    figures = {"nominal": gap.nominal.value, "refit": gap.refit.value, "effect": gap.effect.value, "floor": gap.floor}
    return Finding(
        verdict=diagnosis.verdict,
        claimed=tuple(Claimed(label=(cause.effect, cause.at), parameters=_parameters(cause)) for cause in diagnosis.causes),
        tied=diagnosis.indistinguishable,
        ranking={(cause.effect, cause.at): cause.probability for cause in diagnosis.ranking},
        where={place.at: place.probability for place in diagnosis.where},
        elsewhere="" if other is None else other.at,
        gap={name: value for name, value in figures.items() if math.isfinite(value)},
        seconds=diagnosis.seconds,
    )


def _parameters(cause: Cause) -> dict[str, float]:
    """Identified values by the last part of their path; of a nominal parameter also how far it is off."""
    found = {}
    for item in cause.parameters:
        name = item.name.rpartition(".")[2]
        found[name] = item.value
        if math.isfinite(item.nominal) and item.nominal:
            found[f"{name}_over_nominal"] = item.value / item.nominal
    return found
