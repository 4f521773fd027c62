"""Where the torque of the drive goes at the end of a run: into spin, or into whirl (the Sommerfeld effect)."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.time_response import Response, read_over
from hdrive_mbs.expression import Value
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.signals import FloatArray

MOMENTS = 2000
"""Samples of the run over which torques are averaged."""

HELD = 0.05
"""Largest acceleration of a captured line, as a share of that which its drive would give it without whirl."""

SLIP = 1.02
"""A line that would run less than 2 % faster without whirl is not captured but at its own speed."""

FASTEST = 20.0
"""Multiple of the mean speed up to which the drive's own speed is looked for."""


@dataclass(frozen=True)
class TorqueBalance:
    """Mean torques on all that turns over a span, reduced to the reference shaft by the speed ratios [N m].

    speed : mean speed of the reference shaft [rad/s]
    acceleration : slope of the straight line through its speed [rad/s^2]
    applied : drive, loads, drag and bearing friction together
    whirl : what is left of it after acceleration: applied - inertia x acceleration, the torque that whirl takes
    inertia : of all that turns [kg m^2]
    driven_speed : speed at which the applied torque would vanish, with everything else as it is, if whirl took none
        [rad/s]; infinite where it goes on driving up to 20 times the speed
    """

    speed: float
    acceleration: float
    applied: float
    whirl: float
    inertia: float
    driven_speed: float

    @property
    def is_captured(self) -> bool:
        """Whether whirl takes the torque that would drive the line to a speed that is more than 2 % higher."""
        drives = self.applied * math.copysign(1.0, self.speed) > 0.0
        held = abs(self.inertia * self.acceleration) <= HELD * abs(self.applied)
        return drives and held and abs(self.driven_speed) > SLIP * abs(self.speed)


def torque_balance(network: Network, response: Response, reference: str, start: float, end: float) -> TorqueBalance:
    """Balance of the mean torques from ``start`` to ``end`` [s].

    sum(r_i Q_i) = sum(r_i^2 J_i) W' + M_whirl  with the ideal ratios r_i: elastic torques cancel, and what the spin of
    unbalanced rotors feels from their whirl remains.  Means are weighted with (t - start)(end - t): the mean of W' is then
    the slope of the least-squares straight line through W (integrate by parts), which oscillations hardly move.
    """
    inside = np.nonzero((response.times >= start) & (response.times <= end))[0]
    times = response.times[inside]
    speeds = response.values[f"{reference}.speed"][inside]
    spins = [body for body in network.bodies if not body.lateral]
    inertia = sum(body.ratio**2 * body.inertia for body in spins)
    slope, mean = np.polyfit(times - 0.5 * (times[0] + times[-1]), speeds, 1) if len(times) > 1 else (0.0, float(speeds[0]))
    few = inside[np.unique(np.linspace(0, len(inside) - 1, MOMENTS).astype(int))]
    at = response.times[few]
    weights = (at - times[0]) * (times[-1] - at) if len(few) > 2 else np.ones(len(few))
    angles: dict[str, FloatArray] = {}
    rates: dict[str, FloatArray] = {}
    for body in network.bodies:
        names = (body.name, f"{body.name}_rate") if body.lateral else (f"{body.name}.angle", f"{body.name}.speed")
        angles[body.name], rates[body.name] = (body.sense * response.values[name][few] for name in names)
    states = {state.name: response.values[state.name][few] for state in network.states}

    def applied(factor: float) -> float:
        faster = {body.name: rates[body.name] * (1.0 if body.lateral else factor) for body in network.bodies}
        moment = network.moment(at, angles, faster, states)

        def total(here: Moment) -> Value:
            torques = network.torques(here)
            return sum(body.sense * body.ratio * torques[body.name] for body in spins) + 0.0 * here.time

        return _mean(at, read_over(total, moment), weights)

    torque = applied(1.0)
    return TorqueBalance(
        speed=float(mean),
        acceleration=float(slope),
        applied=torque,
        whirl=torque - inertia * float(slope),
        inertia=float(inertia),
        driven_speed=float(mean) * _vanishing(applied, torque * math.copysign(1.0, float(mean))),
    )


def _mean(times: FloatArray, values: FloatArray, weights: FloatArray) -> float:
    if len(times) < 2:
        return float(values[0])
    return float(np.trapezoid(weights * values, times) / np.trapezoid(weights, times))


def _vanishing(applied: Callable[[float], float], torque: float) -> float:
    """Factor on all speeds at which the applied torque first vanishes; 1 where it does not drive."""
    if not torque > 0.0:
        return 1.0
    factors = np.geomspace(1.0, FASTEST, 80)
    sign = math.copysign(1.0, applied(1.0))
    before = torque
    for low, high in itertools.pairwise(factors):
        here = sign * applied(float(high))
        if here <= 0.0:
            return float(low + (high - low) * before / (before - here))
        before = here
    return math.inf
