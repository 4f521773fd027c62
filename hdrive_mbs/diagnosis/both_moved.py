"""Two causes at once: both of the best pair, where they are of one part, at another part together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.carried import carried
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.pairs import causes_of, nearest, standing_for
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect
from hdrive_mbs.diagnosis.tasks import FINE, FIRST, Found, Task
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.unknowns import Factor


def both_moved(
    team: Team, simulator: Simulator, pairs: Sequence[Found], tried: Sequence[Candidate], everything: Sequence[Suspect]
) -> list[Found]:
    """The best pair with both of its causes at each of the other parts that admit them, where both are of one part.

    One of them alone at the other part is no better than before: the other still holds it where it is.  Drag that falls while a motor
    warms up was taken for the same at the wave generator, a stiff shaft away, beside the drag of the wave generator itself (1.33 of the
    mean square left), and neither went to the motor without the other; together they leave 1.00 there (c19 of our own twenty-eighth
    drive set, labels open).

    A parameter goes to the one of the same name at the other part, as far off as it was.

    pairs : at least one, fitted to the end;  tried : effects and places that are admitted
    everything : suspects without causes beside them
    """
    best = min(pairs, key=lambda item: item.fitted.cost)
    full, z = best.fitted.hypothesis.rescaled(best.fitted.z)
    here = {item.at for item in full.added}
    if len(here) != 1 or len(full.added) + bool(full.loose) != 2:
        return []
    [part] = here
    known = {causes_of(item.fitted.hypothesis) for item in pairs}
    tasks, whose = [], []
    network = simulator.trials[0].scene.network()
    begins = {(item.at, item.kind): item.starts[0].effect for item in tried}
    for place in sorted({item.at for item in tried} - here):
        own = [begins.get((place, type(item.effect))) for item in full.added]
        goes = _counterparts(full, part, place)
        if None in own or goes is None:
            continue
        loose = {goes[name].name: width for name, width in full.loose.items()}
        moves = zip(full.added, filter(None, own), strict=True)
        added = tuple(Added(carried(item.effect, start, network, part, place), place, item.name) for item, start in moves)
        hypothesis = Hypothesis(full.factors, added, loose)
        suspect = _of_parameters(everything, loose) if best.suspect.law == PARAMETER else standing_for(hypothesis)
        if suspect is None or causes_of(hypothesis) in known:
            continue
        nominal = full.nominal_part(z)
        at = {item.name: k for k, item in enumerate(full.factors)}
        for name, other in goes.items():
            nominal[at[other.name]] = nominal[at[name]] * full.factors[at[name]].sigma / other.sigma
            nominal[at[name]] = 0.0
        tasks.append(Task(hypothesis, hypothesis.start(nominal), None, FIRST, FINE))
        whose.append(suspect)
    return nearest(team, simulator, best, tasks, whose, causes_of)


def _counterparts(full: Hypothesis, part: str, place: str) -> Mapping[str, Factor] | None:
    """Name of each loosened parameter -> that of the same fields at another part; None where one is not of this part, or has none there."""
    found = {}
    for factor in full.factors:
        if factor.name not in full.loose:
            continue
        if not all(path.startswith(f"{part}.") for path in factor.nominal):
            return None
        wanted = {f"{place}{path.removeprefix(part)}" for path in factor.nominal}
        other = next((item for item in full.factors if set(item.nominal) == wanted), None)
        if other is None:
            return None
        found[factor.name] = other
    return found


def _of_parameters(everything: Sequence[Suspect], loose: Mapping[str, float]) -> Suspect | None:
    """The suspect that lets loose just these parameters."""
    return next((item for item in everything if item.law == PARAMETER and set(item.all[0].loose) == set(loose)), None)
