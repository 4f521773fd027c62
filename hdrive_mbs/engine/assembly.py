"""Network -> Exudyn system: Node1D/Mass1D for what turns or moves along one coordinate, rigid bodies for rotors,
coordinate spring-dampers, generic couplings, and constant matrices for shaft sections and bearing coefficients.

The spin of a rotor is kept in the true sense in the engine (a rigid body turns about +z) and counted
forward outside, like every other angle.

A first-order state z is the *velocity* of a unit-mass coordinate: 1 * dz/dt = rate.  It is exact in
every integrator, needs no Python callback and no GenericODE1; the coordinate itself (the integral
of z) touches nothing.
"""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import itemInterface as item  # noqa: N813

from hdrive_mbs.engine.guard import check_connector, check_coupling, check_scalar
from hdrive_mbs.engine.records import CoupledRecord, ScalarRecord, make_records, oriented, renamed
from hdrive_mbs.engine.symbolic import LARGEST_LAW, SYMBOLIC_VECTOR_LIMIT, connector_function, generic_function, written_out
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Expression, variables
from hdrive_mbs.expression.python_code import scalar_function
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Body, Network, Rotor

PLAIN = "ObjectConnectorCoordinateSpringDamper"
GEARED = "ObjectConnectorCoordinateSpringDamperExt"


class LoweringWarning(UserWarning):
    """A law runs as a Python callback in the solver's loop and slows it down."""


@dataclass(frozen=True)
class Lowered:
    """How one law entered the engine: 'native', 'symbolic' or 'python', and why not better."""

    element: str
    how: str
    reason: str = ""


@dataclass
class Assembly:
    """An Exudyn system made from a network, ready to be solved many times."""

    network: Network
    mbs: Any
    container: Any
    bodies: tuple[str, ...]
    states: tuple[str, ...]
    sensors: dict[str, tuple[Any, ...]]
    """First coordinate of a node -> sensors of its coordinates, speeds and (with rotors) accelerations."""
    groups: dict[str, tuple[str, ...]]
    """First coordinate of a node of several coordinates -> all of them."""
    signs: dict[str, int]
    """Sense of each coordinate in the engine against the forward one."""
    copies: tuple[str, ...]
    """Coordinates of rotors of which the engine keeps a copy (see _Builder.copied), after the states; "" for a joint."""
    lowered: list[Lowered] = field(default_factory=list)
    kept: list[Any] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    """What Python laws raised in the last run."""

    def set_initial(self, angles: Mapping[str, float], speeds: Mapping[str, float], states: Mapping[str, float]) -> None:
        """Initial forward angles and speeds of the bodies and values of the states."""
        q = [self.signs[name] * angles.get(name, 0.0) for name in self.bodies] + [0.0] * len(self.states)
        v = [self.signs[name] * speeds.get(name, 0.0) for name in self.bodies]
        v += [states.get(state.name, state.initial) for state in self.network.states]
        q += [self.signs.get(name, 1) * angles.get(name, 0.0) for name in self.copies]
        v += [self.signs.get(name, 1) * speeds.get(name, 0.0) for name in self.copies]
        self.mbs.systemData.SetODE2Coordinates(q, exu.ConfigurationType.Initial)
        self.mbs.systemData.SetODE2Coordinates_t(v, exu.ConfigurationType.Initial)


def assemble(network: Network, *, lowering: str = "symbolic", guard: bool = True) -> Assembly:
    """Build the Exudyn system.

    lowering : "symbolic" (default) or "python" (every law as a compiled Python callback: for
        comparison only)
    guard : compare every lowered law with the plain function at random points

    Warns LoweringWarning for a law that had to stay a Python callback; raises LawError when a
    lowered law differs from the plain one.
    """
    if lowering not in ("symbolic", "python"):
        raise ParameterError(f"lowering = {lowering!r}: must be 'symbolic' or 'python'.")
    builder = _Builder(network, lowering, guard)
    for element in network.elements:
        if isinstance(element, MatrixElement):
            builder.add_matrix(element)
            continue
        for record in make_records(element, network):
            if isinstance(record, ScalarRecord):
                builder.add_scalar(record)
            else:
                builder.add_coupled(builder.copied(oriented(record, builder.signs)))
    return builder.finish()


