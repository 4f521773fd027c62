"""Speed controller and motor: torque command, lag, ripple, fading, saturation."""

from __future__ import annotations

import math
from typing import NamedTuple

from benchmarks.withheld.plant.compiled import compiled

# the integrator stops within this distance of the limit; a sharp stop would chatter, this follows its mean
STOP = 1e-3  # N m


class Motor(NamedTuple):
    """What the motor makes of the command; all zero at the nominal bench.

    Lag of second order: T'' = w_n^2 (command - T) - 2 z w_n T'.  Ripple (A + c T)(sin(n a + p) + r sin(2 n a + p_2))
    and cogging B sin(m a + q) on top.  Fading: the torque constant falls by f (1 - exp(-t/t_f)).  Iron that saturates:
    T becomes T/sqrt(1 + 2 s T^2), a share s T^2 less for a small one.
    """

    lag_frequency: float = 0.0  # rad/s, w_n; 0: no lag
    lag_damping: float = 1.0  # 1, z
    ripple: float = 0.0  # N m, A
    ripple_share: float = 0.0  # 1, c
    ripple_order: float = 0.0  # 1, n
    ripple_phase: float = 0.0
    second: float = 0.0  # 1, r
    second_phase: float = 0.0
    cogging: float = 0.0  # N m, B
    cogging_order: float = 0.0
    cogging_phase: float = 0.0
    fade: float = 0.0  # 1, f
    fade_time: float = 1.0  # s
    saturation: float = 0.0  # 1/(N m)^2, s


@compiled
def controller(error, integral, line):
    """(torque command, rate of the integral)"""
    wanted = line.proportional * error + line.integral * integral
    room = min(max((line.limit - abs(wanted)) / STOP, 0.0), 1.0)
    return min(max(wanted, -line.limit), line.limit), error * room


@compiled
def lag_rate(command, delivered, rate, m):
    """Second time derivative of the delivered torque."""
    return m.lag_frequency * (m.lag_frequency * (command - delivered) - 2.0 * m.lag_damping * rate)


@compiled
def shaft_side(time, torque, angle, m):
    """Torque on the rotor from the torque behind the lag."""
    if m.fade != 0.0:
        torque *= 1.0 - m.fade * (1.0 - math.exp(-time / m.fade_time))
    if m.saturation != 0.0:
        torque /= math.sqrt(1.0 + 2.0 * m.saturation * torque * torque)
    if m.ripple != 0.0 or m.ripple_share != 0.0:
        inside = m.ripple_order * angle
        wave = math.sin(inside + m.ripple_phase) + m.second * math.sin(2.0 * inside + m.second_phase)
        torque += (m.ripple + m.ripple_share * torque) * wave
    if m.cogging != 0.0:
        torque += m.cogging * math.sin(m.cogging_order * angle + m.cogging_phase)
    return torque
