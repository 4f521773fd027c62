"""The assembled equations: J_i dw_i/dt = sum of torques, dz/dt = rates, prescribed motions given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.expression import Value, gradient
from hdrive_mbs.network.elements import AppliedTorque, Connection, Element, StateRate
from hdrive_mbs.network.moment import Moment


@dataclass(frozen=True)
class Body:
    """A rotating inertia.

    inertia : kg m^2 (all parts that are rigidly connected at this place)
    sense : +1 or -1, true sense of rotation of the forward coordinate about the common axis
    ratio : ideal speed of this body per speed of the driving motor, in true sense
    """

    name: str
    inertia: float
    sense: int
    ratio: float


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
    """A quantity that can be read from every moment of a run."""

    name: str
    unit: str
    doc: str
    read: Callable[[Moment], Value]
    slope: str | None = None


@dataclass(frozen=True)
class Network:
    """Bodies, motions, states, elements and the channels that can be read from them."""

    bodies: tuple[Body, ...]
    motions: tuple[Motion, ...]
    states: tuple[State, ...]
    elements: tuple[Element, ...]
    channels: tuple[Channel, ...]
    places: Mapping[str, str]

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
        """Forward angular acceleration of each body [rad/s^2] and the rate of each state."""
        total = self.torques(moment)
        return {
            **{body.name: total[body.name] / body.inertia for body in self.bodies},
            **{state.name: total[state.name] for state in self.states},
        }

    def kinetic_energy(self, moment: Moment) -> Value:
        """Sum of J w^2 / 2 [J]."""
        return sum(0.5 * body.inertia * moment.speed(body.name) ** 2 for body in self.bodies)

    def power_taken(self, moment: Moment) -> dict[str, Value]:
        """Power that each connection or torque takes from the bodies [W], by element name."""
        return {element.name: element.power(moment) for element in self.elements if isinstance(element, (Connection, AppliedTorque))}

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

        def draw() -> Value:
            values = rng.choice((-1.0, 1.0), count) * 10.0 ** rng.uniform(-6.0, 3.0, count)
            values[0] = 0.0
            return values

        return self.moment(
            np.abs(draw()),
            {body.name: draw() for body in self.bodies},
            {body.name: draw() for body in self.bodies},
            {state.name: draw() for state in self.states},
        )
