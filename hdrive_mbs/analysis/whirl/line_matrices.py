"""Mass, damping and stiffness of a whole line for small motions about a state of steady rotation.

Everything is seen from the fixed frame.  Shaft sections and bearing coefficients enter as they are; rotors enter
balanced and upright, with gyroscopic moments (the exact equations linearised, so whirl comes out in the inertial
frame); every other law is differentiated once and evaluated at each state.

What the forces across the axis and the laws of bearings change with the spin angle is left out: that angle goes on
with the rotation and does not stay near its value, so that these derivatives are periodic (balls that pass) and no
stiffness.  A ball bearing keeps its stiffness at the position of the balls that belongs to the angles given; taken as
springs, the others would hold the spin or drive it away from that position.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import LawError
from hdrive_mbs.expression import Expression, TraceError, Value, derivative, evaluate, record, scalar_function, trace, variables
from hdrive_mbs.network.circulation import Circulation
from hdrive_mbs.network.coupling import Coupling, Gyroscope
from hdrive_mbs.network.elements import Element, StateRate
from hdrive_mbs.network.excitation import Excitation
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment, recording_moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.network.rigid_motion import mass_at_rest

FloatArray = npt.NDArray[np.float64]

_KINDS = ("angle", "speed")


@dataclass(frozen=True, eq=False)
class LineSystem:
    """M q'' + D q' + K q = 0 over the named coordinates (spins count forward), each (n, n)."""

    names: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray


@dataclass(frozen=True)
class _Slope:
    """d(force on row)/d(coordinate of column) of an element: an expression of the state."""

    element: str
    row: int
    column: int
    kind: str
    value: Expression


@dataclass(frozen=True, eq=False)
class _Spinning:
    """What grows with a forward spin speed: a gyroscope in damping, circulation in stiffness."""

    spin: str
    kind: str
    at: tuple[npt.NDArray[np.intp], ...]
    """Rows and columns, as of np.ix_."""
    matrix: FloatArray
    """Per unit speed."""


