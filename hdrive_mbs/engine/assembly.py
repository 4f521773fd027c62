"""Network -> Exudyn system: nodes, coordinate spring-dampers, generic couplings, and constant matrices for shaft
sections and bearing coefficients.

A first-order state z is the *velocity* of a unit-mass coordinate: 1 * dz/dt = rate.  It is exact in
every integrator, needs no Python callback and no GenericODE1; the coordinate itself (the integral
of z) touches nothing.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import itemInterface as item  # noqa: N813

from hdrive_mbs.engine.guard import check_connector, check_coupling, check_scalar
from hdrive_mbs.engine.matrix import compact, compact_alike
from hdrive_mbs.engine.nodes import Nodes
from hdrive_mbs.engine.records import CoupledRecord, ScalarRecord, make_records, oriented
from hdrive_mbs.engine.symbolic import LARGEST_LAW, SYMBOLIC_VECTOR_LIMIT, connector_function, generic_function, written_out
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Expression, variables
from hdrive_mbs.expression.python_code import scalar_function
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network

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
    copies: tuple[Mapping[str, float], ...]
    """What the copies follow (see Nodes.copied), after the states, as factors of coordinates in the engine's sense; none for a joint."""
    lowered: list[Lowered] = field(default_factory=list)
    kept: list[Any] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)
    """What Python laws raised in the last run."""

    def set_initial(self, angles: Mapping[str, float], speeds: Mapping[str, float], states: Mapping[str, float]) -> None:
        """Initial forward angles and speeds of the bodies and values of the states."""
        q = [self.signs[name] * angles.get(name, 0.0) for name in self.bodies] + [0.0] * len(self.states)
        v = [self.signs[name] * speeds.get(name, 0.0) for name in self.bodies]
        v += [states.get(state.name, state.initial) for state in self.network.states]
        for own, given in ((q, angles), (v, speeds)):
            own += [sum(f * self.signs.get(name, 1) * given.get(name, 0.0) for name, f in copy.items()) for copy in self.copies]
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
    records = [
        record
        for element in network.elements
        if not isinstance(element, MatrixElement)
        for record in make_records(element, network, follow=lowering == "symbolic")
    ]
    matrices = _together(network.matrices)
    builder = _Builder(network, [record for record in records if isinstance(record, CoupledRecord)], matrices, lowering, guard)
    for matrix in matrices:
        builder.add_matrix(matrix)
    builder.lowered += [Lowered(matrix.name, "native") for matrix in network.matrices]
    for record in records:
        if isinstance(record, ScalarRecord):
            builder.add_scalar(record)
        else:
            turned = oriented(record, builder.nodes.signs)
            builder.add_coupled(turned if lowering == "python" else builder.nodes.copied(turned))
    return builder.finish()


class _Builder:
    def __init__(
        self, network: Network, laws: Sequence[CoupledRecord], matrices: Sequence[MatrixElement], lowering: str, guard: bool
    ) -> None:
        self.network, self.python, self.guard = network, lowering == "python", guard
        self.container = exu.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.lowered: list[Lowered] = []
        self.kept: list[Any] = []
        self.failures: list[str] = []
        self.nodes = Nodes(self.mbs, network, laws, matrices)

    # -- constant matrices -------------------------------------------------------------------------
    def add_matrix(self, element: MatrixElement) -> None:
        names = self.nodes.whole(element.coordinates)
        at = [names.index(name) for name in element.coordinates]
        mass, damping, stiffness = (np.zeros((len(names), len(names))) for _ in range(3))
        sense = np.array([float(self.nodes.signs.get(name, 1)) for name in element.coordinates])
        for target, source in ((mass, element.mass), (damping, element.damping), (stiffness, element.stiffness)):
            target[np.ix_(at, at)] = source * np.outer(sense, sense)
        for name in element.coordinates:
            matrix, body = self.nodes.carried.get(name, ("", None))
            if body is not None and matrix == element.name:
                mass[names.index(name), names.index(name)] += body.inertia
        elastic, viscous = compact_alike(stiffness, damping)
        self.mbs.AddObject(
            item.ObjectGenericODE2(
                nodeNumbers=self.nodes.unique(names),
                massMatrix=compact(mass),
                stiffnessMatrix=elastic,
                dampingMatrix=viscous,
                forceVector=[0.0] * len(names),
            )
        )

    # -- one displacement --------------------------------------------------------------------------
    def add_scalar(self, record: ScalarRecord) -> None:
        factors = {name: self.nodes.signs.get(name, 1) * value for name, value in record.factors.items()}
        (last, factor), *rest = reversed(list(factors.items()))
        first, other = (rest[0][0], rest[0][1]) if rest else ("ground", -1.0)
        markers = [self.nodes.markers[first] if rest else self.nodes.ground, self.nodes.markers[last]]
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
        return self.nodes.whole(tuple(seen))

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
        names = self.nodes.whole([*record.targets, *record.depends])
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
                nodeNumbers=self.nodes.unique(names),
                massMatrix=compact(zero),
                stiffnessMatrix=compact(zero),
                dampingMatrix=compact(zero),
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
        first = {int(node): name for name, node in reversed(self.nodes.at.items()) if not name.endswith("~")}
        sensors = {
            name: tuple(
                self.mbs.AddSensor(
                    item.SensorNode(nodeNumber=self.nodes.at[name], outputVariableType=kind, storeInternal=True, writeToFile=False)
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
            groups={group[0]: group for group in self.nodes.groups.values()},
            signs=self.nodes.signs,
            copies=tuple(self.nodes.copies),
            lowered=self.lowered,
            kept=self.kept,
            failures=self.failures,
        )


def _together(matrices: Sequence[MatrixElement]) -> list[MatrixElement]:
    """The matrices with each added to another one that has all its coordinates: fewer objects to go through."""
    kept: list[MatrixElement] = []
    for element in sorted(matrices, key=lambda item: -len(item.coordinates)):
        host = next((k for k, other in enumerate(kept) if set(element.coordinates) <= set(other.coordinates)), None)
        if host is None:
            kept.append(element)
            continue
        other = kept[host]
        at = np.ix_(*[[other.coordinates.index(name) for name in element.coordinates]] * 2)
        sums = [matrix.copy() for matrix in (other.mass, other.damping, other.stiffness)]
        for target, source in zip(sums, (element.mass, element.damping, element.stiffness), strict=True):
            target[at] += source
        kept[host] = MatrixElement(other.name, other.coordinates, *sums)
    return kept


def _is_zero(expression: Expression) -> bool:
    return expression.operation == "constant" and expression.data == 0.0
