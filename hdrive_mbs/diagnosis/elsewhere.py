"""Whether a gap lies at another place than what is claimed for it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from hdrive_mbs.diagnosis.result import Place

NOWHERE = "nowhere"
"""Name, among places, for an unknown signal at none of them."""
LEAVES = 1.02
"""Times the noise (root mean square, on what no fit saw) that a claim has to leave for its place to be doubted.  Below it a law that fits
speaks for its place: of our own opened cases with one claimed place and another one located as surely as below, the claim was right in 10
of 12 that leave less than 1.01, and in 5 of 15 that leave more than this, three of them friction of the gear's mesh, which was located at
the wave generator (benchmarks/withheld/own/README.md)."""
SURE, EXCLUDED = 0.99, 0.01
"""Probability of a place from which a gap lies there, and up to which it does not, against a law that fits nearly."""


def somewhere_else(places: Sequence[Place], at: Collection[str], sure: float, excluded: float) -> Place | None:
    """The likeliest place, if that is as sure as this and all of ``at`` are excluded.

    places : of a localisation, most probable first;  at : parts of the scene;  sure, excluded : probabilities
    """
    own = max((place.probability for place in places if part_of(place.at) in at), default=0.0)
    first = places[0] if places else None
    return None if first is None or first.at == NOWHERE or first.probability < sure or own > excluded else first


def elsewhere(places: Sequence[Place], at: Collection[str], left: float) -> Place | None:
    """Where a gap lies though nothing that is claimed sits there; None where the claim leaves noise, or the place is not as sure.

    An error of a sensor is no such place: it explains what its column shows of anything that stands in front of it.

    places : of a localisation, most probable first;  at : parts of the scene with a claimed cause;  left : times the noise that is left
    """
    found = somewhere_else(places, at, SURE, EXCLUDED) if at and left > LEAVES else None
    return None if found is None or found.sensor else found


def part_of(at: str) -> str:
    """The part of the scene that a place belongs to."""
    return at.partition(".")[0]