class LineMatrices:
    """The linearised line, built once and evaluated at many states.

    First-order states (a servo's integral, a hysteresis) are held at their values; see ``check_memory``.
    """

    def __init__(self, network: Network) -> None:
        self.network = network
        self.names = tuple(body.name for body in network.bodies)
        self._index = {name: k for k, name in enumerate(self.names)}
        self._lateral = frozenset(body.name for body in network.bodies if body.lateral)
        n = len(self.names)
        self.mass = network.constant_mass.copy()
        self._damping, self._stiffness = np.zeros((n, n)), np.zeros((n, n))
        self._matrices = np.zeros((2, n, n))  # damping and stiffness of matrix elements alone
        self._laws = [element for element in network.elements if not isinstance(element, (MatrixElement, StateRate, Excitation))]
        self._spinning: list[_Spinning] = []
        self._slopes: list[_Slope] = []
        self._plain: list[Element] = []
        self._remembering: dict[str, str] = {}  # elements whose forces across the axis depend on a first-order state -> that state
        for rotor in network.rotors:
            at = [self._index[name] for name in rotor.coordinates]
            sense = np.array([1.0] * 5 + [float(rotor.sense)])
            self.mass[np.ix_(at, at)] += mass_at_rest(rotor.body.balanced()) * np.outer(sense, sense)
            self._add_gyroscope(rotor.coordinates[3], rotor.coordinates[4], rotor.coordinates[5], rotor.sense * rotor.body.polar)
        for element in network.elements:
            self._add(element)

    def _add(self, element: Element) -> None:
        if isinstance(element, MatrixElement):
            at = np.ix_(*[[self._index[name] for name in element.coordinates]] * 2)
            self._damping[at] += element.damping
            self._stiffness[at] += element.stiffness
            self._matrices[0][at] += element.damping
            self._matrices[1][at] += element.stiffness
        elif isinstance(element, Gyroscope):
            self._add_gyroscope(element.psi, element.theta, element.spin, element.polar)
        elif isinstance(element, Circulation):
            at = np.ix_(*[[self._index[name] for name in element.coordinates]] * 2)
            share = element.circulatory / len(element.spins)
            self._spinning += [_Spinning(spin, "stiffness", at, sense * share) for spin, sense in element.spins]
        elif not isinstance(element, (StateRate, Excitation)):
            self._add_law(element)

    def _add_gyroscope(self, psi: str, theta: str, spin: str, polar: float) -> None:
        at = np.ix_(*[[self._index[psi], self._index[theta]]] * 2)
        self._spinning.append(_Spinning(spin, "damping", at, polar * np.array([[0.0, 1.0], [-1.0, 0.0]])))

    def _add_law(self, element: Element) -> None:
        traced: dict[str, Value] = {}

        def total(moment: Moment) -> Value:
            traced.update(element.contribution(moment))
            return 0.0

        try:
            trace(total, recording_moment())
        except TraceError:
            self._plain.append(element)
            return
        for target, force in traced.items():
            if target not in self._index:
                continue
            recorded = record(force)
            for name in variables(recorded):
                kind, _, owner = name.partition(":")
                if kind == "state" and target in self._lateral:
                    self._remembering.setdefault(element.name, owner)
                if kind in _KINDS and owner in self._index and not (kind == "angle" and self._is_periodic(element, target, owner)):
                    self._add_slope(_Slope(element.name, self._index[target], self._index[owner], kind, derivative(recorded, name)))

    def _is_periodic(self, element: Element, target: str, coordinate: str) -> bool:
        """Whether the force on a target depends on the angle of a spin and not on a twist between two: see above."""
        if coordinate in self._lateral:
            return False
        if isinstance(element, Coupling):
            along = [factors for factors in element.stretches.values() if coordinate in factors]
            return all(self._lateral.issuperset(factors.keys() - {coordinate}) for factors in along)
        return target in self._lateral

    def _add_slope(self, slope: _Slope) -> None:
        if variables(slope.value):
            self._slopes.append(slope)
            return
        matrix = self._stiffness if slope.kind == "angle" else self._damping
        matrix[slope.row, slope.column] -= float(np.asarray(evaluate(slope.value, {})))

    @cached_property
    def _compiled_slopes(self) -> tuple[list[str], Callable[..., tuple[float, ...]]]:
        """Arguments, and a function of them that gives the slopes."""
        values = [slope.value for slope in self._slopes]
        arguments = sorted(variables(*values))
        return arguments, scalar_function(values, arguments)

    def at(self, angles: Mapping[str, float], speeds: Mapping[str, float], states: Mapping[str, float] | None = None) -> LineSystem:
        """The matrices at forward angles, speeds and states of the coordinates (time 0).

        Raises LawError where a law has no finite derivative.
        """
        damping, stiffness = self._damping.copy(), self._stiffness.copy()
        moment = self.network.moment(np.float64(0.0), angles, speeds, states or {})
        for part in self._spinning:
            target = damping if part.kind == "damping" else stiffness
            target[part.at] += float(moment.speed(part.spin)) * part.matrix
        if self._slopes:
            known = {"t": float(moment.time)}
            for kind, values in (("angle", moment.angles), ("speed", moment.speeds), ("state", moment.states)):
                known |= {f"{kind}:{name}": float(value) for name, value in values.items()}
            arguments, function = self._compiled_slopes
            for slope, value in zip(self._slopes, function(*(known[name] for name in arguments)), strict=True):
                matrix = stiffness if slope.kind == "angle" else damping
                if not np.isfinite(value):
                    raise LawError(self._endless(slope.element, self.names[slope.row], slope.kind, self.names[slope.column], moment))
                matrix[slope.row, slope.column] -= value
        for element in self._plain:
            self._difference(element, moment, damping, stiffness)
        return LineSystem(self.names, self.mass, damping, stiffness)

    def _endless(self, element: str, on: str, kind: str, owner: str, moment: Moment) -> str:
        values, what = (moment.angles, "") if kind == "angle" else (moment.speeds, "the speed of ")
        return (
            f"{element}: its force on {on} has no finite derivative with respect to {what}{owner} where that"
            f" is {float(values[owner]):.6g}, so the line cannot be linearised there. Make its law smooth at that point, like"
            " np.sqrt(x**2 + small**2) in place of np.sqrt(x**2), or give it a value of its own there with np.where."
        )

    def _difference(self, element: Element, moment: Moment, damping: FloatArray, stiffness: FloatArray) -> None:
        """Central differences for a law that cannot be recorded."""
        for matrix, kind in ((stiffness, "angles"), (damping, "speeds")):
            values = dict(getattr(moment, kind))
            for name, column in self._index.items():
                h = 1e-7 * max(1e-2, abs(float(values[name])))
                sides = []
                for sign in (1.0, -1.0):
                    moved = {**values, name: values[name] + sign * h}
                    there = Moment(
                        **{"time": moment.time, "angles": moment.angles, "speeds": moment.speeds, "states": moment.states, kind: moved}
                    )
                    sides.append(element.contribution(there))
                for target, up in sides[0].items():
                    if target in self._index and not (kind == "angles" and self._is_periodic(element, target, name)):
                        change = (float(up) - float(sides[1][target])) / (2.0 * h)
                        if not np.isfinite(change):
                            raise LawError(self._endless(element.name, target, kind.removesuffix("s"), name, moment))
                        matrix[self._index[target], column] -= change

    def check_memory(self) -> None:
        """Raise LawError where a lateral force depends on a first-order state, which moves with the whirl and is held here."""
        for element, state in self._remembering.items():
            raise LawError(
                f"{element}: its force across the axis depends on the first-order state {state!r}, which M q'' + D q' + K q = 0 has no"
                " place for, so that damping and frequencies would come out without it. Leave it out of the scene, put a law without"
                " states in its place (for RelaxingDamping InternalDamping with the same time, where the whirl is slow in the turning"
                " shaft), or simulate the line in time."
            )

    def depends_on(self) -> frozenset[str] | None:
        """Variables of the state that slopes depend on (``speed:rotor``, ``angle:rotor.x``), the spins of gyroscopes and
        circulation apart; None where a law cannot be recorded, so that it is not known."""
        return None if self._plain else frozenset().union(*(variables(slope.value) for slope in self._slopes))

    def couplings(self) -> npt.NDArray[np.bool_]:
        """Which coordinates act on which at any state, (n, n)."""
        found: npt.NDArray[np.bool_] = np.full(self.mass.shape, bool(self._plain))
        for matrix in (self.mass, self._damping, self._stiffness):
            found |= matrix != 0.0
        for part in self._spinning:
            found[part.at] |= part.matrix != 0.0
        for slope in self._slopes:
            found[slope.row, slope.column] = True
        return found

    def varying(self) -> dict[str, set[str]]:
        """Lateral coordinates whose slopes depend on the state -> on which variables (``speed:rotor``); none for a linear line."""
        lateral = self._lateral
        found: dict[str, set[str]] = {}
        for slope in self._slopes:
            if self.names[slope.row] in lateral and self.names[slope.column] in lateral:
                found.setdefault(self.names[slope.row], set()).update(variables(slope.value))
        zero, states = dict.fromkeys(self.names, np.float64(0.0)), {state.name: state.initial for state in self.network.states}
        moment = self.network.moment(np.float64(0.0), zero, zero, states)
        for element in self._plain:
            for name in lateral & set(element.contribution(moment)):
                found.setdefault(name, set())
        return found

    def forces(self, angles: Mapping[str, float], speeds: Mapping[str, float], states: Mapping[str, float] | None = None) -> FloatArray:
        """Forces on all coordinates with nothing accelerating [N, N m], shape (n,); of balanced, upright rotors."""
        moment = self.network.moment(np.float64(0.0), angles, speeds, states or {})
        displacements, rates = (np.array([float(values[name]) for name in self.names]) for values in (moment.angles, moment.speeds))
        total = -(self._matrices[0] @ rates + self._matrices[1] @ displacements)
        for element in self._laws:
            for name, value in element.contribution(moment).items():
                if name in self._index:
                    total[self._index[name]] += float(np.asarray(value))
        return np.asarray(total)
