"""Networks that follow measured motions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import AppliedTorque
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.network import Motion, Network


def following(network: Network, motions: Mapping[str, Callable[[Value], Value]]) -> Network:
    """The network with places whose forward angles are given functions of time; torques on these places do nothing.

    Raises PlaceError for an unknown place, ParameterError for one that is held already, or a rotor, whose unbalance
    would no longer be shaken.
    """
    if not motions:
        return network
    bodies = {body.name: body for body in network.bodies if not body.lateral}
    rotors = {rotor.coordinates[5] for rotor in network.rotors}
    held: dict[str, Callable[[Value], Value]] = {}
    for place, angle in motions.items():
        if place not in network.places:
            raise unknown_place("place", place, network.places, "This scene")
        name = network.places[place]
        if name not in bodies or name in rotors:
            raise ParameterError(f"{place!r} cannot follow a measured angle: it is {'a rotor' if name in rotors else 'held already'}.")
        held[name] = angle
    made = tuple(Motion(name, angle, bodies[name].sense, bodies[name].ratio) for name, angle in held.items())
    elements = []
    for element in network.elements:
        if isinstance(element, AppliedTorque) and element.coordinate in held:
            continue
        kept = element.without(frozenset(held)) if isinstance(element, MatrixElement) else element
        if not isinstance(kept, MatrixElement) or kept.coordinates:
            elements.append(kept)
    left = tuple(body for body in network.bodies if body.name not in held)
    return replace(network, bodies=left, motions=(*network.motions, *made), elements=tuple(elements))
