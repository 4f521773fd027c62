"""The assembled equations: M(q) q'' = forces, dz/dt = rates, prescribed motions given."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import LawError
from hdrive_mbs.expression import Value, gradient, record, variables
from hdrive_mbs.network.elements import AppliedTorque, Connection, Element, StateRate
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment, recording_moment
from hdrive_mbs.network.probed import Probed, probed
from hdrive_mbs.network.rigid_mass import RigidMass
from hdrive_mbs.network.rigid_motion import forces_of_motion, kinetic_energy, mass_matrix
from hdrive_mbs.network.running_rate import RunningRate
from hdrive_mbs.network.stretch_rate import StretchRate
from hdrive_mbs.tracked_arrays import added_at, diagonal


@dataclass(frozen=True)
class Body:
    """A coordinate with inertia: the turning of a place, or one lateral motion of a station.

    inertia : kg m^2, or kg where unit is m (all parts that are rigidly connected at this place)
    sense : +1 or -1, true sense of rotation of the forward coordinate about the common axis
    ratio : ideal speed of this body per speed of the driving motor, in true sense (0 for lateral motions)
    unit : unit of the coordinate, "rad" or "m"
    lateral : whether it is a lateral, axial or tilting motion and not the turning of a place
    shown_as : displacement channel that users know in place of the coordinate, and for which initial values are given
    group : coordinates in a row with the same group are used together, so that the engine can keep them in one node
    """

    name: str
    inertia: float
    sense: int
    ratio: float
    unit: str = "rad"
    lateral: bool = False
    group: str = ""
    shown_as: str = ""


@dataclass(frozen=True)
class Rotor:
    """A rigid body with six coordinates [x, y, z, psi, theta, phi], rotation 1-2-3 (seed M (2)).

    coordinates : their names; the last, the spin, counts forward
    body : mass, centre of mass and inertia tensor in the frame that turns with it
    """

    name: str
    coordinates: tuple[str, ...]
    body: RigidMass
    sense: int


@dataclass(frozen=True)
class Motion:
    """A coordinate whose forward angle is a given function of time."""

    name: str
    angle: Callable[[Value], Value]
    sense: int
    ratio: float

    def speed(self, time: Value) -> Value:
        """d(angle)/dt by differentiation of the recorded law."""
        return gradient(self.angle)(time) + 0.0 * time


@dataclass(frozen=True)
class State:
    """A first-order state of a law."""

    name: str
    unit: str
    initial: float


@dataclass(frozen=True)
class Channel:
    """A quantity that can be read from every moment of a run.

    slope : channel that holds its rate
    factors : of coordinates, where it is a lateral displacement; a run then has ``<name>_acceleration`` too
    sense : -1 for an angle or speed of a place that turns backward while a motor drives it forward
    probed : what a displacement across the axis along a direction of its own looks at
    reads : channel that a sensor reads, where this is its reading;  scaled : whether that may have another unit
    """

    name: str
    unit: str
    doc: str
    read: Callable[[Moment], Value]
    slope: str | None = None
    factors: Mapping[str, float] | None = None
    reads: str | None = None
    scaled: bool = True
    sense: int = 1
    probed: Probed | None = None


@dataclass(frozen=True)
class Network:
    """Bodies, motions, states, elements and the channels that can be read from them."""

    bodies: tuple[Body, ...]
    motions: tuple[Motion, ...]
    states: tuple[State, ...]
    elements: tuple[Element, ...]
    channels: tuple[Channel, ...]
    places: Mapping[str, str]
    rotors: tuple[Rotor, ...] = ()
    positions: Mapping[str, float] = field(default_factory=dict)
    """Axial position of each place on the shaft [m], from the lengths of the sections."""
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    members: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Kind (bearing, support, shaft) -> names of what of that kind effects may change."""

    def root_quantity(self, name: str) -> str:
        """The quantity that a sensor reads, through other sensors; that of anything else is its own."""
        source = {channel.name: channel.reads for channel in self.channels if channel.reads is not None}
        while name in source:
            name = source[name]
        return name

    def probed(self, quantity: str) -> Probed | None:
        """What a channel looks at, through sensors that read it; None for one that is no displacement of a place across the axis."""
        return probed(
            self.root_quantity(quantity),
            self.places,
            {channel.name: channel.probed for channel in self.channels if channel.probed is not None},
        )

    def moment(self, time: Value, angles: Mapping[str, Value], speeds: Mapping[str, Value], states: Mapping[str, Value]) -> Moment:
        """A moment in which the prescribed motions are filled in."""
        angles, speeds = dict(angles), dict(speeds)
        for motion in self.motions:
            angles[motion.name] = motion.angle(time) + 0.0 * time
            speeds[motion.name] = motion.speed(time)
        return Moment(time=time, angles=angles, speeds=speeds, states=states)

    def torques(self, moment: Moment) -> dict[str, Value]:
        """Sum of all torques on each body and of all rates on each state."""
        total: dict[str, Value] = {body.name: 0.0 for body in self.bodies}
        total |= {state.name: 0.0 for state in self.states}
        for element in self.elements:
            for target, value in element.contribution(moment).items():
                if target in total:
                    total[target] = total[target] + value
        return total

    def accelerations(self, moment: Moment) -> dict[str, Value]:
        """Forward acceleration of each coordinate [rad/s^2, m/s^2] and the rate of each state.

        With rotors or matrices of mass the equations M(q) q'' = Q - h(q, q') are solved, on arrays or numbers.
        """
        total = self.torques(moment)
        rates = {state.name: total[state.name] for state in self.states}
        if not self.is_coupled:
            return {**{body.name: total[body.name] / body.inertia for body in self.bodies}, **rates}
        names = [body.name for body in self.bodies]
        index = {name: k for k, name in enumerate(names)}
        count = np.broadcast_shapes(*(np.shape(total[name]) for name in names), np.shape(moment.time))
        force = np.stack([np.broadcast_to(np.asarray(total[name], float), count) for name in names], axis=-1)
        mass = np.broadcast_to(self.constant_mass, (*count, len(names), len(names))).copy()
        for rotor in self.rotors:
            at = [index[name] for name in rotor.coordinates]
            q, v = self._true(rotor, moment)
            sense = np.array([1.0] * 5 + [float(rotor.sense)])
            mass[..., np.ix_(at, at)[0], np.ix_(at, at)[1]] += mass_matrix(rotor.body, q) * np.outer(sense, sense)
            force[..., at] -= sense * forces_of_motion(rotor.body, q, v)
        solved = np.linalg.solve(mass, force[..., None])[..., 0]
        return {**{name: solved[..., k] for k, name in enumerate(names)}, **rates}

    def _true(self, rotor: Rotor, moment: Moment) -> tuple[list[Value], list[Value]]:
        """Coordinates and speeds of a rotor in the true sense."""
        senses = (1, 1, 1, 1, 1, rotor.sense)
        q = [sense * moment.angle(name) for sense, name in zip(senses, rotor.coordinates, strict=True)]
        v = [sense * moment.speed(name) for sense, name in zip(senses, rotor.coordinates, strict=True)]
        return q, v

    @property
    def matrices(self) -> tuple[MatrixElement, ...]:
        """The elements with constant matrices."""
        return tuple(element for element in self.elements if isinstance(element, MatrixElement))

    @cached_property
    def is_coupled(self) -> bool:
        """Whether accelerations depend on each other: rotors, or matrices of mass."""
        return bool(self.rotors) or any(element.mass.any() for element in self.matrices)

    @cached_property
    def constant_mass(self) -> npt.NDArray[np.float64]:
        """Mass matrix over the bodies [kg, kg m^2] without the rotors."""
        index = {body.name: k for k, body in enumerate(self.bodies)}
        owned = {name for rotor in self.rotors for name in rotor.coordinates}
        mass = diagonal([0.0 if body.name in owned else body.inertia for body in self.bodies])
        for element in self.matrices:
            mass = added_at(mass, np.array([index[name] for name in element.coordinates], int), element.mass)
        return mass

    def kinetic_energy(self, moment: Moment) -> Value:
        """Sum over bodies, rotors and matrices of mass [J]."""
        owned = {name for rotor in self.rotors for name in rotor.coordinates}
        free = [body for body in self.bodies if body.name not in owned]
        total = sum(0.5 * body.inertia * moment.speed(body.name) ** 2 for body in free)
        total = total + sum(element.kinetic(moment) for element in self.matrices if element.mass.any())
        return total + sum(kinetic_energy(rotor.body, *self._true(rotor, moment)) for rotor in self.rotors)

    def power_taken(self, moment: Moment) -> dict[str, Value]:
        """Power that each connection or torque takes from the bodies [W], by element name."""
        return {element.name: element.power(moment) for element in self.elements if hasattr(element, "power")}

    @cached_property
    def is_lateral(self) -> bool:
        """Whether anything moves across the axis."""
        return any(body.lateral for body in self.bodies)

    def turning(self) -> Network:
        """The torsional network alone: what turns, and the elements and states that touch nothing else.

        Raises LawError for a torque that depends on a state which goes on with the rotation (``Draft.add_running_state``), and for a state
        of the turning that follows what moves across the axis.
        """
        running = {element.state for element in self.elements if isinstance(element, RunningRate)}
        if not self.is_lateral and not running:
            return self
        moving = {element.state for element in self.elements if isinstance(element, StretchRate | RunningRate)}
        lateral = {body.name for body in self.bodies if body.lateral}
        lateral |= {name for rotor in self.rotors for name in rotor.coordinates[:5]}
        kept = tuple(element for element in self.elements if not _touches(element, lateral))
        bodies = tuple(body for body in self.bodies if not body.lateral)
        states = tuple(state for state in self.states if state.name not in moving)
        if running:
            _refuse_running(kept, running)
        _refuse_across(kept, lateral)
        return replace(self, bodies=bodies, states=states, elements=kept, rotors=(), channels=())

    @property
    def motions_drive(self) -> bool:
        """Whether a place other than the ground has a prescribed motion."""
        return any(motion.name != "ground" for motion in self.motions)

    def connection(self, name: str) -> Connection:
        """The connection of the given name (KeyError if there is none)."""
        for element in self.elements:
            if isinstance(element, Connection) and element.name == name:
                return element
        raise KeyError(name)

    def state_equations(self) -> tuple[StateRate, ...]:
        """The equations of the first-order states."""
        return tuple(element for element in self.elements if isinstance(element, StateRate))

    def random_moment(self, rng: np.random.Generator, count: int) -> Moment:
        """Moments of all magnitudes (1e-6 .. 1e3, both signs, and zero), for checks of laws."""
        return self.moment_of(random_values(rng, count, 1 + 2 * len(self.bodies) + len(self.states)))

    def moment_of(self, values: Sequence[npt.NDArray[np.float64]]) -> Moment:
        """Moments with these values in a row: the time, whose sign does not count, all angles, all speeds, all states."""
        names, n = [body.name for body in self.bodies], len(self.bodies)
        states = [state.name for state in self.states]
        return self.moment(
            np.abs(values[0]),
            dict(zip(names, values[1 : 1 + n], strict=True)),
            dict(zip(names, values[1 + n : 1 + 2 * n], strict=True)),
            dict(zip(states, values[1 + 2 * n :], strict=True)),
        )


