"""Which places of a line lie on one shaft, and in which order the drive passes through them."""

from __future__ import annotations

from collections.abc import Sequence

from hdrive_mbs.scene import Scene


def shaft_numbers(scene: Scene | None, places: Sequence[str]) -> list[int]:
    """Number of the shaft of each place: pieces with a length join places, couplings and gears do not.

    All of them 0 where the scene is not known.
    """
    if scene is None:
        return [0] * len(places)
    network = scene.network()
    at = network.positions
    first = {node: node for node in network.places.values()} | {place: place for place in places}

    def end(node: str) -> str:
        while first[node] != node:
            node = first[node]
        return node

    for name in scene.parts:
        a, b = f"{name}.a", f"{name}.b"
        if a in at and b in at and at[a] != at[b]:
            inside = [place for place in places if name in (place, place.rpartition(".")[0]) and not place.endswith(".housing")]
            for place in (b, *inside):
                first[end(network.places.get(place, place))] = end(network.places[a])
    ends = [end(network.places.get(place, place)) for place in places]
    return [list(dict.fromkeys(ends)).index(node) for node in ends]


def drive_order(scene: Scene | None, places: Sequence[str]) -> list[int]:
    """Indices of the places in the order in which they are met from the motor on, along what transmits torque."""
    if scene is None:
        return list(range(len(places)))
    network = scene.network()
    spins = {body.name: body for body in network.bodies if not body.lateral}
    beside: dict[str, list[str]] = {name: [] for name in spins}
    for element in network.elements:
        ends = [name for name in getattr(element, "factors", {}) if name in spins]
        for name in ends:
            beside[name] += [other for other in ends if other != name]
    starts = sorted(spins, key=lambda name: abs(spins[name].ratio - 1.0))
    met: dict[str, int] = {}
    for start in starts:
        waiting = [start]
        while waiting:
            name = waiting.pop()
            if name not in met:
                met[name] = len(met)
                waiting += reversed(beside[name])
    return sorted(range(len(places)), key=lambda k: met.get(network.places.get(places[k], places[k]), len(met)))
