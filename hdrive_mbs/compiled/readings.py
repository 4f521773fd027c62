"""Channels of a network at a moment, also those that follow from its accelerations."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from hdrive_mbs.errors import unknown_place
from hdrive_mbs.expression import Value, gradient
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network


def readings(network: Network, names: Sequence[str], moment: Moment, accelerations: Callable[[], Mapping[str, Value]]) -> list[Value]:
    """Values of the channels, the names of which are those of a Response.

    accelerations : gives those of all coordinates and the rates of all states; called if a channel needs them

    Raises PlaceError for an unknown name.
    """
    known: dict[str, Callable[[], Value]] = {channel.name: lambda c=channel: c.read(moment) for channel in network.channels}  # type: ignore[misc]
    found: dict[str, Value] = {}
    motions = {motion.name: motion for motion in network.motions}

    def rate(name: str) -> Value:
        if not found:
            found.update(accelerations())
        if name in motions and name not in found:  # most of them nobody asks for
            found[name] = gradient(gradient(motions[name].angle))(moment.time) + 0.0 * moment.time
        return found[name]

    for channel in network.channels:
        if channel.factors is not None:
            factors = channel.factors
            known[f"{channel.name}_acceleration"] = lambda f=factors: sum(value * rate(name) for name, value in f.items())  # type: ignore[misc]
    senses = {body.name: body.sense for body in network.bodies} | {motion.name: motion.sense for motion in network.motions}
    for place, node in network.places.items():
        if node in senses and f"{place}.speed" in known:
            known[f"{place}.acceleration"] = lambda n=node: senses[n] * rate(n)  # type: ignore[misc]
    for state in network.states:
        known[f"{state.name}.rate"] = lambda n=state.name: rate(n)  # type: ignore[misc]
    for name in names:
        if name not in known:
            raise unknown_place("channel", name, known, "This scene")
    return [known[name]() for name in names]
