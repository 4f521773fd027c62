"""What was found for a law at one place, for another place where it is tried."""

from __future__ import annotations

from hdrive_mbs.diagnosis.hypothesis import searched_fields
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.elements import Connection
from hdrive_mbs.network.network import Network

SAME = ("1", "s", "1/s")
"""Units of what is the same on both sides of a gear: exponents, shares and times.  What is in rad or rad/s may be or not (a phase and a
frequency are, a play and a speed of friction are not)."""


def carried(effect: Effect, own: Effect, network: Network, at: str, to: str) -> Effect:
    """An effect as it is found at a place, for another one: all of it where both turn alike, across a gear what is the same on both sides.

    A gear of ratio n divides angles by n and multiplies torques by it, so that compliances differ by n^2: what was found for an input
    shaft that creeps, 2.3e-3 rad/(N m), is 4,300 times that of the output shaft which did creep, and no fit came down from there; from
    the least typical one it takes 11 steps (an own case, `--bench drive --unlisted --cases 20 --seed 301`, c16; by a script that is not
    kept).

    own : with what it begins with at the other place
    """
    before, after = turns(network, at), turns(network, to)
    if before is None or after is None or abs(before) == abs(after):
        return effect
    values = {name: getattr(effect, name) for name, quantity in searched_fields(type(effect)).items() if quantity.unit in SAME}
    try:
        return own.replacing(**values)
    except ParameterError:
        return own


def turns(network: Network, at: str) -> float | None:
    """Ideal speed of a place per speed of the driving motor; None where it does not turn, like a sensor.

    A connection turns as its bodies do, a gear as the one whose turning is its twist.
    """
    ratios = {body.name: body.ratio for body in network.bodies if not body.lateral}
    body = network.places.get(at, at)
    if body in ratios:
        return ratios[body]
    element = next((item for item in network.elements if isinstance(item, Connection) and item.name == at), None)
    if element is None:
        return None
    weights = {name: abs(factor) for name, factor in element.factors.items() if name in ratios}
    return ratios[max(weights, key=lambda name: weights[name])] if weights else None
