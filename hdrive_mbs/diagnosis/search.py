"""The search for what is missing: nominal fit, quick looks at everything, joint fits of the best, evidence."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from hdrive_mbs.diagnosis.beginnings import begun_at, beside, widths_of
from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.choosing import SEEN, above_noise, beyond, enough, leaves, not_begun, passed_over, picked, spread_out, worth
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.force_orders import StandsOut
from hdrive_mbs.diagnosis.from_the_best import bent, elsewhere, laws_of_the_next, other_laws, others_there, restarts, twins, unfinished
from hdrive_mbs.diagnosis.ground import held, is_bent, screen_from
from hdrive_mbs.diagnosis.hops import settled
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.other_starts import from_other_starts, going_on
from hdrive_mbs.diagnosis.periods import Periods
from hdrive_mbs.diagnosis.reached import Reached, begun_near, reaches
from hdrive_mbs.diagnosis.scans import fits_from, scan, worth_a_scan
from hdrive_mbs.diagnosis.screening import Look, Screen
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.stages import Report
from hdrive_mbs.diagnosis.suspects import PARAMETER, Label, Suspect, at_first, simplest, suspects
from hdrive_mbs.diagnosis.tasks import CONVERGED, FINE, NEAR, Found, Task, cheapest, further, rivalling, run_task, scored, those_that_ran
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.diagnosis.verdict import ODDS, left, stands
from hdrive_mbs.errors import AnalysisError

Begin = Callable[[Simulator, Fitted], StandsOut]

FAR = 1.3
"""Mean square of a fitted model above which everything is looked at with held parameters too (see ground.py)."""
SECOND_LOOKS = 40
"""Of the labels that looked best from there, which are looked at again then."""
COARSE = 3e-3
"""Relative change of the cost that ends the fit of the nominal model, whose misfit may have no explanation in it."""
STEPS = 3
"""Joint steps before the last choice."""
HOPS = 3
"""Hops out of hollows for the nominal model, which everything else is held against."""
ENOUGH = 1.1
"""Mean square that ends the search; see ``enough``."""
TAKEN = 0.25
"""Share of what the base leaves above noise: where a second cause takes it from held parameters, none is looked for from bent ones."""


@dataclass(frozen=True)
class Depth:
    """How far a search goes.

    brief : labels that are looked at closer, at least and at most;  laws : of each that get joint steps (1: no closer look)
    picked : laws that get joint steps at most, from each ground
    kept : laws that are fitted on, at least and at most;  serious : how many of them to the end, besides all laws of the best label
    again : whether all is done again with held parameters where it leaves something
    held : whether a search with one law of each label begins with held parameters where those of the base are bent
    """

    brief: tuple[int, int] = (4, 10)
    laws: int = 3
    picked: int = 10
    kept: tuple[int, int] = (3, 6)
    serious: int = 2
    again: bool = True
    held: bool = True


@dataclass(frozen=True, eq=False)
class Search:
    """What a search found.

    base : the model without the suspects, refitted;  found : fitted laws, best first, several of one label
    looks : cost of the first look at each law
    """

    base: Fitted
    found: tuple[Found, ...]
    looks: Mapping[str, float] = field(default_factory=dict)

    @property
    def labels(self) -> tuple[Found, ...]:
        """The best law of each label, best first."""
        best: dict[Label, Found] = {}
        for item in self.found:
            best.setdefault(item.suspect.label, item)
        return tuple(best.values())


def fit_nominal(simulator: Simulator, factors: Sequence[Factor]) -> Fitted:
    """The nominal model, refitted.  Raises AnalysisError where it cannot be simulated."""
    nominal = Hypothesis(factors=tuple(factors))
    residuals = simulator.residuals(nominal, [np.zeros(nominal.size)])[0]
    if residuals is None:
        raise AnalysisError("The nominal scene cannot be simulated through the records; look at its start values and inputs.")
    fitted = fit(simulator, nominal, np.zeros(nominal.size), steps=40, share=COARSE, begin=residuals)
    return settled(simulator, fitted, HOPS) if fitted.chi_fit < NEAR else fitted


def search(
    team: Team,
    simulator: Simulator,
    base: Fitted,
    groups: Mapping[str, Sequence[str]],
    tried: Sequence[Candidate],
    *,
    depth: Depth | None = None,
    begin: Begin = Periods,
    explained: Callable[[Search], bool] | None = None,
    report: Report | None = None,
) -> Search:
    """Look at everything that may be missing from a fitted model, and fit the best together with its parameters.

    One simple law stands for each label in the first look.  The best labels are looked at with all laws and starts,
    the best of those get a few joint steps with their own Jacobians, and the best of these are fitted to the end.  Where the base
    is far from the records and the best leaves something, parameters are tried all along their range too (scans.py).
    Where they leave something, the places of their families that were passed over are fitted too.
    Where these leave something, the other laws of the best label are tried from its values, and all of them begin again from other
    values of what decides whether they show (other_starts.py).
    The best are fitted to the end then, with patience where they leave something (``unfinished``).
    Where all of them leave something, the same is done with the likeliest, the parameters held near the values of the data sheet.
    What came out best is then tried at all other places where it may sit, from the values found; in a shallow search only where it
    leaves much.  Where it leaves more than noise does, the other families that were fitted are tried at its place, and where it leaves
    something, laws that the best label has not been tried with: of two laws that stood for a friction at the wrong end of a shaft the one
    that came nearer there is not the right one.
    A shallow search begins with held parameters where those of the base are bent.

    begin : of the simulator and a fitted model, what says where laws with a period begin
    explained : asked where the best leaves something, before all is done again: whether what was found so far explains all in another way
    """
    how = depth or Depth()
    work = _Work(team, simulator, report or (lambda stage, done, total: None), how, begin)
    everything = suspects(base.hypothesis, groups, tried)
    found, first = (
        work.from_grounds(base, everything)
        if how.laws == 1 and how.held
        else work.from_ground(base, base, everything, far=base.chi_fit > NEAR)
    )
    found = work.other_ways(found, base, everything)
    if how.laws > 1:
        found = work.to_the_end(found)
    looks = {f"{suspect.law} at {suspect.label[1]}": cost for suspect, cost in first}
    inexact = how.laws > 1 and how.again and base.chi_fit > FAR and not any(item.fitted.typical < enough(base, ENOUGH) for item in found)
    done = inexact and explained is not None and explained(_ranked(found, base, looks))
    if inexact and not done and not team.deadline.passed("everything from parameters held near the data sheet"):
        likely = {suspect.label for suspect, _ in first[:SECOND_LOOKS]}
        more, _ = work.from_ground(held(simulator, base), base, [item for item in everything if item.label in likely or item.is_periodic])
        found = work.other_ways(cheapest([*found, *more]), base, everything)
    if not done and (how.laws > 1 or (found and found[0].fitted.chi_fit > FAR)):
        moved = elsewhere(found[0] if found else None, base, everything, simulator)
        again = restarts(found, FAR) if how.laws > 1 and how.again else []
        found = cheapest([*found, *work.fitted([*moved, *again], "trying the best elsewhere")])
        if how.laws > 1 and found and left(found[0].fitted) > above_noise(simulator):
            found = cheapest([*found, *work.fitted(others_there(found, base, everything, simulator), "trying other causes there")])
        if how.laws > 1 and found and left(found[0].fitted) > SEEN:
            found = cheapest([*found, *work.fitted(other_laws(found, base, everything), "trying other laws there")])
        found = work.to_the_end(found)
    if how.laws > 1 and base.chi_fit < NEAR:
        found = cheapest([*found, *work.fitted(bent(base, everything), "fitting parameters that the nominal model has bent")])
    found = cheapest([*found, *work.fitted(twins(found, base, everything, simulator), "trying laws that act alike")])
    return _ranked(found, base, looks)


def _ranked(found: Sequence[Found], base: Fitted, looks: Mapping[str, float]) -> Search:
    final = sorted((scored(item, base) for item in found), key=lambda item: -item.log_odds)
    return Search(base=base, found=tuple(final), looks=looks)


def is_inexact(found: Sequence[Found], base: Fitted) -> bool:
    """Whether the best law leaves something, or so much of a faint gap that it would not be claimed although it shows.

    What no fit saw counts too: lost motion of a gear left 1.21 of what its fit saw and 3.7 of the rest, where a law with a soft windup
    leaves 1.01 and 1.09 (c18 of our own thirteenth drive set, opened).
    """
    if not found:
        return False
    shows = scored(found[0], base).log_odds > ODDS and not stands(found[0], left(base))
    return shows or max(found[0].fitted.chi_fit, left(found[0].fitted)) >= enough(base, ENOUGH)


@dataclass(frozen=True, eq=False)
class _Work:
    """Who does it, on what, and how far it goes; ``_elsewhere`` keeps which laws at which places were begun elsewhere already."""

    team: Team
    simulator: Simulator
    said: Report
    how: Depth
    begin: Begin
    _elsewhere: set[tuple[Label, str]] = field(default_factory=set)

    def scanned(self, everything: Sequence[Suspect], found: Sequence[Found]) -> list[Found]:
        """Parameters tried all along their range, the best of them fitted from there as far as they may catch up with what was found."""
        some = worth_a_scan(everything)
        looks = self.team.map(scan, self.simulator, some, partial(self.said, "trying parameters along their range"))
        beat = rivalling(found[0].fitted) if found else None
        asked = fits_from(list(zip(some, looks, strict=True)), beat)
        return cheapest(self.fitted(asked, "fitting parameters from where they came out best"))

    def from_grounds(self, base: Fitted, everything: Sequence[Suspect]) -> tuple[list[Found], list[tuple[Suspect, float]]]:
        """From a base whose parameters a missing cause has bent first with these held, and from where they are if nothing came out there.

        What is missing beside a strong cause shows little from bent parameters.  From held ones its look alone may leave less than the
        base does: in an open pair (a bow and a cross coupling) it did by a tenth, and from bent ones it was not among the first fourteen.
        """
        if not is_bent(base):
            return self.from_ground(base, base, everything)
        found, first = self.from_ground(held(self.simulator, base), base, everything)
        if found and found[0].fitted.cost < base.cost - TAKEN * (base.cost - 0.5 * np.count_nonzero(self.simulator.fit)):
            return found, first
        more, looks = self.from_ground(base, base, everything)
        return cheapest([*found, *more]), looks

    def from_ground(
        self, model: Fitted, base: Fitted, everything: Sequence[Suspect], *, far: bool = False
    ) -> tuple[list[Found], list[tuple[Suspect, float]]]:
        """What is found from a model at some point, and the cost of the first looks, both best first.

        far : whether a parameter may be so far off that looks do not see it, and is tried along its range where the best leaves something
        """
        screen = screen_from(self.simulator, model)
        everything = self._begun(at_first(everything), model)
        simple = simplest(everything)
        plain = Suspect(("none", ""), "none", (model.hypothesis,), (model.hypothesis,))
        first = self._looked(screen, [plain, *simple], [item.first for item in (plain, *simple)], "looking at candidates")
        before = min([model.cost, *(look.cost for suspect, look in first if suspect is plain)])
        first = [pair for pair in first if pair[0] is not plain]
        spread = spread_out(first)
        chosen = [suspect.label for suspect, _ in spread[: worth(before, [look.cost for _, look in spread], self.how.brief)]]
        closer = [pair for pair in first if pair[0].label in chosen]
        if self.how.laws > 1:
            done = [suspect for suspect, _ in closer if suspect.is_looked_at_whole]
            laws = [item for item in everything if item.label in chosen and item not in done]
            closer = cheapest_looks([*closer, *self._looked(screen, laws, [item.all for item in laws], "looking closer")])
        best = picked(closer, laws=self.how.laws)[: self.how.picked]
        tasks = [(suspect, Task(look.hypothesis, look.z, look.residuals, STEPS, FINE)) for suspect, look in best]
        brief = cheapest(self.fitted(tasks, "a few joint steps"))
        scanning = far and (not brief or brief[0].fitted.typical > ENOUGH)
        if scanning:
            brief = cheapest([*brief, *self.scanned(everything, brief)])
        kept = brief[: worth(base.cost, [item.fitted.cost for item in brief], self.how.kept)]
        thorough = [
            (k < self.how.serious or item.suspect.label == kept[0].suspect.label) and not beyond(item.fitted, kept[0].fitted)
            for k, item in enumerate(kept)
        ]
        rival = rivalling(kept[0].fitted) if kept else None
        further_ = [
            further(item.fitted, CONVERGED if end else STEPS, hops=int(end), beat=None if item is kept[0] else rival)
            for item, end in zip(kept, thorough, strict=True)
        ]
        found = cheapest(self.fitted([(item.suspect, task) for item, task in zip(kept, further_, strict=True)], "fitting the best"))
        if far and not scanning and (not found or found[0].fitted.typical > SEEN):
            found = cheapest([*found, *self.scanned(everything, found)])
        if found and leaves(found[0].fitted.typical, base, ENOUGH) and not self.team.deadline.passed("laws and places passed over"):
            asked = [*not_begun(found, closer, best), *passed_over(found, first, chosen)]
            found = cheapest([*found, *self._others(asked, rivalling(found[0].fitted))])
        return found, [(suspect, look.cost) for suspect, look in first]

    def other_ways(self, found: list[Found], base: Fitted, everything: Sequence[Suspect]) -> list[Found]:
        """What was found and, where it leaves something, the other laws of the best label, and these laws begun elsewhere.

        Those that came nearest in their first steps from other values of what decides whether they show, and the one that these steps bring
        down most, are fitted on, as far as they are not hopeless beside the best.  Where the best leaves nothing, its laws begin in the
        hollows alone that they name beside what was found: in a short record the wrong one of them may leave next to nothing.
        """
        inexact = is_inexact(found, base)
        if inexact:
            found = cheapest([*found, *self.fitted(other_laws(found, base, everything), "trying other laws of the best")])
            if is_inexact(found, base) and self.how.laws > 1:
                asked = laws_of_the_next(found, base, everything)
                found = cheapest([*found, *self.fitted(asked, "trying laws of the next best")])
        asked = from_other_starts(found, everything, self._elsewhere, near=not inexact)
        if asked and inexact and self.team.deadline.passed("laws of the best cause begun elsewhere"):
            return found
        self._elsewhere.update((suspect.label, suspect.law) for suspect, _ in asked)
        begun = self.fitted(asked, "beginning the best elsewhere")
        near = [item for item in begun if not beyond(item.fitted, found[0].fitted)]
        beat = rivalling(found[0].fitted) if found else None
        going = [(item.suspect, further(item.fitted, 2 * STEPS, beat=beat)) for item in going_on(near, self.how.serious, 2 * STEPS)]
        return cheapest([*found, *begun, *self.fitted(going, "fitting on from there")])

    def to_the_end(self, found: list[Found]) -> list[Found]:
        """With the best of what was found fitted to the end."""
        return cheapest([*found, *self.fitted(unfinished(found), "fitting the best")])

    def _others(self, looks: Sequence[tuple[Suspect, Look]], beat: float) -> list[Found]:
        """A few joint steps from looks that had been left aside, and the best of them fitted to the end if they come down to a cost."""
        tasks = [(suspect, Task(look.hypothesis, look.z, look.residuals, STEPS, FINE, beat=beat)) for suspect, look in looks]
        brief = cheapest(self.fitted(tasks, "other places of the best"))
        best = [(item.suspect, further(item.fitted, beat=beat)) for item in brief[: self.how.serious]]
        return [*brief[len(best) :], *self.fitted(best, "fitting the best")]

    def _begun(self, everything: Sequence[Suspect], model: Fitted) -> list[Suspect]:
        """Laws with a period begin at those that stand out in what the model leaves, those that show beyond a distance near the largest one
        too."""
        periods, reached = self.begin(self.simulator, model), Reached(self.simulator, model)
        return [_near(_begun(item, periods) if item.is_periodic else item, reached) for item in everything]

    def fitted(self, asked: Sequence[tuple[Suspect, Task]], words: str) -> list[Found]:
        """Suspects with their tasks done; those that cannot be run from where they begin are left out."""
        fits = self.team.map(run_task, self.simulator, [task for _, task in asked], partial(self.said, words))
        return those_that_ran([suspect for suspect, _ in asked], fits)

    def _looked(
        self, screen: Screen, asked: Sequence[Suspect], starts: Sequence[tuple[Hypothesis, ...]], words: str
    ) -> list[tuple[Suspect, Look]]:
        """Looks at suspects, cheapest misfit first; those that cannot be run are left out."""
        questions = [(some, item.widths) for item, some in zip(asked, starts, strict=True)]
        answers = self.team.map(_look, screen, questions, partial(self.said, words))
        return by_cost([(suspect, look) for suspect, look in zip(asked, answers, strict=True) if look is not None])


def by_cost(looks: Sequence[tuple[Suspect, Look]]) -> list[tuple[Suspect, Look]]:
    """Looks, cheapest misfit first."""
    return sorted(looks, key=lambda pair: pair[1].cost)


def cheapest_looks(looks: Sequence[tuple[Suspect, Look]]) -> list[tuple[Suspect, Look]]:
    """The cheapest look at each suspect, cheapest misfit first.

    A closer look begins elsewhere than the first one, at a selection of more starts, and is not always the better one: our own thirteenth
    rotor set (c10, labels open) has a mass on two springs nearly alike, at 900 rad/s, where the selection has another quotient of both.
    """
    best: dict[Suspect, Look] = {}
    for suspect, look in by_cost(looks):
        best.setdefault(suspect, look)
    return list(best.items())


def _begun(item: Suspect, periods: StandsOut) -> Suspect:
    widths = widths_of(item.first[0], periods)
    return replace(item, first=begun_at(item.first, periods), all=begun_at(item.all, periods), widths=widths)


def _near(item: Suspect, reached: Reached) -> Suspect:
    if item.law == PARAMETER or not reaches(item.first[0]):
        return item
    return replace(item, first=begun_near(item.first, reached), all=begun_near(item.all, reached))


def _look(screen: Screen, asked: tuple[tuple[Hypothesis, ...], Mapping[str, float]]) -> Look | None:
    """The best of several starts; of a law with periods also beside those of the best."""
    starts, widths = asked
    found = screen.look(starts)
    if found is None or not widths:
        return found
    closer = screen.look(beside(found.start, widths))
    return closer if closer is not None and closer.cost < found.cost else found
