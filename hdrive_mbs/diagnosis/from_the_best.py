"""What is tried from the best that a search has found: its other laws, its other places, and the data sheet's values again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from hdrive_mbs.diagnosis.carried import carried
from hdrive_mbs.diagnosis.choosing import SEEN, beyond
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.ground import as_known
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis, searched_fields
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Label, Suspect
from hdrive_mbs.diagnosis.tasks import CONVERGED, FINE, Found, Task, further, rivalling
from hdrive_mbs.diagnosis.verdict import left
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.network import Network

STEPS = 8
"""Joint steps of another law or place."""
STARTS = 2
"""Of another law of the best label, from the values of each of its best two laws: what one of them leaves open, another may tell.  Where a
crack opens at a phase of its own, its side is known but for half a turn, and from the wrong one a steep crack shrank to nothing (c04 of our
own 23rd rotor set, labels open)."""
NEXT = 0.02
"""Share of what the best label takes of the misfit by which the next one may lie behind for its other laws to be tried too."""
BENT = 3.0
"""Prior standard deviations of a parameter from which on it is suspected whatever a look shows."""
RIVALS, PATIENT = 2, 40
"""Labels whose best laws are fitted to the end, and steps that they may take."""
ALIKE = 1.0
"""Log-likelihood within which a law has come out as good as one that acts exactly as it does."""
AGAIN = 2
"""Of the best laws that are fitted again from the data sheet's values."""


def restarts(found: Sequence[Found], least: float) -> list[tuple[Suspect, Task]]:
    """The best laws again, with what was found for them and the data sheet's values for all else, where they leave something."""
    tasks = []
    for item in sorted(found, key=lambda item: item.fitted.cost)[:AGAIN]:
        if item.fitted.chi_fit > least:
            hypothesis, z = item.fitted.hypothesis.rescaled(item.fitted.z)
            tasks.append((item.suspect, Task(hypothesis, as_known(hypothesis, z), None, CONVERGED, FINE)))
    return tasks


def bent(base: Fitted, everything: Sequence[Suspect]) -> list[tuple[Suspect, Task]]:
    """Parameters that a fitted model has moved far, let loose: where they stand at the end of what they may, a look shows little of it."""
    far = {item.name for item, z in zip(base.hypothesis.factors, base.hypothesis.nominal_part(base.z), strict=True) if abs(z) > BENT}
    return [
        (suspect, Task(suspect.all[0], suspect.all[0].start(base.hypothesis.nominal_part(base.z)), None, CONVERGED, FINE, hops=1))
        for suspect in everything
        if suspect.law == PARAMETER and far & (set(suspect.all[0].loose) - set(base.hypothesis.loose))
    ]


def unfinished(found: Sequence[Found]) -> list[tuple[Suspect, Task]]:
    """The best laws of the first two labels that may still get better: a choice between places is one between fits to the end.

    Where the best leaves something, those that have ended go on with patience: in a valley that bends a step may gain little at first.
    """
    first: dict[Label, Found] = {}
    for item in found:
        first.setdefault(item.suspect.label, item)
    best = list(first.values())[:RIVALS]
    patient = bool(best) and left(best[0].fitted) > SEEN
    tasks = [
        (item.suspect, further(item.fitted, PATIENT, beat=None if item is best[0] else rivalling(best[0].fitted), patient=patient))
        for item in best
        if not beyond(item.fitted, best[0].fitted)
    ]
    return [(suspect, task) for suspect, task in tasks if task.done is None]


def other_laws(found: Sequence[Found], base: Fitted, everything: Sequence[Suspect]) -> list[tuple[Suspect, Task]]:
    """Laws of the best label that were not fitted yet, with the values of those that were in fields of the same name."""
    if not found or found[0].suspect.law == PARAMETER:
        return []
    best, known = found[0].fitted, {(item.suspect.label, item.suspect.law) for item in found}
    fits = [item.fitted for item in found if item.suspect.label == found[0].suspect.label]
    told = [_values(fits), _values([*fits[1:2], *fits])]
    tasks = []
    for suspect in everything:
        if suspect.label != found[0].suspect.label or suspect.law == PARAMETER or (suspect.label, suspect.law) in known:
            continue
        made: dict[Effect, Hypothesis] = {}
        for values in told:
            some: dict[Effect, Hypothesis] = {}
            for start in suspect.all:
                *before, last = start.added
                effect = with_values(last.effect, values)
                some.setdefault(effect, Hypothesis(start.factors, (*before, Added(effect, last.at, last.name)), start.loose))
            made |= dict(list(some.items())[:STARTS])
        tasks += [(suspect, _from(best, base, start)) for start in made.values()]
    return tasks


