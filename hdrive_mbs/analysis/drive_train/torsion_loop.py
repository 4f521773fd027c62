"""Quasi-static loop of a connection whose law has states: a slow cycle through the state equations."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from hdrive_mbs.analysis.drive_train.elastic_law import ElasticLaw
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.expression import TraceError, Value, record, scalar_function, variable
from hdrive_mbs.network.elements import Connection
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]

PERIOD = 1000.0
"""Duration of one cycle [s]: slow against any law whose states have a time of their own."""


@dataclass(frozen=True)
class Loop:
    """One cycle, from the largest torque down and up again.

    crossings : twists where the torque passes zero (on the way up, on the way down), lower first [rad]
    loss : energy lost in the cycle, the area of the loop [J]
    """

    torque: FloatArray
    twist: FloatArray
    crossings: tuple[float, float]
    loss: float
    status: str


def slow_loop(
    network: Network, connection: Connection, states: tuple[str, ...], *, largest_torque: float, points: int, cycles: int
) -> Loop:
    """Lead the twist along X cos(2 pi t / PERIOD) and integrate the states; X is found so that the torque peaks as asked.

    One body of the connection turns, all others stand; the torque is read at rate 0, so viscous
    damping takes no part.
    """
    cycle = _Cycle(network, connection, states)

    def peak(amplitude: float) -> float:
        return float(np.max(np.abs(cycle.run(amplitude, 1, 41)[1]))) - largest_torque

    # the law with its states at rest has about this twist
    low = high = float(ElasticLaw.of(network, connection.name).twist(largest_torque))
    while peak(low) > 0.0:
        low *= 0.5
    while peak(high) < 0.0:
        high *= 1.5
    amplitude = float(brentq(peak, low, high, xtol=1e-8 * high, rtol=1e-8))
    twist, torque = cycle.run(amplitude, cycles, points)
    closing = abs(torque[-1] - torque[0]) / float(np.max(np.abs(torque)))
    status = "complete" if closing < 1e-3 else f"the loop is not closed yet ({100.0 * closing:.2g} % of the torque); give more cycles"
    loss = float(np.sum(0.5 * (torque[1:] + torque[:-1]) * np.diff(twist)))
    return Loop(torque, twist, _crossings(twist, torque), loss, status)


class _Cycle:
    """The equations of one connection while its twist is led."""

    def __init__(self, network: Network, connection: Connection, states: tuple[str, ...]) -> None:
        self.name, self.states = connection.name, states
        self.start = np.array([state.initial for state in network.states if state.name in states])
        rates = {equation.state: equation.rate for equation in network.state_equations()}
        led, factor = _led_body(network, connection)
        offset = connection.stretch(_moment(network, led, 0.0, 0.0, {}))

        def equations(twist: Value, rate: Value, values: Sequence[Value]) -> list[Value]:
            moment = _moment(network, led, (twist - offset) / factor, rate / factor, dict(zip(states, values, strict=True)))
            return [*(rates[name](moment) for name in states), connection.torque(moment, twist, 0.0)]

        self.equations: Callable[..., Sequence[float]]
        try:
            names = ["x", "v", *states]
            recorded = [record(item) for item in equations(variable("x"), variable("v"), [variable(name) for name in states])]
            self.equations = scalar_function(recorded, names)
        except TraceError:
            self.equations = lambda x, v, *values: [float(item) for item in equations(x, v, values)]

    def run(self, amplitude: float, cycles: int, points: int) -> tuple[FloatArray, FloatArray]:
        """Twist and torque of the last cycle, from its largest twist; the first begins at rest at zero."""
        turn = 2.0 * np.pi / PERIOD

        def slope(phase: float, values: FloatArray) -> FloatArray:
            x, v = amplitude * math.sin(phase), amplitude * turn * math.cos(phase)
            return np.array(self.equations(x, v, *values.tolist())[:-1]) / turn

        end = 2.0 * np.pi * (cycles + 0.25)
        wanted = np.linspace(end - 2.0 * np.pi, end, points)
        solution = solve_ivp(slope, (0.0, end), self.start, t_eval=wanted, rtol=1e-7, atol=1e-9, max_step=np.pi / 20.0)
        if not solution.success:
            raise AnalysisError(f"{self.name}: the slow cycle could not be integrated ({solution.message}).")
        twist = amplitude * np.sin(wanted)
        torque = [self.equations(x, 0.0, *values)[-1] for x, values in zip(twist.tolist(), solution.y.T.tolist(), strict=True)]
        return twist, np.array(torque)


def _led_body(network: Network, connection: Connection) -> tuple[str, float]:
    """The body that turns, and its factor in the twist: one on which no kinematic error depends, if there is one."""
    bodies = {body.name for body in network.bodies}
    factors = {name: factor for name, factor in connection.factors.items() if name in bodies}
    erring = {name for term in connection.terms for name in term.factors}
    plain = {name: factor for name, factor in factors.items() if name not in erring} or factors
    name = max(plain, key=lambda key: abs(plain[key]))
    return name, plain[name]


def _moment(network: Network, led: str, angle: Value, speed: Value, states: Mapping[str, Value]) -> Moment:
    at_rest = {body.name: 0.0 for body in network.bodies}
    start = {state.name: state.initial for state in network.states}
    return network.moment(0.0, at_rest | {led: angle}, at_rest | {led: speed}, start | dict(states))


def _crossings(twist: FloatArray, torque: FloatArray) -> tuple[float, float]:
    """Twists at zero torque, by linear interpolation; of a flat stretch at zero its two ends."""
    sign = np.sign(torque)
    found = [float(twist[k]) for k in np.nonzero(sign == 0.0)[0]]
    for k in np.nonzero(sign[:-1] * sign[1:] < 0.0)[0]:
        found.append(float(twist[k] - torque[k] * (twist[k + 1] - twist[k]) / (torque[k + 1] - torque[k])))
    return (min(found), max(found)) if found else (0.0, 0.0)
