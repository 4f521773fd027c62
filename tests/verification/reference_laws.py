"""Laws for the reference train, written again from their equations and cut at every kink.

Nothing here comes from the package under test.  A law that is only piecewise smooth is given as
smooth pieces with the places of its kinks and jumps, so that the reference integrator can stop at
each of them and never steps across one.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Pieces:
    """A function of one variable: ``functions[k]`` holds between ``edges[k - 1]`` and ``edges[k]``."""

    edges: tuple[float, ...]
    functions: tuple[Callable[[float], float], ...]

    def __call__(self, x: float) -> float:
        return self.functions[bisect_right(self.edges, x)](x)


def polynomial(*coefficients: float) -> Callable[[float], float]:
    """c0 + c1 x + c2 x^2 + ..."""

    def value(x: float) -> float:
        total = 0.0
        for coefficient in reversed(coefficients):
            total = total * x + coefficient
        return total

    return value


def line(x0: float, y0: float, slope: float) -> Callable[[float], float]:
    """The straight line through (x0, y0)."""
    return lambda x: y0 + slope * (x - x0)


def odd(edges: Sequence[float], functions: Sequence[Callable[[float], float]]) -> Pieces:
    """The odd function with the given pieces at x > 0: ``functions[0]`` between -edges[0] and edges[0]."""

    def mirrored(function: Callable[[float], float]) -> Callable[[float], float]:
        return lambda x: -function(-x)

    inner, outer = functions[0], tuple(functions[1:])
    left = tuple(mirrored(function) for function in reversed(outer))
    return Pieces((*(-edge for edge in reversed(edges)), *edges), (*left, inner, *outer))


# -- flexspline ------------------------------------------------------------------------------------


def catalogue_stiffness(*, lost_motion: float, k1: float, k2: float, k3: float, t1: float, t2: float) -> Pieces:
    """Seed F (7)-(10) solved for the torque, with T1/K1 and (T2 - T1)/K2 where (9) and (10) are misprinted.

    phi = phi0/2 + T/K1;  phi0/2 + T1/K1 + (T - T1)/K2;  phi0/2 + T1/K1 + (T2 - T1)/K2 + (T - T2)/K3
    """
    edge = 0.5 * lost_motion
    first = edge + t1 / k1
    second = first + (t2 - t1) / k2
    return odd((edge, first, second), (polynomial(0.0), line(edge, 0.0, k1), line(first, t1, k2), line(second, t2, k3)))


def cubic_stiffness(linear: float, cubic: float) -> Pieces:
    """M = b phi + d phi^3, the form of (14) without its gap."""
    return Pieces((), (polynomial(0.0, linear, 0.0, cubic),))


def table(xs: Sequence[float], ys: Sequence[float], *, hold: bool) -> Pieces:
    """Straight lines through points; beyond the ends the last value (hold) or the last slope."""
    lines = [line(xs[k], ys[k], (ys[k + 1] - ys[k]) / (xs[k + 1] - xs[k])) for k in range(len(xs) - 1)]
    if hold:
        return Pieces(tuple(xs), (polynomial(ys[0]), *lines, polynomial(ys[-1])))
    return Pieces(tuple(xs[1:-1]), tuple(lines))


# -- motors and loads --------------------------------------------------------------------------------


def _nothing(t: float, angle: float, speed: float, states: Sequence[float]) -> tuple[float, ...]:
    return ()


def _no_rates(t: float, angle: float, speed: float, states: Sequence[float], regions: Sequence[int]) -> tuple[float, ...]:
    return ()


@dataclass(frozen=True)
class Drive:
    """A motor or a load: its torque, its states, and the variables whose regions select its pieces.

    torque(t, angle, speed, states, regions) : N m
    variables(t, angle, speed, states) : one number per tuple of ``edges``
    rates(t, angle, speed, states, regions) : time derivative of each state
    motion(t, regions) : (angle, speed, acceleration) of a rotor that follows its set speed whatever the torque
    """

    torque: Callable[..., float]
    edges: tuple[tuple[float, ...], ...] = ()
    variables: Callable[..., tuple[float, ...]] = _nothing
    start: tuple[float, ...] = ()
    rates: Callable[..., tuple[float, ...]] = _no_rates
    motion: Callable[[float, Sequence[int]], tuple[float, float, float]] | None = None


def in_time(function: Pieces | Callable[[float], float]) -> Drive:
    """A torque that is a given function of time."""
    if isinstance(function, Pieces):
        return Drive(
            torque=lambda t, q, w, z, region: function.functions[region[0]](t),
            edges=(function.edges,),
            variables=lambda t, q, w, z: (t,),
        )
    return Drive(torque=lambda t, q, w, z, region: function(t))


def in_speed(function: Pieces | Callable[[float], float]) -> Drive:
    """A torque that is a given function of the body's own speed."""
    if isinstance(function, Pieces):
        return Drive(
            torque=lambda t, q, w, z, region: function.functions[region[0]](w),
            edges=(function.edges,),
            variables=lambda t, q, w, z: (w,),
        )
    return Drive(torque=lambda t, q, w, z, region: function(w))


