"""The network while it is being built: parts add to it, effects change it.

A part or effect of a user's own needs only these methods: ``body``, ``connection``,
``add_torque``, ``vary_inertia``, ``add_connection``, ``add_state``, ``prescribe`` and ``add_channel``; on rotor lines
also ``station``, ``add_station``, ``add_coordinate``, ``add_matrix`` and ``add_coupling``.
"""

from __future__ import annotations

import numpy as np

from hdrive_mbs.errors import SceneError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.channels import body_channels, connection_channels, resolved_channels
from hdrive_mbs.network.draft_bearings import DraftBearings
from hdrive_mbs.network.elements import Element
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.network import Body, Channel, Motion, Network, Rotor
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.station import LATERAL, constant_force, station_bodies, station_channels, weights


class Draft(DraftBearings):
    """A network under construction."""

    def finish(self) -> Network:
        """The network, checked for bodies without inertia."""
        bodies: list[Body] = []
        motions: list[Motion] = []
        rotors: list[Rotor] = []
        for node in self._nodes.values():
            motion = self._motions.get(node.name)
            if node.name == "ground":
                motions.append(Motion("ground", _at_rest, 1, 0.0))
                continue
            if motion is not None:
                motions.append(Motion(node.name, motion, node.sense, node.ratio))
            if node.lateral:
                self._finish_station(node, bodies, rotors)
            elif motion is None and node.inertia > 0.0:
                bodies.append(Body(node.name, node.inertia, node.sense, node.ratio))
            elif motion is None:
                raise SceneError(
                    f"{node.name!r} has no inertia (0 kg m^2), so its acceleration is undefined. "
                    "Give the part an inertia, put an Inertia there, or connect it rigidly."
                )
        bodies += self._bodies
        self._elements = [item.without(self._motions) if isinstance(item, MatrixElement) else item for item in self._elements]
        self._check_masses(bodies)
        self._check_varying()
        self._add_weights()
        if not bodies:
            raise SceneError("The scene has no body that can move: every place is held or prescribed.")
        connections = [draft.build() for draft in self._connections.values()]
        for connection in connections:
            if not connection.terms and all(factor == 0.0 for factor in connection.factors.values()):
                raise SceneError(
                    f"Both ends of {connection.name!r} are joined to {next(iter(connection.factors))!r}, so it can never twist. "
                    "Connect one end to another body, or remove it."
                )
        channels = body_channels(self._nodes, self._flanges) + self._station_channels() + connection_channels(connections)
        channels += self._channels.values()
        elements: tuple[Element, ...] = (*connections, *self._elements)
        self._finished = elements
        resolved = resolved_channels(channels, self._readings, self._sources)
        positions = {
            place: self._nodes[node].position + self._offsets.get(place, 0.0)
            for place, node in self._flanges.items()
            if self._nodes[node].lateral
        } | self._positions
        return Network(
            tuple(bodies),
            tuple(motions),
            tuple(self._states.values()),
            elements,
            resolved,
            dict(self._flanges),
            tuple(rotors),
            positions,
            self._gravity,
            {"bearing": tuple(self._bearings), "support": tuple(self._supports), "shaft": tuple(self._shafts)},
        )

    def _finish_station(self, node: Node, bodies: list[Body], rotors: list[Rotor]) -> None:
        motion = self._motions.get(node.name)
        made = station_bodies(node.name, node.mass, node.sense, node.ratio, turning=node.inertia, is_rotor=node.is_rotor, motion=motion)
        bodies += made.bodies
        self._elements += made.elements
        rotors += [made.rotor] if made.rotor else []

    def _check_masses(self, bodies: list[Body]) -> None:
        """Refuse a coordinate that nothing accelerates."""
        heavy = {
            name
            for item in self._elements
            if isinstance(item, MatrixElement)
            for name, value in zip(item.coordinates, np.diag(np.asarray(item.mass, float)), strict=True)
            if value > 0.0
        }
        for body in bodies:
            if not body.inertia > 0.0 and body.name not in heavy:
                unit = "kg" if body.unit == "m" else "kg m^2"
                raise SceneError(
                    f"{body.name!r} has no inertia ({body.inertia:g} {unit}), so its acceleration is undefined. Give the ring of the "
                    "bearing mass and moments of inertia, put a Rotor there, or give the shaft a density."
                )

    def _check_varying(self) -> None:
        """Refuse an inertia that varies where a matrix of masses couples its place to others: its torque is that of one inertia alone."""
        for name in self._varying:
            for item in self._elements:
                if isinstance(item, MatrixElement) and name in item.coordinates and item.mass[item.coordinates.index(name)].any():
                    raise SceneError(
                        f"The inertia of {name!r} varies with its angle, but {item.name!r} joins masses there to others. "
                        "Put what varies on a body of its own, connected by a shaft."
                    )

    def _add_weights(self) -> None:
        if self._gravity == (0.0, 0.0, 0.0):
            return
        for node in self._nodes.values():
            if node.lateral and node.name != "ground":
                is_free = node.is_rotor and node.name not in self._motions
                self._elements += weights(node.name, node.mass, node.sense, self._gravity, is_free)
        falls = {f".{key}": value for key, value in zip("xyz", self._gravity, strict=True) if value != 0.0}
        for body in self._bodies:
            for ending, value in falls.items():
                if body.unit == "m" and body.name.endswith(ending) and body.inertia > 0.0:
                    self._elements.append(constant_force(f"{body.name}.weight", body.name, value * body.inertia))
        for element in [item for item in self._elements if isinstance(item, MatrixElement) and item.mass.any()]:
            field_ = np.array([sum(value for ending, value in falls.items() if name.endswith(ending)) for name in element.coordinates])
            forces = element.mass @ field_ if element.falling is None else element.falling @ np.array(self._gravity)
            for name, force in zip(element.coordinates, forces.tolist(), strict=True):
                if force != 0.0:
                    self._elements.append(constant_force(f"{element.name}.{name}.weight", name, force))

    def _station_channels(self) -> list[Channel]:
        channels: list[Channel] = []
        for place, node_name in self._flanges.items():
            node = self._nodes[node_name]
            if node_name == "ground" or not node.lateral or (place != node_name and place.endswith((".a", ".b"))):
                continue
            station = self.station(place)
            centre = node.mass.centre if node.is_rotor and place == node_name and any(node.mass.centre[:2]) else None
            channels += station_channels(place, {key: station.stretch(key) for key in LATERAL}, centre, node_name, node.sense)
        return channels


def _at_rest(time: Value) -> Value:
    return 0.0 * time
