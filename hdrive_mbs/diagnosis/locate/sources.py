"""Where an unknown force or error may sit: bodies, connections, bearings, housings, sections and sensors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Connection, StateRate
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network, State

PUSH = "push:"
"""Begins the names of the states that stand for unknown forces."""


@dataclass(frozen=True)
class Source:
    """An unknown force.

    at : place of the scene, as reports name it
    along : direction -> coordinate -> generalized force per unit of the unknown (one torque, or forces in x and y)
    unit : of the unknown
    """

    at: str
    along: Mapping[str, Mapping[str, float]]
    unit: str = "N m"


@dataclass(frozen=True)
class Push:
    """An element that puts a force, which is a state, along coordinates."""

    state: str
    factors: Mapping[str, float] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Of the state."""
        return self.state

    def contribution(self, moment: Moment) -> dict[str, Value]:
        """Factor times the state."""
        return {name: factor * moment.state(self.state) for name, factor in self.factors.items()}


def sources(network: Network) -> tuple[Source, ...]:
    """Every body, connection, bearing, housing and shaft section of a network that a force may act on or in.

    A connection is pushed at both of its ends by opposite torques; a displacement in it, like a kinematic error, pushes
    through its own stiffness and damping along the same coordinates and is no place of its own.
    """
    found: list[Source] = []
    bodies = {body.name: body for body in network.bodies}
    lateral = [name.removesuffix(".x") for name in bodies if name.endswith(".x") and bodies[name].lateral and f"{name[:-2]}.y" in bodies]
    for name, body in bodies.items():
        if not body.lateral:
            found.append(Source(name, {"turning": {name: 1.0}}))
    for station in lateral:
        if station.removesuffix(".housing") in lateral or not station.endswith(".housing"):
            found.append(Source(station, {d: {f"{station}.{d}": 1.0} for d in "xy"}, "N"))
    for element in network.elements:
        if isinstance(element, Connection) and len(element.factors) > 1 and element.flanges:
            found.append(Source(element.name, {"torsion": {n: -f for n, f in element.factors.items() if n in bodies}}))
    for bearing in network.members.get("bearing", ()):
        inner = _between(bearing, bodies)
        if inner:
            found.append(Source(f"{bearing}.law", inner, "N"))
    for section in network.members.get("shaft", ()):
        bent = _bending(section, network)
        if bent:
            found.append(Source(section, bent))
    return tuple(found)


def _between(bearing: str, bodies: Mapping[str, object]) -> dict[str, dict[str, float]]:
    """A force between ring and housing; empty where the bearing has no housing of its own."""
    if f"{bearing}.housing.x" in bodies:
        return {d: {f"{bearing}.{d}": 1.0, f"{bearing}.housing.{d}": -1.0} for d in "xy"}
    if f"{bearing}.across_x" in bodies:
        return {d: {f"{bearing}.across_{d}": 1.0} for d in "xy"}
    return {}


def _bending(section: str, network: Network) -> dict[str, dict[str, float]]:
    """A couple that bends a section."""
    ends = [network.places.get(f"{section}.{end}") for end in "ab"]
    names = {body.name for body in network.bodies}
    if None in ends or any(f"{end}.{tilt}" not in names for end in ends for tilt in ("psi", "theta")):
        return {}
    return {tilt: {f"{ends[0]}.{tilt}": 1.0, f"{ends[1]}.{tilt}": -1.0} for tilt in ("psi", "theta")}


def pushed(network: Network, given: Sequence[Source]) -> tuple[Network, tuple[tuple[str, str], ...]]:
    """The network with an unknown force for each direction of each source, and (place, state) of these."""
    names = [(source.at, f"{PUSH}{source.at}:{way}", factors) for source in given for way, factors in source.along.items()]
    states = tuple(State(state, "", 0.0) for _, state, _ in names)
    elements = [item for _, state, factors in names for item in (Push(state, factors), StateRate(state, _nothing))]
    made = replace(network, states=(*network.states, *states), elements=(*network.elements, *elements))
    return made, tuple((at, state) for at, state, _ in names)


def _nothing(moment: Moment) -> Value:
    return 0.0 * moment.time
