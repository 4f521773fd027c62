"""What is tried where the gap of a rotor line lies: laws with a period or a resonance of their own.

Such a law shows in a first look where its period is nearly right alone, and residuals give that poorly: they stand out where the line
resonates.  The place of the gap asks for no law, and the force there knows no resonance: periods begin at its orders.  Resonances of
what is not seen begin closer together than where all places are looked at.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.force_orders import ForceOrders
from hdrive_mbs.diagnosis.hypothesis import Added, searched_fields
from hdrive_mbs.diagnosis.located import Located
from hdrive_mbs.diagnosis.periods import Periods
from hdrive_mbs.diagnosis.result import NOWHERE
from hdrive_mbs.diagnosis.search import Depth, search
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.stages import Report
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team

SURE = 0.5
"""Probability of a place from which its laws are tried."""
CLOSER = 1.2
"""Quotient of neighbouring starts of a resonance: a look finds one from a start that is a tenth off."""
CLOSE = Depth(brief=(1, 2), laws=4, picked=3, kept=(1, 2), serious=1, again=False)
"""How far that search goes."""


def at_the_place(
    team: Team, coarse: Simulator, base: Fitted, gap: Located, tried: Sequence[Candidate], report: Report
) -> tuple[Found, ...]:
    """Laws with a period or a resonance at the place where the gap most probably lies, fitted; none where no place is likely enough."""
    if not gap.places or gap.places[0].at == NOWHERE or gap.places[0].probability < SURE:
        return ()
    there = [found for item in those_at(gap.places[0].at, tried) if (found := item if item.kind.periodic else closer(item)) is not None]
    if not there:
        return ()

    def begin(simulator: Simulator, fitted: Fitted) -> ForceOrders:
        return ForceOrders(gap.turned, Periods(simulator, fitted))

    return search(team, coarse, base, {}, there, depth=CLOSE, begin=begin, report=report).found


def closer(item: Candidate) -> Candidate | None:
    """A law of something that swings unseen with starts closer together along its frequency; None for any other law."""
    shapes = searched_fields(item.kind)
    fields = [name for name in item.kind.decisive if name in shapes and (shapes[name].typical or (0.0,))[0] > 0.0]
    if item.kind.kind != "hidden state" or not fields:
        return None

    def between(starts: tuple[Added, ...]) -> tuple[Added, ...]:
        for name in fields:
            values = sorted({float(getattr(start.effect, name)) for start in starts})
            low, high = shapes[name].typical or (values[0], values[-1])
            alike = {start.effect.replacing(**{name: values[0]}): start for start in starts}  # starts that differ in the rest
            wide = _filled(sorted({min(low, values[0]), *values, max(high, values[-1])}))
            effects = [effect.replacing(**{name: value}) for effect in alike for value in wide]
            starts = tuple(Added(effect, starts[0].at, starts[0].name) for effect in effects)
        return starts

    return replace(item, starts=between(item.starts), first=between(item.first))


def _filled(values: Sequence[float]) -> list[float]:
    """Values with others between them, in even steps of a logarithmic scale."""
    found = [values[0]]
    for low, high in itertools.pairwise(values):
        count = max(1, math.ceil(math.log(high / low) / math.log(CLOSER)))
        found += [low * (high / low) ** (k / count) for k in range(1, count + 1)]
    return found


def those_at(place: str, tried: Sequence[Candidate]) -> list[Candidate]:
    """Laws that act where a source of the localisation lies: between ring and housing, on a housing, at a station or section."""
    part, _, side = place.partition(".")
    if side:
        kind = {"law": "bearing", "housing": "support"}.get(side)
        return [item for item in tried if item.at == part and item.kind.acts_on == kind]
    return [item for item in tried if item.at == place]
