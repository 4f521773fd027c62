"""Nodes of the Exudyn system: what holds the coordinates of a network.

Node1D for what turns or moves along one coordinate, one node for several coordinates that are used together, rigid
bodies for rotors.  The spin of a rotor is kept in the true sense here (a rigid body turns about +z) and counted forward
outside, like every other angle.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from exudyn import itemInterface as item  # noqa: N813

from hdrive_mbs.engine.matrix import compact
from hdrive_mbs.engine.records import CoupledRecord, renamed
from hdrive_mbs.engine.symbolic import SYMBOLIC_VECTOR_LIMIT
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.network import Body, Network, Rotor


class Nodes:
    """All nodes with their masses, and a marker at each coordinate.

    signs : sense of each coordinate in the engine against the forward one
    groups : coordinate -> all that share its node
    copies : what each copy follows, as factors of coordinates in the engine's sense, in the order of the copies; none for a joint
    carried : bodies whose mass the first matrix that touches them carries: coordinate -> (matrix, body)
    """

    def __init__(self, mbs: Any, network: Network, laws: Iterable[CoupledRecord], matrices: Sequence[MatrixElement]) -> None:
        self.mbs, self.network, self.matrices = mbs, network, matrices
        self.at: dict[str, Any] = {}
        self.markers: dict[str, Any] = {}
        self.signs = {body.name: 1 for body in network.bodies}
        self.owner = {name: rotor for rotor in network.rotors for name in rotor.coordinates}
        self.groups = _groups(network.bodies, laws)
        self.signs |= {rotor.coordinates[-1]: rotor.sense for rotor in network.rotors}
        self.copies: list[dict[str, float]] = []
        self.carried = self._masses_in_matrices()
        self._make()

    def _make(self) -> None:
        made: set[str] = set()
        for body in self.network.bodies:
            rotor = self.owner.get(body.name)
            if body.name in self.groups:
                if self.groups[body.name][0] == body.name:
                    self._add_group(self.groups[body.name])
            elif rotor is None:
                self._add_node(body.name, 0.0 if body.name in self.carried else body.inertia)
            elif rotor.name not in made:
                made.add(rotor.name)
                self._add_rotor(rotor)
        for state in self.network.states:
            self._add_node(state.name, 1.0)
        ground = self.mbs.AddNode(item.NodePointGround())
        self.ground = self.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))

    def _masses_in_matrices(self) -> dict[str, tuple[str, Body]]:
        """Bodies whose mass the first matrix that touches them carries: coordinate -> (matrix, body)."""
        free = {body.name: body for body in self.network.bodies if body.lateral and body.name not in self.owner}
        carried: dict[str, tuple[str, Body]] = {}
        for element in self.matrices:
            for name in element.coordinates:
                if name in free and name not in carried:
                    carried[name] = (element.name, free[name])
        return carried

    def _add_node(self, name: str, mass: float) -> None:
        node = self.mbs.AddNode(item.Node1D(referenceCoordinates=[0.0], initialCoordinates=[0.0], initialVelocities=[0.0]))
        if mass > 0.0:
            self.mbs.AddObject(item.Mass1D(nodeNumber=node, mass=mass))
        self.at[name] = node
        self.markers[name] = self.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))

    def _add_group(self, names: tuple[str, ...]) -> None:
        """One node for several coordinates: faster than one for each."""
        zero = [0.0] * len(names)
        node = self.mbs.AddNode(
            item.NodeGenericODE2(
                referenceCoordinates=zero, initialCoordinates=zero, initialCoordinates_t=zero, numberOfODE2Coordinates=len(names)
            )
        )
        for k, name in enumerate(names):
            self.at[name] = node
            self.markers[name] = self.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=k))
        inertias = {body.name: 0.0 if body.name in self.carried else body.inertia for body in self.network.bodies}
        if any(inertias[name] for name in names):
            self._add_mass(names[:1], np.diag([inertias[name] for name in names]))

    def _add_rotor(self, rotor: Rotor) -> None:
        node = self.mbs.AddNode(item.NodeRigidBodyRxyz(referenceCoordinates=[0.0] * 6, initialVelocities=[0.0] * 6))
        tensor = np.array(rotor.body.inertia)
        six = [tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[1, 2], tensor[0, 2], tensor[0, 1]]
        self.mbs.AddObject(
            item.ObjectRigidBody(
                nodeNumber=node, mass=rotor.body.mass, centerOfMass=list(rotor.body.centre), inertia=[float(v) for v in six]
            )
        )
        for k, name in enumerate(rotor.coordinates):
            self.at[name] = node
            self.markers[name] = self.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=k))

    def copied(self, record: CoupledRecord) -> CoupledRecord:
        """The record over copies of a rotor's coordinates, where with the rotor's node itself it would be too wide.

        A symbolic coupling takes six coordinates, and a rotor's node has six already.  Stretches of its own are made here,
        once for all records that share them.
        """
        for name, factors in record.stretches.items():
            if name not in self.at:
                self._follow(name, factors)
        if record.outputs is None:
            return record
        touched = set(record.targets).union(record.depends)
        here = [name for name in self.owner if name in touched]
        if len(self.whole(tuple(touched))) <= SYMBOLIC_VECTOR_LIMIT or len(touched) > SYMBOLIC_VECTOR_LIMIT:
            return record
        return renamed(record, {name: self._twin(name) if name in record.targets else self._copy(name) for name in here})

    def _copy(self, name: str) -> str:
        """A coordinate c that follows coordinate q of a rotor, to be read by laws.

        A Node1D with the one equation J (c'' - q'') = 0, a row of a mass matrix: exact in every integrator.
        """
        copy = f"{name} copy~"
        if copy not in self.at:
            self.copies.append({name: 1.0})
            self._add_node(copy, 0.0)
            place, inertia = self._in_rotor(name)
            mass = np.zeros((7, 7))
            mass[0, 0], mass[0, 1 + place] = inertia, -inertia
            self._add_mass([copy, name], mass)
        return copy

    def _twin(self, name: str) -> str:
        """A coordinate c that follows coordinate q of a rotor and hands on to it every force F that acts on c.

        J (c'' - q'') = 0 as row of a coordinate p, and J p'' = F on c, (M q'')_q - J p'' = Q on q: p'' is the force
        of a rigid joint over J, found with the accelerations, so this too is exact in every integrator.
        """
        twin = f"{name} twin~"
        if twin not in self.at:
            self.copies += [{name: 1.0}, {}]
            self._add_node(twin, 0.0)
            self._add_node(f"{name} joint~", 0.0)
            place, inertia = self._in_rotor(name)
            mass = np.zeros((8, 8))
            mass[1, 0], mass[1, 2 + place] = inertia, -inertia
            mass[0, 1], mass[2 + place, 1] = inertia, -inertia
            self._add_mass([twin, f"{name} joint~", name], mass)
        return twin

    def _follow(self, name: str, factors: Mapping[str, float]) -> None:
        """A coordinate c = sum(f_i q_i) that hands on f_i F to q_i from every force F on c: ``_twin`` of a sum.

        J (c'' - sum(f_i q_i'')) = 0,  J p'' = F,  (M q'')_i - f_i J p'' = Q_i;  J is the inertia felt along c.
        """
        sensed = {c: self.signs.get(c, 1) * factor for c, factor in factors.items()}
        self.copies += [sensed, {}]
        joint = f"{name} joint~"
        self._add_node(name, 0.0)
        self._add_node(joint, 0.0)
        inertias = {body.name: body.inertia for body in self.network.bodies}
        light = sum(factor**2 / inertias[c] for c, factor in sensed.items() if inertias[c] > 0.0)
        inertia = 1.0 / light if light > 0.0 else 1.0
        names = [name, joint, *self.whole(tuple(sensed))]
        row = np.zeros(len(names))
        row[0] = inertia
        row[[names.index(c) for c in sensed]] = [-inertia * factor for factor in sensed.values()]
        mass = np.zeros((len(names), len(names)))
        mass[1], mass[:, 1] = row, row
        self._add_mass(names, mass)

    def _in_rotor(self, name: str) -> tuple[int, float]:
        """Which coordinate of its rotor it is, and the inertia there."""
        rotor = self.owner[name]
        place, body = rotor.coordinates.index(name), rotor.body
        return place, (body.mass, body.mass, body.mass, body.transverse, body.transverse, body.polar)[place]

    def _add_mass(self, names: Sequence[str], mass: Any) -> None:
        zero = np.zeros_like(mass)
        self.mbs.AddObject(
            item.ObjectGenericODE2(
                nodeNumbers=self.unique(names),
                massMatrix=compact(mass),
                stiffnessMatrix=compact(zero),
                dampingMatrix=compact(zero),
                forceVector=[0.0] * len(mass),
            )
        )

    def whole(self, names: Sequence[str]) -> tuple[str, ...]:
        """The names with all six coordinates of every rotor among them, as the engine's nodes have them."""
        whole: dict[str, None] = {}
        for name in names:
            whole |= dict.fromkeys(self.owner[name].coordinates if name in self.owner else self.groups.get(name, (name,)))
        return tuple(whole)

    def unique(self, names: Sequence[str]) -> list[Any]:
        """Nodes of these coordinates, each once."""
        return list({int(self.at[name]): self.at[name] for name in names}.values())


def _groups(bodies: Sequence[Body], laws: Iterable[CoupledRecord]) -> dict[str, tuple[str, ...]]:
    """Coordinate -> all that share its node: bodies in a row with the same group, unless that made a law too wide to be symbolic."""
    found: dict[str, tuple[str, ...]] = {}
    for group, members in itertools.groupby(bodies, key=lambda body: body.group):
        names = tuple(body.name for body in members)
        if group and len(names) > 1:
            found |= dict.fromkeys(names, names)
    for law in laws:
        touched = {*law.targets, *law.depends}
        wide = {member for name in touched for member in found.get(name, (name,))}
        if len(wide) > SYMBOLIC_VECTOR_LIMIT:
            for name in touched & set(found):
                for member in found.pop(name, ()):
                    found.pop(member, None)
    return found
