"""Where an unknown force or error may sit: bodies, connections, bearings, housings, sections and sensors."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Connection, StateRate
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network, State

PUSH = "push:"
"""Begins the names of the states that stand for unknown forces."""
TURNING = "turning"
"""Way of a torque on the spin, where a place also has forces across it."""
HINGES = (0.15, 0.5, 0.85)
"""Shares of a section's length at which a hinge is tried."""


@dataclass(frozen=True)
class Source:
    """An unknown force.

    at : place of the scene, as reports name it
    along : direction -> coordinate -> generalized force per unit of the unknown (one torque, or forces in x and y)
    unit : of the unknown;  way : how it acts, where a place has several sources
    rotating : directions come in pairs, x and y, and the force turns with the shaft, like that of an unbalance
    columns : of sensors that err together; these have no force
    """

    at: str
    along: Mapping[str, Mapping[str, float]]
    unit: str = "N m"
    way: str = ""
    rotating: bool = False
    columns: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """Of the source among all."""
        return f"{self.at}, {self.way}" if self.way else self.at

    @property
    def is_sensor(self) -> bool:
        """Whether it is an error of what is read, and no force."""
        return not self.along


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
    """Every body and connection of a torsional network that a force may act on or in.

    A connection is pushed at both of its ends by opposite torques; a displacement in it, like a kinematic error, pushes
    through its own stiffness and damping along the same coordinates and is no place of its own.
    """
    names = {body.name for body in network.bodies}
    found = [Source(body.name, {"turning": {body.name: 1.0}}) for body in network.bodies if not body.lateral]
    for element in network.elements:
        if isinstance(element, Connection) and len(element.factors) > 1 and element.flanges:
            found.append(Source(element.name, {"torsion": {n: -f for n, f in element.factors.items() if n in names}}))
    return tuple(found)


def lateral_sources(network: Network, driven: Mapping[str, str]) -> tuple[Source, ...]:
    """Every station, bearing, housing and shaft section of a network of rotors.

    driven : station -> part that turns it: a force from outside comes in there through the coupling, and is put down to that part

    A station is pushed by a force, by one with a couple, or by one that turns with it; a bearing between ring and housing;
    a housing against the ground; a section by what a hinge in it would do, near either end or in the middle, and the
    whole shaft by a bend of all sections.
    """
    names = {body.name for body in network.bodies}
    stations = [name[:-2] for name in names if name.endswith(".x") and f"{name[:-2]}.y" in names]
    found: list[Source] = []
    for station in sorted(name for name in stations if not name.endswith(".housing")):
        at = driven.get(station, station)
        force = {d: {f"{station}.{d}": 1.0} for d in "xy"}
        found += [Source(at, force, "N"), Source(at, force, "N", "rotating", rotating=True)]
        if {f"{station}.psi", f"{station}.theta"} <= names:
            # the couple that turns with a force along x is one about y, with one along y about -x
            both = force | {"theta": {f"{station}.theta": 1.0}, "psi": {f"{station}.psi": -1.0}}
            found += [Source(at, both, "N", "with a couple"), Source(at, both, "N", "with a rotating couple", rotating=True)]
    for bearing in network.members.get("bearing", ()):
        inner = _between(bearing, network.places.get(bearing, bearing), names)
        if inner:
            found += [Source(f"{bearing}.law", inner, "N"), Source(f"{bearing}.law", inner, "N", "rotating", rotating=True)]
        if f"{bearing}.housing" in stations:
            found.append(Source(f"{bearing}.housing", {d: {f"{bearing}.housing.{d}": 1.0} for d in "xy"}, "N"))
    bends: dict[str, Mapping[str, float]] = {}
    for section in network.members.get("shaft", ()):
        for share in HINGES:
            hinge = _hinge(section, share, network)
            if hinge:
                found.append(Source(section, hinge, "rad", f"hinge at {share:g}"))
                found.append(Source(section, hinge, "rad", f"rotating hinge at {share:g}", rotating=True))
        for way, factors in _hinge(section, 0.5, network).items():
            bends[f"{section} {way}"] = factors
    if len(bends) > 2:
        found.append(Source("shaft", bends, "rad", "bent", rotating=True))
    return tuple(found)


def turning_sources(network: Network, driven: Mapping[str, str]) -> tuple[Source, ...]:
    """A torque on the spin for every place of ``lateral_sources``: what whirls takes its power from the spin somewhere."""
    spins = {body.name for body in network.bodies if not body.lateral}
    found: dict[str, Source] = {}

    def put(at: str, place: str) -> None:
        name = network.places.get(place, place)
        if name in spins:
            found[at] = Source(at, {"turning": {name: 1.0}}, way=TURNING)

    for name in sorted(spins):
        put(driven.get(name, name), name)
    for bearing in network.members.get("bearing", ()):
        put(f"{bearing}.law", bearing)
        put(f"{bearing}.housing", bearing)
    for section in network.members.get("shaft", ()):
        put(section, f"{section}.a")
        put("shaft", f"{section}.a")
    return tuple(found.values())


def _between(bearing: str, ring: str, names: Collection[str]) -> dict[str, dict[str, float]]:
    """A force between ring and housing; empty where the bearing has no housing of its own.

    ring : the station that the ring belongs to: another part that is joined to it may have named that
    """
    if f"{bearing}.housing.x" in names:
        return {d: {f"{ring}.{d}": 1.0, f"{bearing}.housing.{d}": -1.0} for d in "xy"}
    if f"{bearing}.across_x" in names:
        return {d: {f"{bearing}.across_{d}": 1.0} for d in "xy"}
    return {}


def _hinge(section: str, share: float, network: Network) -> dict[str, dict[str, float]]:
    """Forces of a section that a kink of 1 rad in it would make, at a share of its length: K times the free shape.

    Behind the kink the free shape is straight: displaced by the kink times the length that is left, and tilted by it.
    """
    ends = [network.places.get(f"{section}.{end}") for end in "ab"]
    if None in ends or any(str(end) not in network.positions for end in ends):
        return {}
    left = (1.0 - share) * (network.positions[str(ends[1])] - network.positions[str(ends[0])])
    for element in network.elements:
        if isinstance(element, MatrixElement) and element.name == f"{section}.beam":
            at = {name: k for k, name in enumerate(element.coordinates)}
            found = {}
            for way, shift, tilt, sign in (("x", "x", "theta", 1.0), ("y", "y", "psi", -1.0)):
                shape = np.zeros(len(at))
                if f"{ends[1]}.{shift}" not in at or f"{ends[1]}.{tilt}" not in at:
                    return {}
                shape[at[f"{ends[1]}.{shift}"]], shape[at[f"{ends[1]}.{tilt}"]] = left, sign
                force = element.stiffness @ shape
                found[way] = {name: float(force[k]) for name, k in at.items() if force[k] != 0.0}
            return found
    return {}


def pushed(network: Network, given: Sequence[Source]) -> tuple[Network, tuple[tuple[str, str], ...]]:
    """The network with an unknown force for each direction of each source, and (name of the source, state) of these."""
    names = [(source.name, f"{PUSH}{source.name}:{way}", factors) for source in given for way, factors in source.along.items()]
    states = tuple(State(state, "", 0.0) for _, state, _ in names)
    elements = [item for _, state, factors in names for item in (Push(state, factors), StateRate(state, _nothing))]
    made = replace(network, states=(*network.states, *states), elements=(*network.elements, *elements))
    return made, tuple((at, state) for at, state, _ in names)


def _nothing(moment: Moment) -> Value:
    return 0.0 * moment.time