def sine(mean: float, amplitude: float, frequency: float) -> Drive:
    """mean + amplitude sin(2 pi f t)."""
    return in_time(lambda t: mean + amplitude * math.sin(2.0 * math.pi * frequency * t))


def kloss(*, power: float, speed: float, pole_pairs: int, frequency: float, breakdown: float) -> Drive:
    """M = 2 M_b / (s/s_b + s_b/s), s = 1 - w/w_s, with s_b from the rated point.

    At the rated slip M = M_b/lambda, so 2 lambda = s_N/s_b + s_b/s_N, a quadratic for s_b with the
    larger root s_N (lambda + sqrt(lambda^2 - 1)) (the rated point lies below breakdown).
    """
    w_s = 2.0 * math.pi * frequency / pole_pairs
    s_n = (w_s - speed) / w_s
    s_b = s_n * (breakdown + math.sqrt(breakdown * breakdown - 1.0))
    m_b = breakdown * power / speed

    def torque(w: float) -> float:
        s = (w_s - w) / w_s
        return 2.0 * m_b * s_b * s / (s * s + s_b * s_b)

    return in_speed(torque)


def inverter(*, power: float, speed: float, pole_pairs: int, frequency: float, breakdown: float, ramp_time: float) -> Drive:
    """Kloss's curve moved along the speed axis: at constant flux the torque depends on w_s(t) - w alone.

    w_s(t) rises linearly from 0 to its nominal value within ramp_time.
    """
    nominal = 2.0 * math.pi * frequency / pole_pairs
    x_b = (nominal - speed) * (breakdown + math.sqrt(breakdown * breakdown - 1.0))
    m_b = breakdown * power / speed

    def torque(t: float, q: float, w: float, z: Sequence[float], region: Sequence[int]) -> float:
        fed = nominal * t / ramp_time if region[0] == 0 else nominal
        x = fed - w
        return 2.0 * m_b / (x / x_b + x_b / x) if x != 0.0 else 0.0

    return Drive(torque=torque, edges=((ramp_time,),), variables=lambda t, q, w, z: (t,))


def servo(*, kp: float, ki: float, limit: float, wanted: float, ramp_time: float) -> Drive:
    """M = u = kp e + ki I within +-limit; dI/dt = e, but 0 while u is beyond the limit and e drives it further.

    e = w_ref(t) - w with w_ref rising linearly to ``wanted`` within ramp_time.
    """

    def error(t: float, w: float, ramping: bool) -> float:
        return (wanted * t / ramp_time if ramping else wanted) - w

    def variables(t: float, q: float, w: float, z: Sequence[float]) -> tuple[float, ...]:
        e = error(t, w, t < ramp_time)
        return t, kp * e + ki * z[0], e

    def torque(t: float, q: float, w: float, z: Sequence[float], region: Sequence[int]) -> float:
        u = kp * error(t, w, region[0] == 0) + ki * z[0]
        return (-limit, u, limit)[region[1]]

    def rates(t: float, q: float, w: float, z: Sequence[float], region: Sequence[int]) -> tuple[float, ...]:
        outward = (region[1] == 2 and region[2] == 1) or (region[1] == 0 and region[2] == 0)
        return (0.0 if outward else error(t, w, region[0] == 0),)

    return Drive(torque=torque, edges=((ramp_time,), (-limit, limit), (0.0,)), variables=variables, start=(0.0,), rates=rates)


def speed_ramp(*, end: float, duration: float) -> Drive:
    """A rotor that runs up linearly and then stays at its speed, whatever torque that takes."""

    def motion(t: float, region: Sequence[int]) -> tuple[float, float, float]:
        rate = end / duration
        if region[0] == 0:
            return 0.5 * rate * t * t, rate * t, rate
        return end * (t - 0.5 * duration), end, 0.0

    return Drive(
        torque=lambda t, q, w, z, region: 0.0,
        edges=((duration,),),
        variables=lambda t, q, w, z: (t,),
        motion=motion,
    )
