"""Channels and sensors of a network while it is being built."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from hdrive_mbs.errors import PlaceError, unknown_place
from hdrive_mbs.expression import Value
from hdrive_mbs.network.channels import Reading, SpeedReading
from hdrive_mbs.network.draft_places import DraftPlaces
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Channel
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.probed import Probed, probed
from hdrive_mbs.network.sensor_draft import SensorDraft


class DraftChannels(DraftPlaces):
    """Named quantities, and what reads them."""

    def __init__(self, nodes: dict[str, Node], flanges: dict[str, str]) -> None:
        super().__init__(nodes, flanges)
        self._channels: dict[str, Channel] = {}
        self._readings: list[Reading] = []
        self._sensors: dict[str, SensorDraft] = {}
        self._sources: dict[str, Reading] = {}  # channel made from another channel -> that channel

    def add_channel(self, name: str, unit: str, doc: str, read: Callable[[Moment], Value], *, slope: str | None = None) -> None:
        """A named quantity of the result."""
        if name not in self._channels:
            self._channels[name] = Channel(name, unit, doc, read, slope)

    def add_probed(self, name: str, seen: Probed, *, asked_by: str) -> None:
        """A displacement [m] of a place of a rotor line along a direction of its own; unless it is relative its rate ``<name>_rate`` too.

        The network refuses a place that has no such displacement with a PlaceError.
        """
        wanted = (
            "a bearing with a housing, full or improved" if seen.relative else "a place of a rotor line: a rotor, a bearing, a drive, say"
        )
        self._add_turned(name, seen, "", asked_by, f"{seen.place!r} has to be {wanted}.")
        if not seen.relative:
            self._add_turned(f"{name}_rate", seen, "_rate", asked_by)
            self._channels[name] = replace(self._channels[name], slope=f"{name}_rate")
        self._channels[name] = replace(self._channels[name], probed=seen)

    def _add_turned(self, name: str, seen: Probed, ending: str, asked_by: str, hint: str = "") -> None:
        x, y = (self.read_channel(f"{channel}{ending}", asked_by=asked_by, hint=hint) for channel in seen.channels)
        cosine, sine = math.cos(seen.direction), math.sin(seen.direction)
        unit, of = ("m/s", "rate of the ") if ending else ("m", "")
        self.add_channel(name, unit, f"{of}displacement of {seen}", lambda moment: cosine * x(moment) + sine * y(moment))

    def probed(self, quantity: str) -> Probed | None:
        """What a channel looks at; None for one that is no displacement across the axis."""
        others = {channel.name: channel.probed for channel in self._channels.values() if channel.probed is not None}
        return probed(quantity, {quantity.rpartition(".")[0], *(seen.place for seen in others.values())}, others)

    def has_channel(self, name: str) -> bool:
        """Whether a part has already added the quantity."""
        return name in self._channels

    def read_channel(self, quantity: str, *, asked_by: str, hint: str = "") -> Reading:
        """A quantity of the network by name, also one that is added later.

        The network refuses an unknown name with a PlaceError that lists the channels and says the hint.
        """
        reading = Reading(quantity, asked_by, hint)
        self._readings.append(reading)
        return reading

    def read_speed(self, quantity: str, *, asked_by: str, hint: str = "") -> Reading:
        """A speed [rad/s] by name, forward, like ``read_channel``: of a place, or a sensor that reads one."""
        reading = SpeedReading(quantity, asked_by, hint)
        self._readings.append(reading)
        return reading

    def add_reading(
        self, name: str, quantity: str, change: Callable[[Value], Value], *, unit: str | None = None, scaled: bool = True
    ) -> None:
        """A sensor: a channel ``change(quantity)``; its unit is that of the quantity unless given.

        scaled : whether ``change`` may make another unit of it; if not, the network refuses one
        """
        source = self.read_channel(quantity, asked_by=repr(name))
        sensor = SensorDraft(name, source, change, unit or "", source)
        self.add_channel(name, sensor.unit, f"reading of {quantity}", sensor.reading)
        self._channels[name] = replace(self._channels[name], reads=quantity, scaled=scaled)
        self._sources[name], self._sensors[name] = source, sensor

    def sensor(self, place: str, asked_by: str = "This") -> SensorDraft:
        """The sensor of that name.  Raises PlaceError when there is none."""
        if place in self._sensors:
            return self._sensors[place]
        known = list(self._sensors) or ["none; add a part like Sensor(quantity='load.angle')"]
        if place in self._flanges or place in self._connections or place in self._aliases:
            kind = "body" if place in self._flanges else "connection"
            raise PlaceError(f"{asked_by} acts on a sensor, but {place!r} is a {kind}. Sensors: {', '.join(known)}.")
        raise unknown_place("sensor", place, known)

    @property
    def sensors(self) -> tuple[SensorDraft, ...]:
        """All sensors so far."""
        return tuple(self._sensors.values())

    def root_quantity(self, sensor: SensorDraft) -> str:
        """The channel that a sensor reads, through other sensors if it reads those."""
        path = [sensor.name, sensor.source.quantity]
        while path[-1] in self._sensors and path[-1] not in path[:-1]:
            path.append(self._sensors[path[-1]].source.quantity)
        return path[-1]

    def keep_true_reading(self, sensor: SensorDraft) -> None:
        """The channel ``<sensor>.true``: what a sensor would show undisturbed."""
        name = f"{sensor.name}.true"
        if name not in self._channels:
            self.add_channel(
                name, sensor.unit, f"reading of {sensor.source.quantity} without the effects on {sensor.name}", sensor.true_reading
            )
            self._sources[name] = sensor.source