class _Builder:
    def __init__(self, network: Network, lowering: str, guard: bool) -> None:
        self.network, self.python, self.guard = network, lowering == "python", guard
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.lowered: list[Lowered] = []
        self.kept: list[Any] = []
        self.failures: list[str] = []
        self.nodes: dict[str, Any] = {}
        self.markers: dict[str, Any] = {}
        self.signs = {body.name: 1 for body in network.bodies}
        self.owner = {name: rotor for rotor in network.rotors for name in rotor.coordinates}
        self.groups = _groups(network.bodies)
        self.signs |= {rotor.coordinates[-1]: rotor.sense for rotor in network.rotors}
        self.copies: list[str] = []
        self.carried = self._masses_in_matrices()
        made: set[str] = set()
        for body in network.bodies:
            rotor = self.owner.get(body.name)
            if body.name in self.groups:
                if self.groups[body.name][0] == body.name:
                    self._add_group(self.groups[body.name])
            elif rotor is None:
                self._add_node(body.name, 0.0 if body.name in self.carried else body.inertia)
            elif rotor.name not in made:
                made.add(rotor.name)
                self._add_rotor(rotor)
        for state in network.states:
            self._add_node(state.name, 1.0)
        ground = self.mbs.AddNode(item.NodePointGround())
        self.ground = self.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))

    def _masses_in_matrices(self) -> dict[str, tuple[str, Body]]:
        """Bodies whose mass the first matrix that touches them carries: coordinate -> (matrix, body)."""
        free = {body.name: body for body in self.network.bodies if body.lateral and body.name not in self.owner}
        carried: dict[str, tuple[str, Body]] = {}
        for element in self.network.matrices:
            for name in element.coordinates:
                if name in free and name not in carried:
                    carried[name] = (element.name, free[name])
        return carried

    def _add_node(self, name: str, mass: float) -> None:
        node = self.mbs.AddNode(item.Node1D(referenceCoordinates=[0.0], initialCoordinates=[0.0], initialVelocities=[0.0]))
        if mass > 0.0:
            self.mbs.AddObject(item.Mass1D(nodeNumber=node, mass=mass))
        self.nodes[name] = node
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
            self.nodes[name] = node
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
            self.nodes[name] = node
            self.markers[name] = self.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=k))

    def copied(self, record: CoupledRecord) -> CoupledRecord:
        """The record over copies of a rotor's coordinates, where with the rotor's node itself it would be too wide.

        A symbolic coupling takes six coordinates, and a rotor's node has six already.
        """
        if record.outputs is None or self.python:
            return record
        touched = set(record.targets).union(record.depends)
        here = [name for name in self.owner if name in touched]
        if len(self._whole_nodes(tuple(touched))) <= SYMBOLIC_VECTOR_LIMIT or len(touched) > SYMBOLIC_VECTOR_LIMIT:
            return record
        return renamed(record, {name: self._twin(name) if name in record.targets else self._copy(name) for name in here})

    def _copy(self, name: str) -> str:
        """A coordinate c that follows coordinate q of a rotor, to be read by laws.

        A Node1D with the one equation J (c'' - q'') = 0, a row of a mass matrix: exact in every integrator.
        """
        copy = f"{name} copy~"
        if copy not in self.nodes:
            self.copies.append(name)
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
        if twin not in self.nodes:
            self.copies += [name, ""]
            self._add_node(twin, 0.0)
            self._add_node(f"{name} joint~", 0.0)
            place, inertia = self._in_rotor(name)
            mass = np.zeros((8, 8))
            mass[1, 0], mass[1, 2 + place] = inertia, -inertia
            mass[0, 1], mass[2 + place, 1] = inertia, -inertia
            self._add_mass([twin, f"{name} joint~", name], mass)
        return twin

    def _in_rotor(self, name: str) -> tuple[int, float]:
        """Which coordinate of its rotor it is, and the inertia there."""
        rotor = self.owner[name]
        place, body = rotor.coordinates.index(name), rotor.body
        return place, (body.mass, body.mass, body.mass, body.transverse, body.transverse, body.polar)[place]

    def _add_mass(self, names: Sequence[str], mass: Any) -> None:
        zero = np.zeros_like(mass)
        self.mbs.AddObject(
            item.ObjectGenericODE2(
                nodeNumbers=[self.nodes[name] for name in names],
                massMatrix=mass,
                stiffnessMatrix=zero,
                dampingMatrix=zero,
                forceVector=[0.0] * len(mass),
            )
        )

    # -- constant matrices -------------------------------------------------------------------------
    def add_matrix(self, element: MatrixElement) -> None:
        names = self._whole_nodes(element.coordinates)
        at = [names.index(name) for name in element.coordinates]
        mass, damping, stiffness = (np.zeros((len(names), len(names))) for _ in range(3))
        sense = np.array([float(self.signs.get(name, 1)) for name in element.coordinates])
        for target, source in ((mass, element.mass), (damping, element.damping), (stiffness, element.stiffness)):
            target[np.ix_(at, at)] = source * np.outer(sense, sense)
        for name in element.coordinates:
            matrix, body = self.carried.get(name, ("", None))
            if body is not None and matrix == element.name:
                mass[names.index(name), names.index(name)] += body.inertia
        self.mbs.AddObject(
            item.ObjectGenericODE2(
                nodeNumbers=self._unique_nodes(names),
                massMatrix=mass,
                stiffnessMatrix=stiffness,
                dampingMatrix=damping,
                forceVector=[0.0] * len(names),
            )
        )
        self.lowered.append(Lowered(element.name, "native"))

    def _whole_nodes(self, names: Sequence[str]) -> tuple[str, ...]:
        """The names with all six coordinates of every rotor among them, as the engine's nodes have them."""
        whole: dict[str, None] = {}
        for name in names:
            whole |= dict.fromkeys(self.owner[name].coordinates if name in self.owner else self.groups.get(name, (name,)))
        return tuple(whole)

    def _unique_nodes(self, names: Sequence[str]) -> list[Any]:
        """Nodes of these coordinates, each once."""
        return list({int(self.nodes[name]): self.nodes[name] for name in names}.values())

    # -- one displacement --------------------------------------------------------------------------
    def add_scalar(self, record: ScalarRecord) -> None:
        factors = {name: self.signs.get(name, 1) * value for name, value in record.factors.items()}
        (last, factor), *rest = reversed(list(factors.items()))
        first, other = (rest[0][0], rest[0][1]) if rest else ("ground", -1.0)
        markers = [self.markers[first] if rest else self.ground, self.markers[last]]
        unit = factor == 1.0 and (not rest or other == -1.0)
        geared: dict[str, Any] = {} if unit else {"factor0": -other, "factor1": factor}
        kind = PLAIN if unit else GEARED
        make = item.CoordinateSpringDamper if unit else item.CoordinateSpringDamperExt
        linear = record.linear()
        if linear is not None:
            stiffness, damping = linear
            if self.guard:
                check_scalar(record, lambda t, x, v: stiffness * x + damping * v)
            if linear != (0.0, 0.0):
                self.mbs.AddObject(make(markerNumbers=markers, stiffness=stiffness, damping=damping, **geared))
            self.lowered.append(Lowered(record.name, "native"))
            return
        function, how = self._connector_function(record, kind)
        self.mbs.AddObject(make(markerNumbers=markers, springForceUserFunction=function, **geared))
        self.lowered.append(Lowered(record.name, how, record.reason))

    def _connector_function(self, record: ScalarRecord, kind: str) -> tuple[Any, str]:
        if record.expression is None:
            self._warn(record.name, record.reason)
            plain = record.plain

            def law(mbs: Any, t: float, i: int, x: float, v: float, *_: float) -> float:
                try:
                    return float(plain(t, x, v))
                except Exception as error:
                    self._note(record.name, t, error)
                    raise

            return law, "python"
        if self.python or self._is_long(record.name, record.expression):
            compiled = scalar_function([record.expression], ["t", "x", "v"])
            return (lambda mbs, t, i, x, v, *_: compiled(t, x, v)[0]), "python"
        function = connector_function(self.mbs, kind, record.expression)
        self.kept.append(function)
        if self.guard:
            check_connector(self.mbs, function, kind, record)
        return function, "symbolic"

    # -- several coordinates -------------------------------------------------------------------------
    def add_coupled(self, record: CoupledRecord) -> None:
        outputs = {name: item_ for name, item_ in (record.outputs or {}).items() if not _is_zero(item_)}
        if not record.targets or (record.outputs is not None and not outputs):
            self.lowered.append(Lowered(record.name, "native"))  # zero, or on prescribed motions only
            return
        if record.outputs is None:
            self._warn(record.name, record.reason)
            self._add_plain(record)
            return
        groups = [tuple(outputs)] if self._size(outputs) <= SYMBOLIC_VECTOR_LIMIT else [(name,) for name in outputs]
        how = "symbolic"
        for group in groups:
            part = {name: outputs[name] for name in group}
            slow = self.python or self._is_wide(record.name, part) or self._is_long(record.name, *part.values())
            self._add_generic(record, part, "python" if slow else "symbolic")
            how = "python" if slow else how
        self.lowered.append(Lowered(record.name, how))

    def _names(self, outputs: Mapping[str, Expression]) -> tuple[str, ...]:
        seen = dict.fromkeys(outputs)
        for name in sorted(variables(*outputs.values())):
            if name != "t":
                seen[name.partition(":")[2]] = None
        return self._whole_nodes(tuple(seen))

    def _size(self, outputs: Mapping[str, Expression]) -> int:
        return len(self._names(outputs))

    def _add_generic(self, record: CoupledRecord, outputs: Mapping[str, Expression], how: str) -> None:
        names = self._names(outputs)
        states = {state.name for state in self.network.states}
        positions = ["" if name in states else f"angle:{name}" for name in names]
        velocities = [f"state:{name}" if name in states else f"speed:{name}" for name in names]
        rows = [outputs.get(name, Expression("constant", (), 0.0)) for name in names]
        if how == "symbolic":
            function = generic_function(self.mbs, rows, positions, velocities)
            self.kept.append(function)
            if self.guard:
                check_coupling(self.mbs, function, record, names, states, outputs)
        else:
            used = [name for name in [*positions, *velocities] if name]
            compiled = scalar_function(rows, ["t", *used])
            at = [k for k, name in enumerate(positions) if name]

            def function(mbs: Any, t: float, i: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
                return list(compiled(t, *(q[k] for k in at), *q_t))

        self._add_object(names, function)

    def _add_plain(self, record: CoupledRecord) -> None:
        names = self._whole_nodes([*record.targets, *record.depends])
        states = {state.name for state in self.network.states}
        plain: Callable[[Moment], dict[str, Any]] = record.plain

        def function(mbs: Any, t: float, i: int, q: Sequence[float], q_t: Sequence[float]) -> list[float]:
            speeds = dict(zip(names, map(float, q_t), strict=True))
            moment = Moment(
                time=t,
                angles=dict(zip(names, map(float, q), strict=True)),
                speeds=speeds,
                states={name: speeds[name] for name in names if name in states},
            )
            try:
                result = plain(moment)
                return [float(result.get(name, 0.0)) for name in names]
            except Exception as error:
                self._note(record.name, t, error)
                raise

        self._add_object(names, function)
        self.lowered.append(Lowered(record.name, "python", record.reason))

    def _add_object(self, names: Sequence[str], function: Any) -> None:
        n = len(names)
        zero = np.zeros((n, n))
        self.kept.append(function)
        self.mbs.AddObject(
            item.ObjectGenericODE2(
                nodeNumbers=self._unique_nodes(names),
                massMatrix=zero,
                stiffnessMatrix=zero,
                dampingMatrix=zero,
                forceVector=[0.0] * n,
                forceUserFunction=function,
            )
        )

    def _is_wide(self, name: str, outputs: Mapping[str, Expression]) -> bool:
        size = self._size(outputs)
        if size > SYMBOLIC_VECTOR_LIMIT:
            self._warn(name, f"it couples {size} coordinates, more than {SYMBOLIC_VECTOR_LIMIT}")
        return size > SYMBOLIC_VECTOR_LIMIT

    def _is_long(self, name: str, *expressions: Expression) -> bool:
        size = max(map(written_out, expressions))
        if size > LARGEST_LAW:
            self._warn(name, f"its shared parts written out make {size:.2g} operations, more than {LARGEST_LAW}")
        return size > LARGEST_LAW

    def _note(self, name: str, t: float, error: Exception) -> None:
        if not self.failures:
            self.failures.append(f"{name} fails at t = {t:.6g} s ({type(error).__name__}: {error})")

    # -- the end -------------------------------------------------------------------------------------
    def _warn(self, name: str, reason: str) -> None:
        warnings.warn(
            f"{name}: the law runs as a Python callback, several times slower than a symbolic one, because {reason}.",
            LoweringWarning,
            stacklevel=5,
        )

    def finish(self) -> Assembly:
        kinds = [exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t]
        if self.network.is_coupled:
            kinds.append(exu.OutputVariableType.Coordinates_tt)
        first = {int(node): name for name, node in reversed(self.nodes.items()) if not name.endswith("~")}
        sensors = {
            name: tuple(
                self.mbs.AddSensor(
                    item.SensorNode(nodeNumber=self.nodes[name], outputVariableType=kind, storeInternal=True, writeToFile=False)
                )
                for kind in kinds
            )
            for name in reversed(first.values())
        }
        self.mbs.Assemble()
        return Assembly(
            network=self.network,
            mbs=self.mbs,
            container=self.container,
            bodies=tuple(body.name for body in self.network.bodies),
            states=tuple(state.name for state in self.network.states),
            sensors=sensors,
            groups={group[0]: group for group in self.groups.values()},
            signs=self.signs,
            copies=tuple(self.copies),
            lowered=self.lowered,
            kept=self.kept,
            failures=self.failures,
        )


def _groups(bodies: Sequence[Body]) -> dict[str, tuple[str, ...]]:
    """Coordinate -> all that share its node: bodies in a row with the same group."""
    found: dict[str, tuple[str, ...]] = {}
    for group, members in itertools.groupby(bodies, key=lambda body: body.group):
        names = tuple(body.name for body in members)
        if group and len(names) > 1:
            found |= dict.fromkeys(names, names)
    return found


def _is_zero(expression: Expression) -> bool:
    return expression.operation == "constant" and expression.data == 0.0
