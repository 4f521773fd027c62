"""What is tried where the gap of a rotor line lies: laws with a period, begun at orders of the force that is missing there.

Such a law shows in a first look where its period is nearly right alone, and residuals give that poorly: they stand out where the line
resonates.  The place of the gap asks for no law, and the force there knows no resonance.
"""

from __future__ import annotations

from collections.abc import Sequence

from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.force_orders import ForceOrders
from hdrive_mbs.diagnosis.located import Located
from hdrive_mbs.diagnosis.periods import Periods
from hdrive_mbs.diagnosis.result import NOWHERE
from hdrive_mbs.diagnosis.search import Depth, Report, search
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team

SURE = 0.5
"""Probability of a place from which its laws are tried."""
CLOSE = Depth(brief=(1, 2), laws=4, picked=3, kept=(1, 2), serious=1, again=False)
"""How far that search goes."""


def at_the_place(
    team: Team, coarse: Simulator, base: Fitted, gap: Located, tried: Sequence[Candidate], report: Report
) -> tuple[Found, ...]:
    """Laws with a period at the place where the gap most probably lies, fitted; none where no place is likely enough."""
    if not gap.places or gap.places[0].at == NOWHERE or gap.places[0].probability < SURE:
        return ()
    there = [item for item in those_at(gap.places[0].at, tried) if item.kind.periodic]
    if not there:
        return ()

    def begin(simulator: Simulator, fitted: Fitted) -> ForceOrders:
        return ForceOrders(gap.turned, Periods(simulator, fitted))

    return search(team, coarse, base, {}, there, depth=CLOSE, begin=begin, report=report).found


def those_at(place: str, tried: Sequence[Candidate]) -> list[Candidate]:
    """Laws that act where a source of the localisation lies: between ring and housing, on a housing, at a station or section."""
    part, _, side = place.partition(".")
    if side:
        kind = {"law": "bearing", "housing": "support"}.get(side)
        return [item for item in tried if item.at == part and item.kind.acts_on == kind]
    return [item for item in tried if item.at == place]
