"""Unbalanced disc on an isotropic spring, turned by a constant torque: captured at its critical speed, or not.

C is the centre of the disc, P = C + e (cos phi, sin phi) its mass centre.  With

    L = m/2 |P'|^2 + J_P/2 phi'^2 - k/2 |C|^2

Lagrange gives, J_C = J_P + m e^2,

    m x'' + c x' + k x = m e (phi'^2 cos phi + phi'' sin phi)
    m y'' + c y' + k y = m e (phi'^2 sin phi - phi'' cos phi)
    J_C phi'' = T + m e (x'' sin phi - y'' cos phi)                     about C

and, with x'' and y'' from the first two, the same about P:

    J_P phi'' = T + e ((k y + c y') cos phi - (k x + c x') sin phi)

The two agree; ``inertia`` is J_P unless said otherwise (J_C is 8e-6 of it larger in the example).
No gravity, no drag on the spin: what the torque does beyond the steady whirl goes into speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, kw_only=True)
class UnbalancedDisc:
    mass: float = 2.0
    inertia: float = 0.5625
    """About P (m r^2 / 2 of a homogeneous disc, r = 0.75 m); with ``about_centre`` about C."""
    stiffness: float = 1600.0
    damping: float = 0.452548
    eccentricity: float = 1.48e-3
    about_centre: bool = False

    @property
    def critical_speed(self) -> float:
        return math.sqrt(self.stiffness / self.mass)

    @property
    def inertia_about_mass_centre(self) -> float:
        return self.inertia - self.about_centre * self.mass * self.eccentricity**2

    def steady_torque(self, speed: float) -> float:
        """c W |C|^2 W of the steady whirl: the torque that a constant speed takes."""
        m, c, k = self.mass, self.damping, self.stiffness
        amplitude = m * self.eccentricity * speed**2 / math.hypot(k - m * speed**2, c * speed)
        return c * speed * amplitude**2

    def largest_steady_torque(self) -> tuple[float, float]:
        """Speed and torque of the top of the resonance: no torque above it can be held back."""
        speeds = np.linspace(0.9, 1.1, 200_001) * self.critical_speed
        torques = [self.steady_torque(w) for w in speeds]
        i = int(np.argmax(torques))
        return float(speeds[i]), float(torques[i])

    def slope(self, torque: float, u: Array) -> list[float]:
        """About P; u = x, y, phi, x', y', phi'."""
        x, y, phi, vx, vy, w = u.tolist()
        fx, fy = self.stiffness * x + self.damping * vx, self.stiffness * y + self.damping * vy
        c, s, e = math.cos(phi), math.sin(phi), self.eccentricity
        alpha = (torque + e * (fy * c - fx * s)) / self.inertia_about_mass_centre
        ax = -fx / self.mass + e * (w * w * c + alpha * s)
        ay = -fy / self.mass + e * (w * w * s - alpha * c)
        return [vx, vy, w, ax, ay, alpha]

    def slope_about_centre(self, torque: float, u: Array) -> list[float]:
        """The same about C: three equations solved together."""
        x, y, phi, vx, vy, w = u.tolist()
        m, me, c, s = self.mass, self.mass * self.eccentricity, math.cos(phi), math.sin(phi)
        J = self.inertia_about_mass_centre + me * self.eccentricity
        M = np.array([[m, 0.0, -me * s], [0.0, m, me * c], [-me * s, me * c, J]])
        f = np.array(
            [
                me * w * w * c - self.stiffness * x - self.damping * vx,
                me * w * w * s - self.stiffness * y - self.damping * vy,
                torque,
            ]
        )
        return [vx, vy, w, *np.linalg.solve(M, f).tolist()]

    def energy(self, u: Array) -> Array:
        """Kinetic and elastic; u with the states first."""
        x, y, phi, vx, vy, w = u
        px, py = vx - self.eccentricity * w * np.sin(phi), vy + self.eccentricity * w * np.cos(phi)
        kinetic = 0.5 * self.mass * (px**2 + py**2) + 0.5 * self.inertia_about_mass_centre * w**2
        return np.asarray(kinetic + 0.5 * self.stiffness * (x**2 + y**2))


@dataclass(frozen=True)
class SpinUp:
    times: Array
    states: Array
    """Columns x, y, phi, x', y', phi'."""
    passed: bool
    """The speed left the resonance for good: it reached ``beyond`` times the critical speed."""

    @property
    def speed(self) -> Array:
        return self.states[:, 5]

    @property
    def distance(self) -> Array:
        return np.hypot(self.states[:, 0], self.states[:, 1])


def spin_up(
    disc: UnbalancedDisc,
    torque: float,
    *,
    end: float,
    step: float = 0.05,
    tolerance: float = 1e-11,
    beyond: float = 1.5,
    about_centre: bool = False,
    stop: bool = True,
) -> SpinUp:
    """From rest; ends (unless ``stop`` is False) when the disc has passed its critical speed."""
    slope = disc.slope_about_centre if about_centre else disc.slope

    def escape(_: float, u: Array) -> float:
        return float(u[5] - beyond * disc.critical_speed)

    escape.terminal = stop  # type: ignore[attr-defined]
    small = tolerance * np.array([0.01, 0.01, 1.0, 0.3, 0.3, 1.0])
    run = solve_ivp(
        lambda _, u: slope(torque, u),
        (0.0, end),
        np.zeros(6),
        method="DOP853",
        rtol=tolerance,
        atol=small,
        t_eval=np.arange(0.0, end + 0.5 * step, step)[: int(end / step) + 1],
        events=escape,
    )
    if run.status < 0:
        raise RuntimeError(run.message)
    return SpinUp(run.t, run.y.T, len(run.t_events[0]) > 0)


def capture_threshold(
    disc: UnbalancedDisc, low: float, high: float, *, width: float = 1e-5, end: float = 1000.0, tolerance: float = 1e-9
) -> tuple[float, float]:
    """Bisection from rest: the torque that is still captured and the one that passes."""
    if spin_up(disc, low, end=end, tolerance=tolerance).passed or not spin_up(disc, high, end=end, tolerance=tolerance).passed:
        raise ValueError(f"the threshold is not between {low} and {high} N m")
    while high - low > width:
        torque = 0.5 * (low + high)
        if spin_up(disc, torque, end=end, tolerance=tolerance).passed:
            high = torque
        else:
            low = torque
    return low, high
