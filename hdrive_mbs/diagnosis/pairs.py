"""Two causes at once: the first exchanged for its rivals, each at other places, and each of the two without the other."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence

from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.carried import carried
from hdrive_mbs.diagnosis.choosing import SEEN
from hdrive_mbs.diagnosis.from_the_best import values_of, with_values
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.joined import TOGETHER
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Label, Suspect, renamed
from hdrive_mbs.diagnosis.tasks import (
    CONVERGED,
    FINE,
    FIRST,
    Found,
    Task,
    cheapest,
    further,
    is_hopeless,
    rivalling,
    run_task,
    those_that_ran,
)
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import left
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import is_needed

MOVED, GOING = 14, 4
"""Joint steps of a pair with a cause at another place or another law, and how many of these pairs take them, the best after the first
steps.  A drag in place of what had stood for it beside friction passed the other pair in its tenth (c16 of our own fourteenth drive set,
labels open)."""
CONTENDERS, NEARLY = 3, 0.01
"""Pairs that are fitted to the end at most, and share of what a second cause gains by which they may lie behind the best until then."""


def swapped(team: Team, simulator: Simulator, pair: Found, first: Label, others: Sequence[Found]) -> list[Found]:
    """A pair with its first cause replaced by each of other single causes, the second as it was found.

    The first cause was chosen while the second was missing, and may have had to stand for it.

    first : label of the first cause;  others : single causes, fitted
    """
    second = pair.fitted.hypothesis.rescaled(pair.fitted.z)[0]
    if len(second.added) < 2:
        return []
    tasks = []
    names = []
    for item in others:
        if item.suspect.label in (first, pair.suspect.label) or not item.fitted.hypothesis.added:
            continue
        own = item.fitted.hypothesis.rescaled(item.fitted.z)[0]
        base = Hypothesis(own.factors, own.added, {**own.loose, **second.loose})
        hypothesis = Hypothesis(own.factors, (*own.added, renamed(second.added[-1], base)), base.loose)
        start = hypothesis.start(pair.fitted.hypothesis.nominal_part(pair.fitted.z))
        tasks.append(Task(hypothesis, start, None, TOGETHER, FINE, beat=rivalling(pair.fitted)))
        names.append(pair.suspect)
    return those_that_ran(names, team.map(run_task, simulator, tasks))


def alone(
    team: Team, simulator: Simulator, pair: Found, everything: Sequence[Suspect], best: Found, known: Collection[Label] = ()
) -> list[Found]:
    """Each cause of a pair without the other, from the values of the pair.

    The first may have done no more than bring the parameters to where the second shows, or its own fit may have stopped on its way and
    the second stand for what that left: friction of a motor left 1.036 and beside a play, which was not there, 1.001; told the cause,
    the same laws leave 1.011 (c24 of our own sixteenth drive set, labels open).  Where the first is a parameter, other laws of the second
    are tried from its values too: a mass on a spring beside an inertia that is too large by as much is a load of which a part sits on a
    spring.

    best : single cause so far, with which it has to catch up;  known : labels that were tried so already
    """
    fitted = pair.fitted
    full = fitted.hypothesis.rescaled(fitted.z)[0]
    tasks, whose = [], []
    for suspect in everything:
        if suspect.label not in known:
            for hypothesis in _singled_out(full, suspect, pair.suspect.label):
                start = hypothesis.start(fitted.hypothesis.nominal_part(fitted.z))
                tasks.append(Task(hypothesis, start, None, CONVERGED, FINE, beat=rivalling(best.fitted)))
                whose.append(suspect)
    return cheapest(those_that_ran(whose, team.map(run_task, simulator, tasks)))


def _singled_out(full: Hypothesis, suspect: Suspect, second: Label) -> Iterator[Hypothesis]:
    """A suspect with the values that it has in a pair; of a second cause beside a parameter other laws too, with all values in fields of
    the same name and with those alone that decide whether they show."""
    old = suspect.all[0]
    if suspect.law == PARAMETER:
        if set(old.loose) <= set(full.loose):
            yield old
        return
    for added in full.added:
        is_same = type(added.effect).__name__ == suspect.law
        if added.label == suspect.label and (is_same or (full.loose and suspect.label == second)):
            last, values = old.added[-1], values_of(added.effect)
            # the rest may be bent by standing for another law
            decisive = {name: value for name, value in values.items() if name in type(added.effect).decisive}
            others = [with_values(last.effect, some) for some in (values, decisive) if some]
            for effect in [added.effect] if is_same else dict.fromkeys(others):
                yield Hypothesis(old.factors, (Added(effect, last.at, last.name),), old.loose)


def moved(team: Team, simulator: Simulator, pairs: Sequence[Found], tried: Sequence[Candidate]) -> list[Found]:
    """The best pair with one of its causes at each of the other places where it may sit, but where another of the pairs has it.

    The place of a cause was chosen while the other one was missing, or among a few that looked best: both ends of a stiff shaft
    look alike then.  Friction at the wrong one of them comes close to the right one from its final values alone.

    pairs : at least one, fitted to the end;  tried : effects and places that are admitted
    """

    network = simulator.trials[0].scene.network()

    def elsewhere(full: Hypothesis, k: int) -> Iterator[Added]:
        mine = full.added[k]
        for place in tried:
            if place.kind is type(mine.effect):
                effect = carried(mine.effect, place.starts[0].effect, network, mine.at, place.at)
                yield from (Added(some, place.at, mine.name) for some in dict.fromkeys((effect, plain(effect))))

    return replaced(team, simulator, pairs, elsewhere)


def replaced(
    team: Team,
    simulator: Simulator,
    pairs: Sequence[Found],
    others: Callable[[Hypothesis, int], Iterable[Added]],
    *,
    by_law: bool = False,
) -> list[Found]:
    """The best pair with one of its causes replaced, but where another of the pairs has both: first steps, and more of the nearest.

    pairs : at least one, fitted to the end;  others : of a hypothesis and the number of a cause in it, what is tried in its place
    by_law : whether two causes with other laws count as another pair
    """
    names = laws_of if by_law else causes_of
    best = min(pairs, key=lambda item: item.fitted.cost)
    full, z = best.fitted.hypothesis.rescaled(best.fitted.z)
    known = {names(item.fitted.hypothesis) for item in pairs}
    tasks, whose = [], []
    for k in range(len(full.added)):
        is_second = k == len(full.added) - 1 and best.suspect.law != PARAMETER
        for added in others(full, k):
            hypothesis = Hypothesis(full.factors, (*full.added[:k], added, *full.added[k + 1 :]), full.loose)
            if names(hypothesis) in known or len(hypothesis.labels) < len(full.added):
                continue
            tasks.append(Task(hypothesis, hypothesis.start(full.nominal_part(z)), None, FIRST, FINE))
            whose.append(standing_for(hypothesis) if is_second else best.suspect)
    return nearest(team, simulator, best, tasks, whose, names)


def standing_for(hypothesis: Hypothesis) -> Suspect:
    """The second cause of a pair, where that is an effect, as a suspect: the last one that was added."""
    last = hypothesis.added[-1]
    return Suspect(last.label, type(last.effect).__name__, (hypothesis,), (hypothesis,))


def nearest(
    team: Team,
    simulator: Simulator,
    best: Found,
    tasks: Sequence[Task],
    whose: Sequence[Suspect],
    names: Callable[[Hypothesis], frozenset[object]],
) -> list[Found]:
    """Other pairs after their first steps, the best start of each, and those that come nearest after more.

    best : the best pair so far;  tasks : first steps of others;  whose : second cause of each;  names : by which two pairs are one
    """
    begun: dict[frozenset[object], Found] = {}
    for item in sorted(those_that_ran(whose, team.map(run_task, simulator, tasks)), key=lambda item: item.fitted.cost):
        begun.setdefault(names(item.fitted.hypothesis), item)
    open_ = [item for item in begun.values() if not (item.fitted.converged or is_hopeless(item.fitted.chi_fit, best.fitted.chi_fit))]
    going = open_[:GOING]
    found = [item for item in begun.values() if item not in going]
    fits = team.map(run_task, simulator, [further(item.fitted, MOVED - FIRST, beat=rivalling(best.fitted)) for item in going])
    return [*found, *those_that_ran([item.suspect for item in going], fits)]


def plain(effect: Effect) -> Effect:
    """An effect with what has a default at its default: the rest was bent to fit another place."""
    given = {field.name: getattr(effect, field.name) for field in dataclasses.fields(effect) if is_needed(field)}
    try:
        return type(effect)(**given)
    except ParameterError:
        return effect


def contenders(team: Team, simulator: Simulator, pairs: Sequence[Found], first: Found) -> tuple[Found, ...]:
    """The pairs that may be the best, fitted to the end, best first: one for each two causes.

    Friction of either end of a stiff shaft, say, differs by less than what a few steps bring.  Where the best leaves something, they are
    fitted with patience.

    pairs : at least one;  first : the best single cause
    """
    best: dict[frozenset[object], Found] = {}
    for item in sorted(pairs, key=lambda item: item.fitted.cost):
        best.setdefault(_causes(item), item)
    ranked = list(best.values())
    least = ranked[0].fitted.cost
    near = [item for item in ranked if item.fitted.cost - least <= NEARLY * max(first.fitted.cost - least, 0.0)][:CONTENDERS]
    patient = left(near[0].fitted) > SEEN
    fits = team.map(run_task, simulator, [further(item.fitted, patient=patient) for item in near])
    return tuple(sorted(those_that_ran([item.suspect for item in near], fits), key=lambda item: item.fitted.cost)) or (ranked[0],)


def _causes(pair: Found) -> frozenset[object]:
    return causes_of(pair.fitted.hypothesis)


def causes_of(hypothesis: Hypothesis) -> frozenset[object]:
    """What a hypothesis adds and lets loose, by family and place: by it two pairs count as one."""
    return frozenset((*hypothesis.labels, *hypothesis.loose))


def laws_of(hypothesis: Hypothesis) -> frozenset[object]:
    """Likewise with the law of each cause: by it two ways to tell the same causes are two."""
    return frozenset((*((item.label, type(item.effect)) for item in hypothesis.added), *hypothesis.loose))