def laws_of_the_next(found: Sequence[Found], base: Fitted, everything: Sequence[Suspect]) -> list[tuple[Suspect, Task]]:
    """The same for the next label, where it takes nearly as much of the misfit as the best.

    What leads there may be a law with more freedom that stands for a better one of the next label: friction over the angle of a motor left
    a mean square of 3.4 of 800 of what its fit saw, friction of its speed that knows no asymmetry 3.3, and the laws of friction that do
    were not tried (c11 of our own twenty-ninth drive set, labels open).
    """
    if not found:
        return []
    rest = [item for item in found if item.suspect.label != found[0].suspect.label]
    if not rest or base.cost - rest[0].fitted.cost < (1.0 - NEXT) * (base.cost - found[0].fitted.cost):
        return []
    return other_laws(rest, base, everything)


def twins(found: Sequence[Found], base: Fitted, everything: Sequence[Suspect], simulator: Simulator) -> list[tuple[Suspect, Task]]:
    """Laws under other names that act as the best one does (``Effect.twins``) or does at an end of its range (``Effect.limits``), from what
    it found, as far as they have not come out as good.

    A crack that the moment does not move is a keyway: of a keyway, which did not show in the first look, it took all with a number more
    (c02 of our own 23rd rotor set, labels open).
    """
    if not found or found[0].suspect.law == PARAMETER or not found[0].fitted.hypothesis.added:
        return []
    best = found[0].fitted
    cause = best.hypothesis.rescaled(best.z)[0].added[-1]
    network = simulator.trials[0].scene.network()
    senses = {body.name: body.sense for body in network.bodies}
    here = {suspect.law: suspect for suspect in everything if suspect.law != PARAMETER and suspect.all[0].added[-1].at == cause.at}
    alike = list(cause.effect.twins(senses.get(network.places.get(cause.at, cause.at), 1)))
    limits = [here[kind.__name__].all[0].added[-1].effect for kind in type(cause.effect).limits if kind.__name__ in here]
    alike += [with_values(effect, values_of(cause.effect)) for effect in limits]
    tasks = []
    for effect in alike:
        suspect = here.get(type(effect).__name__)
        if suspect is None or any(item.suspect.label == suspect.label and item.fitted.cost < best.cost + ALIKE for item in found):
            continue
        old = suspect.all[0]
        added = (*old.added[:-1], Added(effect, cause.at, old.added[-1].name))
        tasks.append((suspect, _from(best, base, Hypothesis(old.factors, added, old.loose))))
    return tasks


def _values(fits: Sequence[Fitted]) -> dict[str, float]:
    """What fits found for the searched fields of their last effects, the first one that has a field.

    fits : best first
    """
    values: dict[str, float] = {}
    for fitted in fits:
        values = values_of(fitted.hypothesis.rescaled(fitted.z)[0].added[-1].effect) | values
    return values


def values_of(effect: Effect) -> dict[str, float]:
    """Its searched fields."""
    return {name: getattr(effect, name) for name in searched_fields(type(effect))}


def with_values(effect: Effect, values: Mapping[str, float]) -> Effect:
    """An effect with given values in searched fields of the same name; as it is where they do not go together."""
    shared = searched_fields(type(effect)).keys() & values.keys()
    try:
        return effect.replacing(**{name: values[name] for name in shared})
    except ParameterError:
        return effect


def with_choices(effect: Effect, other: Effect) -> Effect:
    """An effect with what another one has in fields that are in the ``starts`` of both and not searched, like the order of an error; as it
    is where they do not go together."""
    names = (type(effect).starts.keys() & type(other).starts.keys()) - searched_fields(type(effect)).keys()
    try:
        return effect.replacing(**{name: getattr(other, name) for name in names})
    except ParameterError:
        return effect


