"""Coordinates that nothing ever moves: the axial ones of most lines.

Their vibrations are often the fastest of a line (a light ring between short sections) and set the step of an explicit
method although they stay zero.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from hdrive_mbs.compiled.groups import groups
from hdrive_mbs.expression import Value
from hdrive_mbs.network.coupling import Gyroscope
from hdrive_mbs.network.elements import AppliedTorque, StateRate
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import recording_moment
from hdrive_mbs.network.network import Motion, Network
from hdrive_mbs.tracked_arrays import pattern

ROUNDING = 1e-12
"""Initial values so much smaller than the largest one count as zero: what solving for a static deflection leaves."""


def idle_coordinates(network: Network, initial: Mapping[str, float] | None = None) -> tuple[str, ...]:
    """Lateral, axial and tilting coordinates that stay zero: nothing but matrices and gyroscopes joins them to each other,
    and no force, unbalance or initial value acts on any of them.

    initial : values and rates at the start by name (``"rotor.z"``, ``"rotor.z_rate"``)
    """
    leader = {body.name: body.name for body in network.bodies}
    moved = {body.name for body in network.bodies if not body.lateral}
    given = {name: abs(value) for name, value in (initial or {}).items() if name.removesuffix("_rate") in leader}
    smallest = ROUNDING * max(given.values(), default=0.0)
    moved |= {name.removesuffix("_rate") for name, value in given.items() if value > smallest}

    def led(name: str) -> str:
        while leader[name] != name:
            name = leader[name]
        return name

    def join(group: Iterable[str]) -> None:
        leaders = [led(name) for name in group if name in leader]
        for other in leaders[1:]:
            leader[other] = leaders[0]

    for rotor in network.rotors:
        x, y, _, psi, theta, _ = rotor.coordinates
        join((psi, theta))
        if rotor.body.centre[2] != 0.0:
            join((x, theta))
            join((y, psi))
        if rotor.body.static_unbalance or rotor.body.product_unbalance:
            moved |= {x, y, psi, theta}
    for element in network.elements:
        if isinstance(element, MatrixElement):
            matrix = pattern(element.mass) | pattern(element.damping) | pattern(element.stiffness)
            for at in groups(matrix):
                join(element.coordinates[k] for k in at)
        elif isinstance(element, Gyroscope):
            join((element.psi, element.theta))
        elif isinstance(element, AppliedTorque):
            moved.add(element.coordinate)
        elif not isinstance(element, StateRate):
            moved |= set(element.contribution(recording_moment()))
    busy = {led(name) for name in moved if name in leader}
    return tuple(name for name in leader if led(name) not in busy)


def without_idle(network: Network, initial: Mapping[str, float] | None = None) -> Network:
    """The network with its idle coordinates held at zero: equal motion of everything else, fewer and slower equations."""
    held = frozenset(idle_coordinates(network, initial))
    if not held:
        return network
    elements = []
    for element in network.elements:
        kept = element.without(held) if isinstance(element, MatrixElement) else element
        if not isinstance(kept, MatrixElement) or kept.coordinates:
            elements.append(kept)
    motions = tuple(Motion(name, _at_rest, 1, 0.0) for name in sorted(held))
    bodies = tuple(body for body in network.bodies if body.name not in held)
    return replace(network, bodies=bodies, motions=(*network.motions, *motions), elements=tuple(elements))


def _at_rest(time: Value) -> Value:
    return 0.0 * time
