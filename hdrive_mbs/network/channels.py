"""Channels of places and connections, and channels that read other channels."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from hdrive_mbs.errors import ParameterError, PlaceError, SceneError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Connection
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Channel
from hdrive_mbs.network.node import Node


@dataclass
class Reading:
    """A channel looked up by name when the network is finished; call it with a moment."""

    quantity: str
    asked_by: str
    hint: str = ""
    channel: Channel | None = None

    def __call__(self, moment: Moment) -> Value:
        if self.channel is None:
            raise SceneError(f"{self.asked_by} reads {self.quantity!r} before the network is finished.")
        return self.channel.read(moment)

    def connect(self, known: Mapping[str, Channel], sources: Mapping[str, Reading]) -> None:
        """Look it up among the channels, those with a source being read from it."""
        self.channel = known[self.quantity]


@dataclass
class SpeedReading(Reading):
    """A speed [rad/s], counted as the place turns forward that it is the speed of, through sensors that read it.

    sense : of that place, -1 where it turns backward in the true sense
    """

    sense: int = 1

    def __call__(self, moment: Moment) -> Value:
        return self.sense * super().__call__(moment)

    def connect(self, known: Mapping[str, Channel], sources: Mapping[str, Reading]) -> None:
        super().connect(known, sources)
        unit, root = known[self.quantity].unit, self.quantity
        if unit != "rad/s":
            raise ParameterError(f"{self.asked_by} needs a speed in rad/s, but {self.quantity!r} is in {unit!r}. {self.hint}")
        while root in sources:
            root = sources[root].quantity
        self.sense = known[root].sense


def resolved_channels(channels: Sequence[Channel], readings: Sequence[Reading], sources: Mapping[str, Reading]) -> tuple[Channel, ...]:
    """The channels with those that read others connected to them."""
    known = {channel.name: channel for channel in channels}
    for reading in readings:
        if reading.quantity not in known:
            hint = f" {reading.hint}" if reading.hint else ""
            raise PlaceError(
                f"{reading.asked_by} reads {reading.quantity!r}, which this scene does not have.{hint} Quantities: {', '.join(known)}."
            )
    for name in sources:
        path = [name]
        while path[-1] in sources:
            path.append(sources[path[-1]].quantity)
            if path[-1] in path[:-1]:
                raise SceneError(f"{' reads '.join(path)}: a reading cannot depend on itself.")
        for link in reversed(path[:-1]):
            read = known[sources[link].quantity]
            if known[link].unit not in ("", read.unit) and not known[link].scaled:
                raise ParameterError(
                    f"{link}: its unit is {known[link].unit!r}, but it reads {read.name} in {read.unit!r} with a gain of 1, which changes "
                    f"no unit. Give the gain, {known[link].unit} per {read.unit}, or leave the unit out."
                )
            known[link] = replace(known[link], unit=known[link].unit or read.unit)
    for reading in readings:
        reading.connect(known, sources)
    return tuple(known.values())


def body_channels(nodes: Mapping[str, Node], flanges: Mapping[str, str]) -> list[Channel]:
    """Angle and speed of every place."""
    channels = []
    for place, node_name in flanges.items():
        if node_name == "ground" or (place != node_name and place.endswith((".a", ".b"))):
            continue  # the ends of a shaft are the bodies that they are joined to
        node = nodes[node_name]
        channels += [
            Channel(f"{place}.angle", "rad", f"angle of {place}, true sense", _angle(node), f"{place}.speed", sense=node.sense),
            Channel(f"{place}.speed", "rad/s", f"speed of {place}, true sense", _speed(node), f"{place}.acceleration", sense=node.sense),
        ]
    return channels


def connection_channels(connections: Sequence[Connection]) -> list[Channel]:
    """Twist, its rate and torque of every connection."""
    channels = []
    for connection in connections:
        name, rate = connection.name, f"{connection.name}.twist_rate"
        channels += [
            Channel(f"{name}.twist", "rad", f"elastic twist of {name}, positive when driving", connection.stretch, rate),
            Channel(rate, "rad/s", f"rate of the twist of {name}", connection.rate),
            Channel(f"{name}.torque", "N m", f"torque through {name}, positive when driving", connection.value),
        ]
    return channels


def _angle(node: Node) -> Callable[[Moment], Value]:
    return lambda moment: node.sense * moment.angle(node.name)


def _speed(node: Node) -> Callable[[Moment], Value]:
    return lambda moment: node.sense * moment.speed(node.name)