def elsewhere(best: Found | None, base: Fitted, everything: Sequence[Suspect], simulator: Simulator) -> list[tuple[Suspect, Task]]:
    """The law that did best with the values that it found, at the other places of its family; of a parameter the others, in place of it."""
    if best is None:
        return []
    if best.suspect.law == PARAMETER:
        return _other_parameters(best, base, everything)
    fitted, network = best.fitted, simulator.trials[0].scene.network()
    tasks = []
    for suspect in everything:
        if suspect.law != best.suspect.law or suspect.label == best.suspect.label:
            continue
        task = _moved_to(suspect, fitted, fitted, base, network)
        tasks.append((suspect, replace(task, leading=fitted.chi_fit, beat=rivalling(fitted))))
    return tasks


def others_there(found: Sequence[Found], base: Fitted, everything: Sequence[Suspect], simulator: Simulator) -> list[tuple[Suspect, Task]]:
    """The best laws of other families, with the values that they found at other places, at the place of the best, where they were not
    fitted.

    On a stiff shaft a torque shows nearly alike at each place, and of a family two places are looked at closer: the wrong ones of friction
    of the load, whose rival, a friction by angle, was tried at the load in the end and left 1.016 where that of the load leaves 0.995 (c06
    of our own twenty-fourth drive set, labels open).

    found : fitted laws, best first
    """
    if not found or found[0].suspect.law == PARAMETER:
        return []
    best, place = found[0], found[0].suspect.label[1]
    here = {(suspect.label[0], suspect.law): suspect for suspect in everything if suspect.label[1] == place}
    known = {item.suspect.label for item in found}
    families = {best.suspect.label[0]}
    network = simulator.trials[0].scene.network()
    tasks = []
    for item in found:
        suspect = here.get((item.suspect.label[0], item.suspect.law))
        if item.suspect.law == PARAMETER or suspect is None or suspect.label in known or suspect.label[0] in families:
            continue
        families.add(suspect.label[0])
        task = _moved_to(suspect, item.fitted, best.fitted, base, network)
        tasks.append((suspect, replace(task, leading=best.fitted.chi_fit, beat=rivalling(best.fitted))))
    return tasks


def _moved_to(suspect: Suspect, told: Fitted, fitted: Fitted, base: Fitted, network: Network) -> Task:
    """A few steps of a law at a place with what its fit at another place told, from the parameters of a fit."""
    there = told.hypothesis.rescaled(told.z)[0].added[-1]
    old = suspect.all[0]
    *before, last = old.added
    added = (*before, Added(carried(there.effect, last.effect, network, there.at, last.at), last.at, last.name))
    return _from(fitted, base, Hypothesis(old.factors, added, old.loose))


def _other_parameters(best: Found, base: Fitted, everything: Sequence[Suspect]) -> list[tuple[Suspect, Task]]:
    """Other parameters let loose in place of the best one, all that it has bent brought back towards the data sheet.

    Two stiffnesses in series stand for each other: that of a flexspline left 1.02 where that of the output shaft, 1.27 times the nominal
    one, leaves 1.00 and did not show in a look (c15 of our own eighteenth drive set, labels open).
    """
    fitted = best.fitted
    tasks = []
    for suspect in everything:
        if suspect.law == PARAMETER and suspect.label != best.suspect.label:
            task = _from(fitted, base, suspect.all[0])
            tasks.append((suspect, replace(task, z=as_known(task.hypothesis, task.z), beat=rivalling(fitted))))
    return tasks


def _from(fitted: Fitted, base: Fitted, hypothesis: Hypothesis) -> Task:
    """A few steps of a hypothesis from the parameters of another one's fit and the causes of the base."""
    z = hypothesis.start(fitted.hypothesis.nominal_part(fitted.z))
    z[base.hypothesis.nominal_size : base.hypothesis.size] = base.z[base.hypothesis.nominal_size :]
    return Task(hypothesis, z, None, STEPS, FINE)
