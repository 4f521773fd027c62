"""The network while it is being built: parts add to it, effects change it.

A part or effect of a user's own needs only these methods: ``body``, ``connection``,
``add_torque``, ``add_connection``, ``add_state``, ``prescribe`` and ``add_channel``; on rotor lines
also ``station``, ``add_station``, ``add_coordinate``, ``add_matrix`` and ``add_coupling``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import LawError, PlaceError, SceneError, unknown_place
from hdrive_mbs.expression import TraceError, Value, gradient
from hdrive_mbs.network.channels import Reading, body_channels, connection_channels, resolved_channels
from hdrive_mbs.network.connection_draft import ConnectionDraft, Torque
from hdrive_mbs.network.coupling import Coupling, Forces
from hdrive_mbs.network.elements import AppliedTorque, Connection, Element, StateRate
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Body, Channel, Motion, Network, Rotor, State
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.network.sensor_draft import SensorDraft
from hdrive_mbs.network.station import (
    LATERAL,
    Station,
    constant_force,
    coordinate_names,
    station_bodies,
    station_channels,
    weights,
)

FloatArray = npt.NDArray[np.float64]


class Draft:
    """A network under construction."""

    def __init__(self, nodes: dict[str, Node], flanges: dict[str, str], offsets: dict[str, float] | None = None) -> None:
        self._nodes = nodes
        self._flanges = flanges  # flange path -> node name
        self._offsets = offsets or {}  # flange path -> axial distance from the node [m]
        self._bodies: list[Body] = []
        self._gravity = (0.0, 0.0, 0.0)
        self._motions: dict[str, Callable[[Value], Value]] = {}
        self._connections: dict[str, ConnectionDraft] = {}
        self._aliases: dict[str, str] = {}  # other names of a connection
        self._states: dict[str, State] = {}
        self._elements: list[Element] = []
        self._channels: dict[str, Channel] = {}
        self._readings: list[Reading] = []
        self._sensors: dict[str, SensorDraft] = {}
        self._sources: dict[str, Reading] = {}  # channel made from another channel -> that channel
        self._finished: tuple[Element, ...] = ()
        self._positions: dict[str, float] = {}  # of places that are no flanges

    # -- places ---------------------------------------------------------------------------------
    def body(self, place: str, asked_by: str = "This") -> Node:
        """The rotating place of that name: coordinate name, inertia, sense and ratio.

        Raises PlaceError when the place does not exist or is not a body.
        """
        if place in self._flanges:
            return self._nodes[self._flanges[place]]
        known = [name for name in self._flanges if self._flanges[name] != "ground"]
        if place in self._connections or place in self._aliases:
            raise PlaceError(f"{asked_by} acts on a rotating body, but {place!r} is a connection. Bodies: {', '.join(known)}.")
        raise unknown_place("body", place, known)

    def connection(self, place: str, asked_by: str = "This", flanges: tuple[str, ...] = ()) -> ConnectionDraft:
        """The connection of that name (a shaft, the mesh of a gear), which must have these flanges.

        Raises PlaceError when the place does not exist, is not a connection or lacks a flange.
        """

        def fits(draft: ConnectionDraft) -> bool:
            return set(flanges) <= set(draft.bodies)

        name = self._aliases.get(place, place)
        aliases = [alias for alias, owner in self._aliases.items() if fits(self._connections[owner])]
        known = [*(key for key, draft in self._connections.items() if fits(draft)), *aliases]
        if name in self._connections:
            found = self._connections[name]
            if fits(found):
                return found
            raise PlaceError(
                f"{asked_by} needs a connection with the flanges {', '.join(flanges)}, but {place!r} has "
                f"{', '.join(found.bodies) or 'none'}. Such connections: {', '.join(known) or 'none'}."
            )
        if place in self._flanges:
            raise PlaceError(f"{asked_by} acts on a connection, but {place!r} is a body. Connections: {', '.join(known)}.")
        raise unknown_place("connection", place, known)

    # -- building -------------------------------------------------------------------------------
    def add_connection(
        self, name: str, factors: dict[str, float], law: Torque, *, aliases: tuple[str, ...] = (), bodies: dict[str, str] | None = None
    ) -> ConnectionDraft:
        """A torsional element along  x = sum(f_i q_i); channels twist, twist_rate and torque."""
        merged: dict[str, float] = {}
        for coordinate, factor in factors.items():
            merged[coordinate] = merged.get(coordinate, 0.0) + factor
        draft = ConnectionDraft(name, merged, law, bodies=dict(bodies or {}))
        self._connections[name] = draft
        self._aliases |= dict.fromkeys(aliases, name)
        return draft

    def add_torque(
        self,
        name: str,
        coordinate: str,
        torque: Callable[[Moment], Value],
        *,
        dissipative: bool = False,
        stored: Callable[[Moment], Value] | None = None,
        is_motor: bool = False,
    ) -> None:
        """A torque on a coordinate, positive in its forward sense.

        stored : energy in its states
        is_motor : it is that of the motor ``<motor>`` and called ``<motor>.torque``; effects may change what reaches the rotor
        """
        self._elements.append(AppliedTorque(name, coordinate, torque, dissipative, stored, is_motor))

    def add_inertia(self, place: str, inertia: float, asked_by: str = "This") -> None:
        """More inertia [kg m^2] at a place, or less.  Raises PlaceError where it leaves none, or where the place moves across the axis."""
        node = self.body(place, asked_by)
        if node.lateral or not node.inertia + inertia > 0.0:
            known = [path for path, name in self._flanges.items() if not self._nodes[name].lateral and self._nodes[name].inertia > -inertia]
            raise PlaceError(
                f"{asked_by} changes the inertia of {place!r} by {inertia:g} kg m^2, which has {node.inertia:g} kg m^2 "
                f"that only turn. Places where it can be done: {', '.join(known) or 'none'}."
            )
        self._nodes[node.name] = replace(node, inertia=node.inertia + inertia)

    def add_relative_torque(self, name: str, factors: dict[str, float], torque: Torque, *, dissipative: bool = False) -> None:
        """A torque(moment, x, dx/dt) that resists along  x = sum(f_i q_i), with its reactions; no twist channels."""
        self._elements.append(Connection(name, dict(factors), torque, (), dissipative))

    # -- rotor lines ----------------------------------------------------------------------------
    def station(self, place: str, asked_by: str = "This") -> Station:
        """The place as a station with lateral motion.

        Raises PlaceError when it does not exist or only turns.
        """
        node = self.body(place, asked_by)
        if not node.lateral and node.name != "ground":
            known = [path for path, name in self._flanges.items() if self._nodes[name].lateral]
            raise PlaceError(
                f"{asked_by} needs a place with lateral motion, but {place!r} only turns. Such places: {', '.join(known) or 'none'}."
            )
        offset = self._offsets.get(place, 0.0)
        return Station(node.name, coordinate_names(node.name), offset, node.sense, node.position + offset)

    def add_station(self, name: str, mass: RigidMass, *, like: Station, position: float) -> Station:
        """A further station inside a part (a node of a shaft with distributed mass), turning like another."""
        source = self._nodes[like.node]
        self._nodes[name] = Node(name, 0.0, source.sense, source.ratio, True, mass, False, position)
        self._flanges[name] = name
        return Station(name, coordinate_names(name), 0.0, source.sense, position)

    def add_mass(self, station: Station, mass: RigidMass) -> None:
        """More mass at a station that is already there."""
        if not station.held:
            node = self._nodes[station.node]
            self._nodes[station.node] = replace(node, mass=node.mass + mass.moved(station.offset))

    def add_coordinate(self, name: str, *, inertia: float, unit: str, doc: str, group: str = "", shown_as: str = "") -> str:
        """A lateral coordinate of a part's own (a housing, a mode): channels name, name_rate and name_acceleration.

        group, shown_as : see Body
        """
        self._bodies.append(Body(name, inertia, 1, 0.0, unit, lateral=True, group=group, shown_as=shown_as))
        self.add_displacement(name, {name: 1.0}, unit, doc)
        return name

    def add_displacement(
        self, name: str, factors: Mapping[str, float], unit: str, doc: str, offset: Callable[[], float] = lambda: 0.0
    ) -> None:
        """Channels name, name_rate and name_acceleration of a sum of lateral coordinates and a constant offset."""
        if name in self._channels:
            return
        rate = f"{name}_rate"
        self._channels[name] = Channel(
            name, unit, doc, lambda m: sum((f * m.angle(c) for c, f in factors.items()), offset()), rate, factors
        )
        self._channels[rate] = Channel(
            rate, f"{unit}/s", f"rate of the {doc}", lambda m: sum(f * m.speed(c) for c, f in factors.items()), f"{name}_acceleration"
        )

    def set_position(self, place: str, position: float) -> None:
        """Where on the axis a place lies [m] that is no station (the ring inside a condensed part)."""
        self._positions[place] = position

    def add_matrix(
        self,
        name: str,
        stations: tuple[Station, ...],
        coordinates: tuple[str, ...] = (),
        *,
        stiffness: FloatArray,
        damping: FloatArray | None = None,
        mass: FloatArray | None = None,
        falling: FloatArray | None = None,
    ) -> None:
        """Constant matrices over the 6-vectors of stations (x, y, z, psi, theta, phi in true sense), then coordinates.

        Rows and columns of phi must be zero in stiffness and damping: torsion is a connection, which effects can change.
        falling : see MatrixElement
        """
        names = [name for station in stations for name in station.names] + list(coordinates)
        arm = np.eye(len(names))
        for k, station in enumerate(stations):
            arm[6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = station.arm()
        zero = np.zeros_like(stiffness)
        matrices = [
            arm.T @ np.asarray(item, float) @ arm
            for item in (zero if mass is None else mass, zero if damping is None else damping, stiffness)
        ]
        light = {station.names[5] for k, station in enumerate(stations) if not matrices[0][6 * k + 5].any()}
        used = list(dict.fromkeys(item for item in names if item != "ground" and item not in light))
        gather = np.array([[float(item == kept) for kept in used] for item in names])
        made = [gather.T @ item @ gather for item in matrices]
        weight = None if falling is None else gather.T @ arm.T @ falling
        self._elements.append(MatrixElement(name, tuple(used), made[0], made[1], made[2], weight))

    def add_coordinate_matrix(self, name: str, names: tuple[str, ...], *, stiffness: FloatArray, damping: FloatArray) -> None:
        """Constant matrices over coordinates by name ("ground" is held)."""
        kept = [k for k, item in enumerate(names) if item != "ground"]
        at = np.ix_(kept, kept)
        self._elements.append(MatrixElement(name, tuple(names[k] for k in kept), np.zeros((len(kept),) * 2), damping[at], stiffness[at]))

    def is_rotor(self, station: Station) -> bool:
        """Whether the station is a rigid body with all its couplings and free to turn."""
        return self._nodes[station.node].is_rotor and station.node not in self._motions

    def add_coupling(self, name: str, stretches: dict[str, dict[str, float]], forces: Forces, *, dissipative: bool = False) -> None:
        """Forces along several stretches that depend on each other, positive when they resist."""
        self._elements.append(Coupling(name, stretches, forces, dissipative))

    def add_element(self, element: Element) -> None:
        """Any element: something with a name and contribution(moment)."""
        self._elements.append(element)

    @property
    def gravity(self) -> tuple[float, float, float]:
        """Gravity [m/s^2]; known when all parts are built."""
        return self._gravity

    def set_gravity(self, acceleration: tuple[float, float, float]) -> None:
        """Gravity for all lateral motion [m/s^2].  Raises SceneError when the scene has one already."""
        if self._gravity != (0.0, 0.0, 0.0):
            raise SceneError("The scene has more than one Gravity part; one is for all parts, so remove the others.")
        self._gravity = acceleration

    def motor_torque(self, place: str, asked_by: str = "This") -> Callable[[Moment], Value]:
        """The torque ``<place>.torque`` that a part puts on its body.

        Raises PlaceError when there is none (a motor with a prescribed motion has none).
        """
        torques = {element.name: element.torque for element in self._elements if isinstance(element, AppliedTorque)}
        if f"{place}.torque" in torques:
            return torques[f"{place}.torque"]
        known = [name.removesuffix(".torque") for name in torques if name.endswith(".torque")]
        raise PlaceError(f"{asked_by} needs a part with a torque law, but {place!r} has none. Such parts: {', '.join(known) or 'none'}.")

    def change_motor(
        self, place: str, change: Callable[[Callable[[Moment], Value]], Callable[[Moment], Value]], asked_by: str = "This"
    ) -> Callable[[Moment], Value]:
        """Let ``change(torque)`` reach the rotor of a motor in place of its torque; returns it.

        The channel ``<place>.torque`` stays what the characteristic gives.  Raises PlaceError where no motor with a torque law is.
        """
        self.body(place, asked_by)
        for k, element in enumerate(self._elements):
            if isinstance(element, AppliedTorque) and element.is_motor and element.name == f"{place}.torque":
                changed = replace(element, torque=change(element.torque))
                self._elements[k] = changed
                return changed.torque
        motors = [item.name.removesuffix(".torque") for item in self._elements if isinstance(item, AppliedTorque) and item.is_motor]
        raise PlaceError(f"{asked_by} needs a motor with a torque law, but {place!r} is none. Motors: {', '.join(motors) or 'none'}.")

    def add_state(self, name: str, *, unit: str, initial: float, rate: Callable[[Moment], Value]) -> str:
        """A first-order state dz/dt = rate(moment); returns its (unique) name."""
        unique, number = name, 2
        while unique in self._states:
            unique, number = f"{name}_{number}", number + 1
        self._states[unique] = State(unique, unit, initial)
        self._elements.append(StateRate(unique, rate))
        self.add_channel(unique, unit, f"state {unique}", lambda moment: moment.state(unique))
        return unique

    def prescribe(self, coordinate: str, angle: Callable[[Value], Value]) -> None:
        """Make the forward angle of a coordinate a function of time.

        Raises LawError where the angle cannot be differentiated.
        """
        try:
            gradient(gradient(angle))
        except TraceError as error:
            raise LawError(f"The motion of {coordinate!r} must be written with numpy functions, to be differentiated: {error}.") from None
        self._motions[coordinate] = angle

    def add_channel(self, name: str, unit: str, doc: str, read: Callable[[Moment], Value], *, slope: str | None = None) -> None:
        """A named quantity of the result."""
        if name not in self._channels:
            self._channels[name] = Channel(name, unit, doc, read, slope)

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

    def add_reading(self, name: str, quantity: str, change: Callable[[Value], Value], *, unit: str | None = None) -> None:
        """A sensor: a channel ``change(quantity)``; its unit is that of the quantity unless given."""
        source = self.read_channel(quantity, asked_by=repr(name))
        sensor = SensorDraft(name, source, change, unit or "", source)
        self.add_channel(name, sensor.unit, f"reading of {quantity}", sensor.reading)
        self._channels[name] = replace(self._channels[name], reads=quantity)
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

    def holding_torque(self, node: Node) -> Callable[[Moment], Value]:
        """Torque [N m] that keeps a prescribed place on its motion:  J d2(angle)/dt2 - sum of the torques on it.

        Leaves out what the unbalance of a whirling rotor asks for, m e times its lateral acceleration.
        """

        def read(moment: Moment) -> Value:
            acceleration = gradient(gradient(self._motions[node.name]))(moment.time)
            total: Value = (node.inertia + node.mass.polar) * acceleration + 0.0 * moment.time
            for element in self._finished:
                total = total - element.contribution(moment).get(node.name, 0.0)
            return total

        return read

    # -- the end --------------------------------------------------------------------------------
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
        )

    def _finish_station(self, node: Node, bodies: list[Body], rotors: list[Rotor]) -> None:
        turning = RigidMass(0.0, (0.0, 0.0, 0.0), ((0.0,) * 3, (0.0,) * 3, (0.0, 0.0, node.inertia)))
        made = station_bodies(
            node.name, node.mass + turning, node.sense, node.ratio, is_rotor=node.is_rotor, motion=self._motions.get(node.name)
        )
        bodies += made.bodies
        self._elements += made.elements
        rotors += [made.rotor] if made.rotor else []

    def _check_masses(self, bodies: list[Body]) -> None:
        """Refuse a coordinate that nothing accelerates."""
        heavy = {
            name
            for item in self._elements
            if isinstance(item, MatrixElement)
            for name, value in zip(item.coordinates, np.diag(item.mass), strict=True)
            if value > 0.0
        }
        for body in bodies:
            if not body.inertia > 0.0 and body.name not in heavy:
                unit = "kg" if body.unit == "m" else "kg m^2"
                raise SceneError(
                    f"{body.name!r} has no inertia ({body.inertia:g} {unit}), so its acceleration is undefined. Give the ring of the "
                    "bearing mass and moments of inertia, put a Rotor there, or give the shaft a density."
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
            for name, force in zip(element.coordinates, forces, strict=True):
                if force != 0.0:
                    self._elements.append(constant_force(f"{element.name}.{name}.weight", name, float(force)))

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
