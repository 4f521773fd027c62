"""Whether a gap lies at another place than what is claimed for it."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from hdrive_mbs.network.elements import Connection
from hdrive_mbs.network.network import Network

if TYPE_CHECKING:
    from hdrive_mbs.diagnosis.result import Place

NOWHERE = "nowhere"
"""Name, among places, for an unknown signal at none of them."""
LEAVES = 1.02
"""Times the noise (root mean square, on what no fit saw) that a claim has to leave for its place to be doubted.  Below it a law that fits
speaks for its place: in our own opened sets, of claims that a place located as surely as below contradicts, 10 of 12 that leave less are
right and 2 of 10 that leave more (tests/unit/test_elsewhere_constants.py)."""
SURE, EXCLUDED = 0.99, 0.01
"""Probability of a place from which a gap lies there, and up to which it does not, against a law that fits nearly."""


def somewhere_else(places: Sequence[Place], at: Collection[str], sure: float, excluded: float) -> Place | None:
    """The likeliest place, if that is as sure as this and all of ``at`` are excluded.

    places : of a localisation, most probable first;  at : parts of the scene;  sure, excluded : probabilities
    """
    own = max((place.probability for place in places if part_of(place.at) in at), default=0.0)
    first = places[0] if places else None
    return None if first is None or first.at == NOWHERE or first.probability < sure or own > excluded else first


def elsewhere(places: Sequence[Place], at: Collection[str], left: float, acted_on: Collection[str] = ()) -> Place | None:
    """Where a gap lies though nothing that is claimed sits there; None where the claim leaves noise, or the place is not as sure.

    An error of a sensor is no such place: it explains what its column shows of anything that stands in front of it.

    places : of a localisation, most probable first;  at : parts of the scene with a claimed cause;  left : times the noise that is left
    acted_on : parts that what is claimed acts on: see ``wave_generators``
    """
    found = somewhere_else(places, at, SURE, EXCLUDED) if at and left > LEAVES else None
    return None if found is None or found.sensor or part_of(found.at) in acted_on else found


def wave_generators(network: Network, at: Collection[str]) -> frozenset[str]:
    """Parts that turn the wave generator of a gear at which something is claimed.

    Friction of the teeth brakes the wave generator, where it is located without a law: with 13 of 13 right claims of it in our own opened
    sets, whatever they leave (tests/unit/test_elsewhere_constants.py).
    """
    gears = [item for item in network.elements if isinstance(item, Connection) and part_of(item.name) in at]
    return frozenset(part_of(item.flanges["wave_generator"]) for item in gears if "wave_generator" in item.flanges)


def part_of(at: str) -> str:
    """The part of the scene that a place belongs to."""
    return at.partition(".")[0]
