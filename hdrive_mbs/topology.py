"""How the parts of a scene hang together: flanges, rigidly joined nodes, senses of rotation."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence

import numpy as np

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.errors import SceneError, unknown_place
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.rigid_mass import NOTHING, RigidMass

GROUND = "ground"


def _path(part: str, flange: Flange) -> str:
    return f"{part}.{flange.name}" if flange.name else part


def resolve_flanges(parts: Mapping[str, Component]) -> dict[str, Flange]:
    """Path of every flange in the scene."""
    return {_path(name, flange): flange for name, part in parts.items() for flange in part.flanges()}


def _end(place: str, parts: Mapping[str, Component], flanges: Mapping[str, Flange], leaving: bool) -> str:
    """Flange path of a place in a chain, on the side towards its neighbour."""
    if place == GROUND:
        return GROUND
    if place in flanges:
        return place
    if place not in parts:
        raise unknown_place("place", place, [*parts, *(p for p in flanges if "." in p), GROUND])
    part = parts[place]
    flange = part.exit if leaving else part.entry
    if not part.flanges():
        raise SceneError(f"{place!r} ({type(part).__name__}) has no flange to connect.")
    return f"{place}.{flange}" if flange else place


def joints(parts: Mapping[str, Component], connections: Sequence[Sequence[str]]) -> list[tuple[str, str]]:
    """Pairs of flange paths that are rigidly joined."""
    pairs = []
    flanges = resolve_flanges(parts)
    for chain in connections:
        if len(chain) < 2:
            raise SceneError(f"Connection {tuple(chain)}: a connection names at least two places.")
        for left, right in itertools.pairwise(chain):
            if left == right and left in flanges:
                raise SceneError(f"Connection {tuple(chain)} joins {left!r} to itself; name each place once.")
            pairs.append((_end(left, parts, flanges, leaving=True), _end(right, parts, flanges, leaving=False)))
    return pairs


def check_connections(parts: Mapping[str, Component], connections: Sequence[Sequence[str]]) -> None:
    """Raise SceneError for a loose end and PlaceError for an unknown place."""
    used = {path for pair in joints(parts, connections) for path in pair}
    alone = len([name for name, part in parts.items() if part.flanges()]) == 1
    for name, part in parts.items():
        flanges = part.flanges()
        for flange in flanges:
            path = _path(name, flange)
            if path in used or flange.optional or flange.free or (alone and len(flanges) == 1):
                continue
            raise SceneError(
                f"Loose end: nothing is connected to {path!r} ({type(part).__name__}). "
                f"Add it to a connection, e.g. ({path!r}, 'ground'), or remove {name!r}."
            )


def _group(parts: Mapping[str, Component], connections: Sequence[Sequence[str]]) -> dict[str, str]:
    """Flange path -> name of its node, in the order of the connections.  A node is named after its first part with a body."""
    flanges = resolve_flanges(parts)
    parent = {path: path for path in [*flanges, GROUND]}

    def root(path: str) -> str:
        while parent[path] != path:
            path = parent[path]
        return path

    pairs = joints(parts, connections)
    used = {path for pair in pairs for path in pair}
    pairs += [(path, GROUND) for path, flange in flanges.items() if flange.optional and path not in used]
    for name, part in parts.items():
        if part.rigid:
            first, *others = [_path(name, flange) for flange in part.flanges()]
            pairs += [(first, other) for other in others]
    for a, b in pairs:
        parent[root(a)] = root(b)
    members: dict[str, list[str]] = {}
    for path in [*flanges, GROUND]:
        members.setdefault(root(path), []).append(path)
    line = {path: k for k, path in enumerate(path for pair in joints(parts, connections) for path in pair)}
    names: dict[str, str] = {}
    for paths in sorted(members.values(), key=lambda group: min(line.get(path, len(line)) for path in group)):
        # rotors name the node, then single-flange parts (motor, load); then gears; then shaft ends
        named = min(paths, key=lambda path: (path == GROUND or not flanges[path].is_rotor, "." in path, path.endswith((".a", ".b"))))
        node = GROUND if GROUND in paths else named
        names |= dict.fromkeys(paths, node)
    return names


def _ideal_ratios(parts: Mapping[str, Component], names: Mapping[str, str]) -> dict[str, float]:
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

    for name, part in parts.items():
        for relation in part.relations():
            scale = 1.0 / max(abs(value) for value in relation.values())
            joined: dict[str, float] = {}
            for flange, value in relation.items():
                node = names[f"{name}.{flange}"]
                joined[node] = joined.get(node, 0.0) + scale * value
            add(joined, 0.0)
        for flange_data in part.flanges():
            if flange_data.optional:
                add({names[_path(name, flange_data)]: 1.0}, 0.0, weight=1e-6)
    motor = next((name for name, part in parts.items() if isinstance(part, Motor)), None)
    reference = names[motor] if motor else next((node for node in nodes if node != GROUND), nodes[0])
    known = {reference: 1.0, GROUND: 0.0}  # exactly, whatever shafts to the ground would like
    free = [i for node, i in index.items() if node not in known]
    matrix, wanted = np.array(rows).reshape(-1, len(nodes)), np.array(right)
    for node, value in known.items():
        wanted = wanted - value * matrix[:, index[node]]
    solution = np.linalg.lstsq(matrix[:, free], wanted, rcond=None)[0] if free else np.zeros(0)
    ratios = {nodes[i]: float(value) for i, value in zip(free, solution)} | known
    return {node: ratios[node] for node in nodes}


def _steps(parts: Mapping[str, Component], connections: Sequence[Sequence[str]]) -> list[tuple[str, str, float, bool]]:
    """Pairs of flanges, the axial distance [m] from the first to the second, and whether they move as one."""
    steps = [(left, right, 0.0, True) for left, right in joints(parts, connections) if GROUND not in (left, right)]
    for name, part in parts.items():
        flanges = part.flanges()
        for flange in flanges[1:]:
            if flange.lateral or part.rigid:
                steps.append((_path(name, flanges[0]), _path(name, flange), flange.axial - flanges[0].axial, part.rigid))
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


def _positions(parts: Mapping[str, Component], connections: Sequence[Sequence[str]]) -> dict[str, float]:
    """Axial position of every flange [m]; each line begins at 0 with its first flange."""
    steps = _steps(parts, connections)
    found: dict[str, float] = {}
    order = [path for pair in joints(parts, connections) for path in pair if path != GROUND]
    for path in [*order, *resolve_flanges(parts)]:
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


def start_draft(parts: Mapping[str, Component], connections: Sequence[Sequence[str]]) -> Draft:
    """A draft with all nodes (inertias summed) and no elements yet."""
    names = _group(parts, connections)
    ratios = _ideal_ratios(parts, names)
    flanges = resolve_flanges(parts)
    inertias: dict[str, float] = dict.fromkeys(ratios, 0.0)
    for path, flange in flanges.items():
        inertias[names[path]] += flange.inertia
    lateral = {names[path] for path, flange in flanges.items() if flange.lateral} - {GROUND}
    positions = _positions(parts, connections) if lateral else {}
    masses: dict[str, RigidMass] = dict.fromkeys(lateral, NOTHING)
    rotors: dict[str, str] = {}
    for path, flange in flanges.items():
        if flange.is_rotor:
            rotors.setdefault(names[path], path)
    reference = {node: rotors.get(node, node) for node in lateral}
    offsets = {path: positions[path] - positions[reference[node]] for path, node in names.items() if node in lateral and path in positions}
    for path, flange in flanges.items():
        if names[path] in lateral:
            masses[names[path]] += flange.mass.moved(offsets[path])
    nodes = {}
    for node, ratio in ratios.items():
        sense, turns = (-1 if ratio < -1e-9 else 1), (0.0 if abs(ratio) < 1e-9 else round(ratio, 12))
        if node in lateral:
            nodes[node] = Node(node, inertias[node], sense, turns, True, masses[node], node in rotors, positions[reference[node]])
        else:
            nodes[node] = Node(node, inertias[node], sense, turns)
    places = {path: node for path, node in names.items() if path != GROUND} | {GROUND: GROUND}
    return Draft(nodes, places, {path: offset for path, offset in offsets.items() if offset != 0.0})
