"""Where in a network effects may sit: names of places by kind, each place once."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from hdrive_mbs.network.elements import AppliedTorque, Connection
from hdrive_mbs.network.network import Network


def turning_bodies(network: Network) -> tuple[str, ...]:
    """Bodies that turn freely: not the ground, not places whose motion is given."""
    return tuple(body.name for body in network.bodies if not body.lateral)


def connections(network: Network) -> tuple[str, ...]:
    """Shafts, couplings and meshes of gears."""
    return tuple(element.name for element in network.elements if isinstance(element, Connection) and element.flanges)


def gears(network: Network) -> tuple[str, ...]:
    """Connections between a wave generator, a flexspline and a circular spline."""
    wanted = {"wave_generator", "flexspline", "circular_spline"}
    return tuple(e.name for e in network.elements if isinstance(e, Connection) and wanted <= set(e.flanges))


def motors(network: Network) -> tuple[str, ...]:
    """Motors with a torque law whose rotors turn freely."""
    free = set(turning_bodies(network))
    found = [e for e in network.elements if isinstance(e, AppliedTorque) and e.is_motor and e.coordinate in free]
    return tuple(element.name.removesuffix(".torque") for element in found)


def sensors(network: Network) -> tuple[str, ...]:
    """Sensors, whatever they read."""
    return tuple(channel.name for channel in network.channels if channel.reads is not None)


def angle_sensors(network: Network) -> tuple[str, ...]:
    """Sensors that read the angle of a place, directly or through another sensor."""
    source = {channel.name: channel.reads for channel in network.channels if channel.reads is not None}

    def root(name: str) -> str:
        while name in source:
            name = source[name]
        return name

    return tuple(name for name in source if root(name).endswith(".angle"))


PLACES: Mapping[str, Callable[[Network], tuple[str, ...]]] = {
    "body": turning_bodies,
    "connection": connections,
    "gear": gears,
    "motor": motors,
    "sensor": sensors,
}
"""Kind of place -> its places in a network."""
