"""Where a search cannot tell two places of a law apart: the law at its other places too, so that all that are alike are named."""

from __future__ import annotations

from collections.abc import Sequence

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.from_the_best import elsewhere
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect
from hdrive_mbs.diagnosis.tasks import Found, run_task, those_that_ran
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.verdict import TIED


def tied_places(
    team: Team, simulator: Simulator, base: Fitted, everything: Sequence[Suspect], found: Sequence[Found], likely: Sequence[Found]
) -> tuple[Found, ...]:
    """Each likely law that came out alike at two places, at those of its other places where it was not fitted.

    A search tries the law with the least cost at all places, and the one with the best odds may be another with a number less: dry friction
    of the spin was named at two of four stations of a shaft that is stiff in torsion, without the one where it acts, and all four are
    alike (an own case, `--bench rotor --unlisted --cases 20 --seed 301`, c12).

    base : the refitted nominal model;  everything : suspects without causes beside them
    found : fitted laws, best first;  likely : those of them that go on to all samples
    """
    asked = []
    seen: set[str] = set()
    for best in likely:
        law = best.suspect.law
        if law == PARAMETER or law in seen:
            continue
        seen.add(law)
        alike = [item for item in found if item.suspect.law == law and item.log_odds > best.log_odds - TIED]
        if len(alike) > 1:
            known = {item.suspect.label for item in found if item.suspect.law == law}
            asked += [(suspect, task) for suspect, task in elsewhere(best, base, everything, simulator) if suspect.label not in known]
    return tuple(those_that_ran([suspect for suspect, _ in asked], team.map(run_task, simulator, [task for _, task in asked])))
