"""The elastic part of a connection: its torque against twist at rest, and the inverse of that."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.expression import TraceError, Value, derivative, evaluate, record, variable
from hdrive_mbs.network.elements import Connection
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]

LARGEST_TWIST = 1e4
"""Twist [rad] up to which a law is searched for a torque."""

RESOLUTION = 1e-14
"""Twist [rad] below which a gap counts as rounding."""


def elastic_laws(network: Network) -> dict[str, ElasticLaw]:
    """The elastic law of every connection that has one, by name."""
    laws = {element.name: ElasticLaw.of(network, element.name) for element in network.elements if isinstance(element, Connection)}
    return {name: law for name, law in laws.items() if law.resists}


class _Seen(Mapping[str, float]):
    """States at their initial values; remembers which of them a law looks at."""

    def __init__(self, values: Mapping[str, float]) -> None:
        self._values = dict(values)
        self.seen: dict[str, None] = {}

    def __getitem__(self, name: str) -> float:
        self.seen[name] = None
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)


@dataclass(frozen=True)
class ElasticLaw:
    """Torque of one connection with everything at rest: time 0, speeds and rate of twist 0.

    Kinematic errors take no part (they shift the twist, they do not make it), and states stand at
    their initial values; ``states`` names those that the law looks at (hysteresis).
    """

    connection: Connection
    moment: Moment
    states: tuple[str, ...]

    @classmethod
    def of(cls, network: Network, name: str) -> ElasticLaw:
        """The elastic law of the connection of that name."""
        connection = network.connection(name)
        states = _Seen({state.name: state.initial for state in network.states})
        zero = {body.name: 0.0 for body in network.bodies}
        moment = network.moment(0.0, zero, zero, states)
        connection.torque(moment, 1e-3, 0.0)
        connection.torque(moment, -1e-3, 0.0)
        return cls(connection, moment, tuple(states.seen))

    @property
    def resists(self) -> bool:
        """Whether some twist gives a torque at rest (friction along a connection does not)."""
        sizes = np.geomspace(1e-7, 10.0, 100)
        return bool(np.any(self.torque(np.concatenate([-sizes, sizes])) != 0.0))

    def torque(self, twist: npt.ArrayLike) -> FloatArray:
        """Elastic torque [N m] at a twist [rad], point by point where the law takes no arrays."""
        x = np.asarray(twist, float)
        try:
            return np.asarray(self.connection.torque(self.moment, x, 0.0 * x), float) + 0.0 * x
        except (TypeError, ValueError):
            flat = [float(self.connection.torque(self.moment, float(value), 0.0)) for value in x.ravel()]
            return np.array(flat).reshape(x.shape)

    def stiffness(self, twist: FloatArray, side: npt.ArrayLike = 1.0) -> FloatArray:
        """Tangent stiffness [N m/rad] on the side of larger (+1) or smaller (-1) twist, by differentiation of the law.

        Where the law cannot be recorded, the slope over a distance of 1e-6 of the twist.
        """
        towards = np.broadcast_to(np.asarray(side, float), twist.shape)
        beside = twist + towards * 1e-10 * np.maximum(np.abs(twist), 1e-4)
        try:
            law = record(self.connection.torque(self.moment, variable("x"), 0.0))
            return np.asarray(evaluate(derivative(law, "x"), {"x": beside}), float) + 0.0 * twist
        except TraceError:
            step = towards * 1e-6 * np.maximum(np.abs(twist), 1e-4)
            return (self.torque(beside + step) - self.torque(beside)) / step

    # -- the inverse ------------------------------------------------------------------------------
    def edges(self) -> tuple[float, float]:
        """Twists between which the torque vanishes [rad]; twice the same without lost motion."""
        low, high = self._bracket()
        grid = np.linspace(low, high, 2001)
        torques = self.torque(grid)
        lower = _last(lambda x: self.torque(x) < 0.0, grid, torques < 0.0)
        upper = _first(lambda x: self.torque(x) > 0.0, grid, torques > 0.0)
        if upper - lower > RESOLUTION:
            return lower, upper
        crossing = 0.5 * (lower + upper)
        return (crossing, crossing) if abs(crossing) > RESOLUTION else (0.0, 0.0)

    def twist(self, torque: npt.ArrayLike) -> FloatArray:
        """Twist [rad] at which a torque growing from zero [N m] first reaches this value.

        Zero is approached from above (+0.0) or below (-0.0) and gives the edge of the gap on that
        side.  A jump of the law is passed at its edge.  Raises AnalysisError where the law never
        reaches the torque.
        """
        wanted = np.asarray(torque, float)
        flat = np.atleast_1d(wanted).ravel()
        result = np.empty_like(flat)
        negative = np.signbit(flat)
        lower, upper = self.edges()
        result[flat == 0.0] = np.where(negative[flat == 0.0], lower, upper)
        for sign, edge, members in ((1.0, upper, ~negative & (flat != 0.0)), (-1.0, lower, negative & (flat != 0.0))):
            if members.any():
                result[members] = self._reached(sign, edge, flat[members])
        return result.reshape(wanted.shape)

    def falls_within(self, low: float, high: float) -> float | None:
        """A twist at which the torque falls with growing twist, if there is one between the two [rad]."""
        grid = np.linspace(low, high, 4001)
        torques = self.torque(grid)
        falls = np.diff(torques) < -1e-9 * float(np.max(np.abs(torques), initial=0.0))
        return float(grid[int(np.argmax(falls))]) if falls.any() else None

    def _reached(self, sign: float, edge: float, wanted: FloatArray) -> FloatArray:
        """First twist from the edge outward at which sign * torque >= sign * wanted."""
        goal = sign * wanted
        distance = self._distance(sign, edge, float(goal.max()))
        grid = np.linspace(0.0, distance, 2001)
        highest = np.maximum.accumulate(sign * self.torque(edge + sign * grid))
        place = np.clip(np.searchsorted(highest, goal, side="left"), 1, len(grid) - 1)
        low, high = grid[place - 1], grid[place]
        for _ in range(80):
            middle = 0.5 * (low + high)
            beyond = sign * self.torque(edge + sign * middle) >= goal
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        return edge + sign * high

    def _distance(self, sign: float, edge: float, goal: float) -> float:
        distance = 1e-6
        while distance < LARGEST_TWIST:
            if sign * float(self.torque(edge + sign * distance)) >= goal:
                return distance
            distance *= 2.0
        raise AnalysisError(
            f"{self.connection.name} never reaches {sign * goal:g} N m within a twist of {LARGEST_TWIST:g} rad; ask for a smaller torque."
        )

    def _bracket(self) -> tuple[float, float]:
        """Twists at which the torque is negative and positive."""
        low = high = 1e-6
        while not float(self.torque(-low)) < 0.0:
            low *= 2.0
            if low > LARGEST_TWIST:
                raise self._one_sided("negative")
        while not float(self.torque(high)) > 0.0:
            high *= 2.0
            if high > LARGEST_TWIST:
                raise self._one_sided("positive")
        return -low, high

    def _one_sided(self, which: str) -> AnalysisError:
        return AnalysisError(
            f"{self.connection.name} gives no {which} torque up to a twist of {LARGEST_TWIST:g} rad, "
            "so it has no torsion curve: its law must resist both senses of twist."
        )


def _first(holds: Callable[[float], Value], grid: FloatArray, found: npt.NDArray[np.bool_]) -> float:
    """Smallest x at which the condition holds, by bisection in the first grid interval that shows it."""
    k = int(np.argmax(found))
    return _bisect(holds, float(grid[k - 1]), float(grid[k]))


def _last(holds: Callable[[float], Value], grid: FloatArray, found: npt.NDArray[np.bool_]) -> float:
    """Largest x at which the condition holds."""
    k = len(grid) - 1 - int(np.argmax(found[::-1]))
    return _bisect(holds, float(grid[k + 1]), float(grid[k]))


def _bisect(holds: Callable[[float], Value], fails: float, good: float) -> float:
    for _ in range(80):
        middle = 0.5 * (fails + good)
        if bool(holds(middle)):
            good = middle
        else:
            fails = middle
    return good
