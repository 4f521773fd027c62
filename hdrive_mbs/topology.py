"""How the parts of a scene hang together: flanges, rigidly joined nodes, senses of rotation."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.errors import SceneError, unknown_place
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.rigid_mass import NOTHING, RigidMass

GROUND = "ground"
KEPT = 128
"""Scenes whose layout is kept: they differ in what parts there are and how they are joined, not in masses or stiffnesses."""

Chains = tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class _Mouth:
    """What of a flange decides how it can be joined."""

    path: str
    name: str
    optional: bool
    lateral: bool
    is_rotor: bool
    axial: float
    free: bool


@dataclass(frozen=True)
class _Outline:
    """What of a part decides how a scene hangs together: everything but masses and laws."""

    name: str
    kind: str
    entry: str
    exit: str
    rigid: bool
    is_motor: bool
    flanges: tuple[_Mouth, ...]
    relations: tuple[tuple[tuple[str, float], ...], ...]


Outlines = tuple[_Outline, ...]


@dataclass(frozen=True, eq=False)
class _Layout:
    """How a scene hangs together.

    nodes : flange path -> name of its node;  ratios : of each node, see _ideal_ratios
    lateral : nodes that move across the axis;  rotors : node -> flange that makes it a rigid body
    places : node -> axial position [m];  offsets : flange path -> axial distance from there [m]
    """

    nodes: Mapping[str, str]
    ratios: Mapping[str, float]
    lateral: frozenset[str]
    rotors: Mapping[str, str]
    places: Mapping[str, float]
    offsets: Mapping[str, float]


def _path(part: str, flange: Flange) -> str:
    return f"{part}.{flange.name}" if flange.name else part


def resolve_flanges(parts: Mapping[str, Component]) -> dict[str, Flange]:
    """Path of every flange in the scene."""
    return {_path(name, flange): flange for name, part in parts.items() for flange in part.flanges()}


def _outlines(parts: Mapping[str, Component]) -> Outlines:
    return tuple([_outline(name, part, part.flanges()) for name, part in parts.items()])


def _outline(name: str, part: Component, flanges: Sequence[Flange]) -> _Outline:
    mouths = tuple([_Mouth(_path(name, f), f.name, f.optional, f.lateral, f.is_rotor, f.axial, f.free) for f in flanges])
    relations = tuple([tuple(relation.items()) for relation in part.relations()])
    return _Outline(name, type(part).__name__, part.entry, part.exit, part.rigid, isinstance(part, Motor), mouths, relations)


def _chains(connections: Sequence[Sequence[str]]) -> Chains:
    return tuple(tuple(chain) for chain in connections)


def _mouths(parts: Outlines) -> dict[str, _Mouth]:
    return {flange.path: flange for part in parts for flange in part.flanges}


def _end(place: str, parts: Mapping[str, _Outline], flanges: Mapping[str, _Mouth], leaving: bool) -> str:
    """Flange path of a place in a chain, on the side towards its neighbour."""
    if place == GROUND:
        return GROUND
    if place in flanges:
        return place
    if place not in parts:
        raise unknown_place("place", place, [*parts, *(p for p in flanges if "." in p), GROUND])
    part = parts[place]
    flange = part.exit if leaving else part.entry
    if not part.flanges:
        raise SceneError(f"{place!r} ({part.kind}) has no flange to connect.")
    return f"{place}.{flange}" if flange else place


def joints(parts: Mapping[str, Component], connections: Sequence[Sequence[str]]) -> list[tuple[str, str]]:
    """Pairs of flange paths that are rigidly joined."""
    return list(_joints(_outlines(parts), _chains(connections)))


@lru_cache(maxsize=KEPT)
def _joints(parts: Outlines, connections: Chains) -> tuple[tuple[str, str], ...]:
    pairs = []
    flanges, known = _mouths(parts), {part.name: part for part in parts}
    for chain in connections:
        if len(chain) < 2:
            raise SceneError(f"Connection {tuple(chain)}: a connection names at least two places.")
        for left, right in itertools.pairwise(chain):
            if left == right and left in flanges:
                raise SceneError(f"Connection {tuple(chain)} joins {left!r} to itself; name each place once.")
            pairs.append((_end(left, known, flanges, leaving=True), _end(right, known, flanges, leaving=False)))
    return tuple(pairs)


def check_connections(parts: Mapping[str, Component], connections: Sequence[Sequence[str]]) -> None:
    """Raise SceneError for a loose end and PlaceError for an unknown place."""
    _check(_outlines(parts), _chains(connections))


@lru_cache(maxsize=KEPT)
def _check(parts: Outlines, connections: Chains) -> None:
    used = {path for pair in _joints(parts, connections) for path in pair}
    alone = len([part for part in parts if part.flanges]) == 1
    for part in parts:
        for flange in part.flanges:
            path = flange.path
            if path in used or flange.optional or flange.free or (alone and len(part.flanges) == 1):
                continue
            raise SceneError(
                f"Loose end: nothing is connected to {path!r} ({part.kind}). "
                f"Add it to a connection, e.g. ({path!r}, 'ground'), or remove {part.name!r}."
            )


def _group(parts: Outlines, connections: Chains) -> dict[str, str]:
    """Flange path -> name of its node, in the order of the connections.  A node is named after its first part with a body."""
    flanges = _mouths(parts)
    parent = {path: path for path in [*flanges, GROUND]}

    def root(path: str) -> str:
        while parent[path] != path:
            path = parent[path]
        return path

    pairs = list(_joints(parts, connections))
    used = {path for pair in pairs for path in pair}
    pairs += [(path, GROUND) for path, flange in flanges.items() if flange.optional and path not in used]
    for part in parts:
        if part.rigid:
            first, *others = [flange.path for flange in part.flanges]
            pairs += [(first, other) for other in others]
    for a, b in pairs:
        parent[root(a)] = root(b)
    members: dict[str, list[str]] = {}
    for path in [*flanges, GROUND]:
        members.setdefault(root(path), []).append(path)
    line = {path: k for k, path in enumerate(path for pair in _joints(parts, connections) for path in pair)}
    names: dict[str, str] = {}
    for paths in sorted(members.values(), key=lambda group: min(line.get(path, len(line)) for path in group)):
        # rotors name the node, then single-flange parts (motor, load); then gears; then shaft ends
        named = min(paths, key=lambda path: (path == GROUND or not flanges[path].is_rotor, "." in path, path.endswith((".a", ".b"))))
        node = GROUND if GROUND in paths else named
        names |= dict.fromkeys(paths, node)
    return names


def _ideal_ratios(parts: Outlines, names: Mapping[str, str]) -> dict[str, float]:
    """True-sense speed of each node for unit speed of the motor, all elasticities rigid.

    Solves the parts' linear relations in the least-squares sense; optional flanges are weakly
    held, so that an unconnected second input counts as standing still.
    """
    nodes = list(dict.fromkeys(names.values()))
    index = {node: i for i, node in enumerate(nodes)}
    rows: list[np.ndarray] = []
    right: list[float] = []

    def add(coefficients: Mapping[str, float], value: float, weight: float = 1.0) -> None:
        row = np.zeros(len(nodes))
        for node, coefficient in coefficients.items():
            row[index[node]] += coefficient
        rows.append(weight * row)
        right.append(weight * value)

    for part in parts:
        for relation in part.relations:
            scale = 1.0 / max(abs(value) for _, value in relation)
            joined: dict[str, float] = {}
            for flange, value in relation:
                node = names[f"{part.name}.{flange}"]
                joined[node] = joined.get(node, 0.0) + scale * value
            add(joined, 0.0)
        for mouth in part.flanges:
            if mouth.optional:
                add({names[mouth.path]: 1.0}, 0.0, weight=1e-6)
    motor = next((part.name for part in parts if part.is_motor), None)
    reference = names[motor] if motor else next((node for node in nodes if node != GROUND), nodes[0])
    known = {reference: 1.0, GROUND: 0.0}  # exactly, whatever shafts to the ground would like
    free = [i for node, i in index.items() if node not in known]
    matrix, wanted = np.array(rows).reshape(-1, len(nodes)), np.array(right)
    for node, value in known.items():
        wanted = wanted - value * matrix[:, index[node]]
    solution = np.linalg.lstsq(matrix[:, free], wanted, rcond=None)[0] if free else np.zeros(0)
    ratios = {nodes[i]: float(value) for i, value in zip(free, solution)} | known
    return {node: ratios[node] for node in nodes}


def _steps(parts: Outlines, connections: Chains) -> list[tuple[str, str, float, bool]]:
    """Pairs of flanges, the axial distance [m] from the first to the second, and whether they move as one."""
    steps = [(left, right, 0.0, True) for left, right in _joints(parts, connections) if GROUND not in (left, right)]
    for part in parts:
        for flange in part.flanges[1:]:
            if flange.lateral or part.rigid:
                first = part.flanges[0]
                steps.append((first.path, flange.path, flange.axial - first.axial, part.rigid))
    return steps


def _walk(start: str, steps: Sequence[tuple[str, str, float, bool]], *, rigid: bool) -> dict[str, float]:
    """Axial distance of every flange that can be reached from the start, over rigid steps only or over all."""
    found, todo = {start: 0.0}, [start]
    while todo:
        here = todo.pop()
        for left, right, distance, as_one in steps:
            if rigid and not as_one:
                continue
            for a, b, length in ((left, right, distance), (right, left, -distance)):
                if a == here and b not in found:
                    found[b] = found[here] + length
                    todo.append(b)
    return found


def _positions(parts: Outlines, connections: Chains) -> dict[str, float]:
    """Axial position of every flange [m]; each line begins at 0 with its first flange."""
    steps = _steps(parts, connections)
    found: dict[str, float] = {}
    order = [path for pair in _joints(parts, connections) for path in pair if path != GROUND]
    for path in [*order, *_mouths(parts)]:
        if path not in found:
            reached = _walk(path, steps, rigid=False)
            lowest = min(reached.values())
            found |= {name: value - lowest for name, value in reached.items()}
    for left, right, distance, _ in steps:
        apart = found[right] - found[left]
        if abs(apart - distance) > 1e-9 * max(abs(distance), *found.values()):
            raise SceneError(
                f"{left!r} and {right!r} lie {distance:g} m apart by this connection and {apart:g} m by another one, so the shaft does "
                "not close. A chain goes towards +z; correct the lengths of the sections or the order of the places."
            )
    return found


@lru_cache(maxsize=KEPT)
def _layout(parts: Outlines, connections: Chains) -> _Layout:
    names = _group(parts, connections)
    ratios = _ideal_ratios(parts, names)
    flanges = _mouths(parts)
    lateral = frozenset({names[path] for path, flange in flanges.items() if flange.lateral} - {GROUND})
    positions = _positions(parts, connections) if lateral else {}
    rotors: dict[str, str] = {}
    for path, flange in flanges.items():
        if flange.is_rotor:
            rotors.setdefault(names[path], path)
    places = {node: positions[rotors.get(node, node)] for node in lateral}
    offsets = {path: positions[path] - places[node] for path, node in names.items() if node in lateral and path in positions}
    return _Layout(names, ratios, lateral, rotors, places, offsets)


def start_draft(parts: Mapping[str, Component], connections: Sequence[Sequence[str]]) -> Draft:
    """A draft with all nodes (inertias summed) and no elements yet."""
    own = {name: part.flanges() for name, part in parts.items()}
    layout = _layout(tuple([_outline(name, part, own[name]) for name, part in parts.items()]), _chains(connections))
    names, lateral, offsets = layout.nodes, layout.lateral, layout.offsets
    inertias: dict[str, float] = dict.fromkeys(layout.ratios, 0.0)
    masses: dict[str, RigidMass] = dict.fromkeys(lateral, NOTHING)
    for path, flange in {_path(name, flange): flange for name in parts for flange in own[name]}.items():
        node = names[path]
        inertias[node] += flange.inertia
        if node in lateral:
            masses[node] += flange.mass.moved(offsets[path])
    nodes = {}
    for node, ratio in layout.ratios.items():
        sense, turns = (-1 if ratio < -1e-9 else 1), (0.0 if abs(ratio) < 1e-9 else round(ratio, 12))
        if node in lateral:
            nodes[node] = Node(node, inertias[node], sense, turns, True, masses[node], node in layout.rotors, layout.places[node])
        else:
            nodes[node] = Node(node, inertias[node], sense, turns)
    places = {path: node for path, node in names.items() if path != GROUND} | {GROUND: GROUND}
    return Draft(nodes, places, {path: offset for path, offset in offsets.items() if offset != 0.0})
