"""What moves across the axis in a network while it is being built: stations, coordinates and matrices."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import PlaceError, SceneError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.coupling import Coupling, Forces
from hdrive_mbs.network.draft_torsion import DraftTorsion
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Body, Channel
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.network.running_rate import RunningRate
from hdrive_mbs.network.station import Station, coordinate_names
from hdrive_mbs.network.stretch_rate import RateOver, stretch_rate
from hdrive_mbs.tracked_arrays import as_array, congruent

FloatArray = npt.NDArray[np.float64]


class DraftRotorLine(DraftTorsion):
    """Stations, lateral coordinates, matrices and couplings over them, and gravity."""

    def __init__(self, nodes: dict[str, Node], flanges: dict[str, str], offsets: dict[str, float] | None = None) -> None:
        super().__init__(nodes, flanges)
        self._offsets = offsets or {}  # flange path -> axial distance from the node [m]
        self._bodies: list[Body] = []
        self._gravity = (0.0, 0.0, 0.0)
        self._positions: dict[str, float] = {}  # of places that are no flanges

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
        zero = np.zeros(np.shape(stiffness))
        given = (zero if mass is None else mass, zero if damping is None else damping, stiffness)
        matrices = [congruent(as_array(item), arm) for item in given]
        light = {station.names[5] for k, station in enumerate(stations) if not matrices[0][6 * k + 5].any()}
        used = list(dict.fromkeys(item for item in names if item != "ground" and item not in light))
        gather = np.array([[float(item == kept) for kept in used] for item in names])
        made = [congruent(item, gather) for item in matrices]
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

    def add_coupling(
        self,
        name: str,
        stretches: dict[str, dict[str, float]],
        forces: Forces,
        *,
        dissipative: bool = False,
        stored: Callable[[Moment], Value] | None = None,
    ) -> None:
        """Forces along several stretches that depend on each other, positive when they resist; energy [J] that their states hold."""
        self._elements.append(Coupling(name, stretches, forces, dissipative, stored))

    def add_stretch_state(self, name: str, of: str, stretches: Mapping[str, Mapping[str, float]], rate: RateOver, *, unit: str) -> str:
        """A first-order state that begins at zero, dz/dt = rate(moment, stretches, their rates), of the coupling of that name."""
        return self._with_state(name, unit, 0.0, lambda unique: stretch_rate(unique, of, stretches, rate))

    def add_running_state(self, name: str, *, unit: str, rate: Callable[[Moment], Value]) -> str:
        """A first-order state that begins at zero and goes on with the rotation, dz/dt = rate(moment); for excitations alone."""
        return self._with_state(name, unit, 0.0, lambda unique: RunningRate(unique, rate))

    @property
    def gravity(self) -> tuple[float, float, float]:
        """Gravity [m/s^2]; known when all parts are built."""
        return self._gravity

    def set_gravity(self, acceleration: tuple[float, float, float]) -> None:
        """Gravity for all lateral motion [m/s^2].  Raises SceneError when the scene has one already."""
        if self._gravity != (0.0, 0.0, 0.0):
            raise SceneError("The scene has more than one Gravity part; one is for all parts, so remove the others.")
        self._gravity = acceleration
