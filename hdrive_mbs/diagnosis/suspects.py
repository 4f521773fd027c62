"""What may explain a gap: parameters that may be off and effects that may be missing, as hypotheses to try."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from hdrive_mbs.diagnosis.beginnings import is_periodic
from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis

Label = tuple[str, str]

LOOSE = 10.0
"""Times its prior standard deviation that a suspected parameter may be off."""
PARAMETER = "parameter"
"""Law of a suspect that is no effect."""


@dataclass(frozen=True, eq=False)
class Suspect:
    """Something that may explain the gap: a label and the hypotheses that stand for it, from several starts.

    first : those for a first look;  all : every start
    widths : of a law with periods: what the records can tell apart of each
    """

    label: Label
    law: str
    first: tuple[Hypothesis, ...]
    all: tuple[Hypothesis, ...]
    widths: Mapping[str, float] = field(default_factory=dict)

    @property
    def is_periodic(self) -> bool:
        """Whether it is a law with a period to begin at."""
        return self.law != PARAMETER and is_periodic(self.first[0])

    @property
    def is_finer(self) -> bool:
        """Whether it is a law that waits for the others of its label."""
        return self.law != PARAMETER and type(self.first[0].added[-1].effect).finer

    @property
    def is_looked_at_whole(self) -> bool:
        """Whether the first look begins at every start already."""
        return len(self.first) == len(self.all) and all(_begins_alike(a, b) for a, b in zip(self.first, self.all, strict=True))


def _begins_alike(a: Hypothesis, b: Hypothesis) -> bool:
    """Whether two hypotheses of one suspect begin with equal values."""
    return a is b or _values(a) == _values(b)


def _values(hypothesis: Hypothesis) -> list[list[tuple[str, object]]]:
    return [[(name, value) for name, value, _ in item.effect.fields()] for item in hypothesis.added]


def suspects(base: Hypothesis, groups: Mapping[str, Sequence[str]], tried: Sequence[Candidate]) -> list[Suspect]:
    """Parameters that may be off, by group, and effects that may be missing, each added to a base."""
    taken = {(type(item.effect), item.at) for item in base.added}
    found = []
    for group, names in groups.items():
        if not set(names) & set(base.loose):
            loose = {**base.loose, **dict.fromkeys(names, LOOSE)}
            one = (Hypothesis(base.factors, base.added, loose),)
            found.append(Suspect(("parameter", group), PARAMETER, one, one))
    for item in tried:
        if (item.kind, item.at) in taken:
            continue

        def with_(starts: Sequence[Added]) -> tuple[Hypothesis, ...]:
            return tuple(Hypothesis(base.factors, (*base.added, renamed(added, base)), base.loose) for added in starts)

        found.append(Suspect(item.label, item.kind.__name__, with_(item.first), with_(item.starts)))
    return found


def renamed(added: Added, base: Hypothesis) -> Added:
    """An effect under a name that a base does not use yet."""
    taken = {item.name for item in base.added}
    name, number = added.name, 2
    while name in taken:
        name, number = f"{added.name}_{number}", number + 1
    return Added(added.effect, added.at, name)


def simplest(everything: Sequence[Suspect]) -> list[Suspect]:
    """The law of each label that leads its family, or else has the fewest unknowns."""
    best: dict[Label, Suspect] = {}
    for suspect in everything:
        known = best.get(suspect.label)
        if known is None or _before(suspect) < _before(known):
            best[suspect.label] = suspect
    return list(best.values())


def at_first(everything: Sequence[Suspect]) -> list[Suspect]:
    """Those that a search looks at from the beginning: finer laws wait until the others of their label leave something."""
    others = {suspect.label for suspect in everything if not suspect.is_finer}
    return [suspect for suspect in everything if not suspect.is_finer or suspect.label not in others]


def _before(suspect: Suspect) -> tuple[bool, int]:
    hypothesis = suspect.all[0]
    return not (suspect.law != PARAMETER and type(hypothesis.added[-1].effect).leads), hypothesis.size
