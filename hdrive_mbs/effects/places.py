"""Where in a network effects may sit: names of places by kind, each place once."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from hdrive_mbs.network.elements import AppliedTorque, Connection
from hdrive_mbs.network.network import Network


def turning_bodies(network: Network) -> tuple[str, ...]:
    """Bodies that turn freely: not the ground, not places whose motion is given."""
    return tuple(body.name for body in network.bodies if not body.lateral)


def torsional_bodies(network: Network) -> tuple[str, ...]:
    """Bodies that only turn: of drive trains, not of rotor lines, which turn one way for long and also move across the axis."""
    across = set(stations(network))
    return tuple(name for name in turning_bodies(network) if name not in across)


def connections(network: Network) -> tuple[str, ...]:
    """Torsional shafts, couplings and meshes of gears.

    A piece of shaft that bends is one piece of metal between two stations: nothing in it has play, slips or creeps.  An effect can be
    put there all the same, ``scene.with_effect(..., at="section_1")``.
    """
    bending = set(shafts(network))
    found = (element.name for element in network.elements if isinstance(element, Connection) and element.flanges)
    return tuple(name for name in found if name not in bending)


def gears(network: Network) -> tuple[str, ...]:
    """Connections between a wave generator, a flexspline and a circular spline."""
    wanted = {"wave_generator", "flexspline", "circular_spline"}
    return tuple(e.name for e in network.elements if isinstance(e, Connection) and wanted <= set(e.flanges))


def gear_flanges(network: Network, flange: str) -> tuple[str, ...]:
    """Bodies at that flange of the gears: 'wave_generator', 'flexspline' or 'circular_spline'."""
    meshes = set(gears(network))
    return tuple(e.flanges[flange] for e in network.elements if isinstance(e, Connection) and e.name in meshes)


def couplings(network: Network) -> tuple[str, ...]:
    """Torsional shafts and couplings, without the meshes of gears: where two parts are held together by friction."""
    meshes = set(gears(network))
    return tuple(name for name in connections(network) if name not in meshes)


def motors(network: Network) -> tuple[str, ...]:
    """Motors with a torque law whose rotors turn freely."""
    free = set(turning_bodies(network))
    found = [e for e in network.elements if isinstance(e, AppliedTorque) and e.is_motor and e.coordinate in free]
    return tuple(element.name.removesuffix(".torque") for element in found)


def loads(network: Network) -> tuple[str, ...]:
    """Working machines whose bodies turn freely."""
    free = set(turning_bodies(network))
    found = [e for e in network.elements if isinstance(e, AppliedTorque) and e.is_load and e.coordinate in free]
    return tuple(element.name.removesuffix(".torque") for element in found)


def sensors(network: Network) -> tuple[str, ...]:
    """Sensors, whatever they read."""
    return tuple(channel.name for channel in network.channels if channel.reads is not None)


def angle_sensors(network: Network) -> tuple[str, ...]:
    """Sensors that read the angle of a place, directly or through another sensor."""
    return tuple(name for name in sensors(network) if network.root_quantity(name).endswith(".angle"))


# -- on rotor lines ------------------------------------------------------------------------------------


def rotors(network: Network) -> tuple[str, ...]:
    """Rigid rotors with six coordinates."""
    return tuple(rotor.name for rotor in network.rotors)


def stations(network: Network) -> tuple[str, ...]:
    """Places with lateral motion, each body once."""
    lateral = {body.name for body in network.bodies if body.lateral}
    return tuple(dict.fromkeys(node for node in network.places.values() if f"{node}.x" in lateral))


def bearings(network: Network) -> tuple[str, ...]:
    """Bearings whose ring is a station, with or without a housing that moves."""
    return network.members.get("bearing", ())


def supports(network: Network) -> tuple[str, ...]:
    """Bearings with a housing that moves, by the name of the bearing."""
    return network.members.get("support", ())


def shafts(network: Network) -> tuple[str, ...]:
    """Pieces of shaft that bend."""
    return network.members.get("shaft", ())


def drive_ends(network: Network) -> tuple[str, ...]:
    """Where a line is held or coupled to something outside: bearings, and motors that sit elsewhere; each body once."""
    lateral = set(stations(network))
    driven = tuple(place for place in motors(network) if network.places[place] in lateral)
    found: dict[str, str] = {}
    for place in (*bearings(network), *driven):
        found.setdefault(network.places[place], place)
    return tuple(found.values())


def probes(network: Network) -> tuple[str, ...]:
    """Sensors that read a displacement of a place across the axis, directly or through another sensor."""
    return tuple(name for name in sensors(network) if network.probed(name) is not None)


def surfaces(network: Network) -> tuple[str, ...]:
    """Places where sensors read a displacement across the axis."""
    return tuple(dict.fromkeys(seen.place for seen in map(network.probed, sensors(network)) if seen is not None))


PLACES: Mapping[str, Callable[[Network], tuple[str, ...]]] = {
    "body": turning_bodies,
    "connection": connections,
    "gear": gears,
    "coupling": couplings,
    "motor": motors,
    "sensor": sensors,
    "load": loads,
    "rotor": rotors,
    "station": stations,
    "bearing": bearings,
    "support": supports,
    "shaft": shafts,
    "drive end": drive_ends,
    "probe": probes,
    "surface": surfaces,
}
"""Kind of place -> its places in a network."""