def _reads(element: Element) -> set[str]:
    """Variables that an element depends on, by the names of ``recording_moment``."""
    try:
        return {name for value in element.contribution(recording_moment()).values() for name in variables(record(value))}
    except Exception:  # a law that cannot be recorded: whatever it raises, it raises again where it is used
        return set()


def _refuse_across(elements: Sequence[Element], lateral: set[str]) -> None:
    """Raise LawError for the equation of a state that depends on motion across the axis and does not say along what."""
    across = {f"{what}:{name}" for what in ("angle", "speed") for name in lateral}
    for equation in (element for element in elements if isinstance(element, StateRate)):
        for name in sorted(_reads(equation) & across):
            raise LawError(
                f"{equation.state}: its rate depends on {name.partition(':')[2]!r}, which moves across the axis, so steady rotation has"
                " no place for it. Make it with add_stretch_state(name, of, stretches, rate, unit=...), which says along what it follows."
            )


def _refuse_running(elements: Sequence[Element], running: set[str]) -> None:
    """Raise LawError for an element of a steady network that depends on a state which does not come to rest."""
    for element in elements:
        for name in sorted(_reads(element) & {f"state:{state}" for state in running}):
            raise LawError(
                f"{element.name}: its torque depends on the state {name.removeprefix('state:')!r}, which goes on with the rotation, so that"
                " nothing stands still where the train turns steadily. Such states (add_running_state) are for forces that shake the line"
                " (LateralEffect with excites = True); take add_state for one that comes to rest."
            )


def random_values(rng: np.random.Generator, count: int, rows: int) -> list[npt.NDArray[np.float64]]:
    """Rows of numbers of all magnitudes (1e-6 .. 1e3) and both signs, after a zero."""
    made = []
    for _ in range(rows):
        values = rng.choice((-1.0, 1.0), count) * 10.0 ** rng.uniform(-6.0, 3.0, count)
        values[0] = 0.0
        made.append(values)
    return made


def _touches(element: Element, lateral: set[str]) -> bool:
    """Whether an element acts on or along one of these coordinates (matrices and couplings of rotor lines always do)."""
    if isinstance(element, Connection):
        names = {*element.factors, *(name for term in element.terms for name in term.factors)}
        return not lateral.isdisjoint(names)
    if isinstance(element, AppliedTorque):
        return element.coordinate in lateral
    return isinstance(element, StretchRate | RunningRate) or not isinstance(element, StateRate)
