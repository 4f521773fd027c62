"""One cause after the other: what a diagnosis claims goes into the scene, and the rest is diagnosed again.

A real machine has more than two causes, and the largest hides the others.  In the next round the strengths of what was
accepted are uncertain parameters like any others, so a wrong share of an earlier cause can be given back.  As for the
second cause within one diagnosis, a further one has to be far more probable than a first one.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.bench import Bench, Uncertain
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.gather import Evidence
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.diagnosis.verdict import SECOND
from hdrive_mbs.records.record import Record

ACCEPTED = 0.5
"""Standard deviation of the logarithm of an accepted strength in later rounds."""
EVERY = 1
"""The search compares all samples: these records have a few hundred, thinned to what is independent already."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Round:
    """A diagnosis with the bench that it started from.

    refit : the scene of the bench with its uncertain parameters adapted
    accepted : whether the claim is an effect that goes into the scene of the next round
    """

    bench: Bench
    refit: hm.Scene
    answer: Diagnosis
    accepted: bool


def rounds(bench: Bench, records: Sequence[Record], laws: Iterable[type[hm.Effect]], *, step: float, most: int) -> list[Round]:
    """Diagnoses until one claims no further effect, or none with the log odds that a second cause needs."""
    tried = tuple(laws)
    found: list[Round] = []
    for number in range(most):
        seen: list[Evidence] = []
        answer = diagnose(bench, records, candidates=tried, workers=1, step=step, every=EVERY, pictures=False, watch=seen.append)
        null = seen[0].null
        effects = [cause for cause in answer.causes if cause.kind != "parameter"]
        accepted = bool(effects) and (number == 0 or effects[0].log_odds > SECOND)
        found.append(Round(bench=bench, refit=null.hypothesis.scene(bench.scene, null.z), answer=answer, accepted=accepted))
        if not accepted:
            break
        bench = accepting(bench, answer)
    return found


def accepting(bench: Bench, answer: Diagnosis) -> Bench:
    """The bench with the claimed effects in its scene, everything else as nominal as before."""
    known = {placed.name for placed in bench.scene.effects}
    effects = tuple(placed for placed in answer.improved.effects if placed.name not in known)
    scene = dataclasses.replace(bench.scene, effects=(*bench.scene.effects, *effects))
    paths = scene.parameters()
    more = {}
    for cause in answer.causes:
        for item in cause.parameters:
            if item.identifiable and item.name in paths and paths[item.name].value > 0.0:
                more[item.name] = Uncertain(paths=(item.name,), sigma=ACCEPTED)
    return dataclasses.replace(bench, scene=scene, knowledge={**bench.knowledge, **more})
