"""Run-up of the reference rotor line by two integrators that share nothing but the equations.

``exponential``: constant steps, u' = L u + N(u) with L the undeflected line (stiffness and damping exact
through matrix exponentials) and N the rest (gyroscopic moments, unbalance, drive, cubic terms), by the
fourth-order scheme of S. Krogstad (2005), J. Comput. Phys. 203, 72-88.
``radau``: scipy's Radau IIA of order 5 with error control.  Slower; there to check the first.

Distances are of the geometric centre from the axis at rest, 0-peak.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import fsolve

from tests.verification.reference_rotors import Array, System


@dataclass(frozen=True)
class Peak:
    amplitude: float
    """Distance from the axis [m], 0-peak."""
    speed: float
    """Of the rotor itself, phi' [rad/s]."""
    time: float


@dataclass(frozen=True)
class RunUp:
    system: System
    times: Array
    states: Array
    """Rows [q, q']."""
    work: Array
    """Of the drive [J]."""
    dissipated: Array
    """[J]."""

    def history(self, label: str) -> Array:
        return self.states[:, self.system.index(label)]

    def rate(self, label: str) -> Array:
        return self.states[:, self.states.shape[1] // 2 + self.system.index(label)]

    def distance(self, station: str) -> Array:
        return np.hypot(self.history(f"{station}.x"), self.history(f"{station}.y"))

    def mass_centre_distance(self, station: str) -> Array:
        """Of P from the axis."""
        first = self.system.index(f"{station}.x")
        body = dict(self.system.bodies)[first]
        places = np.array([body.mass_centre(u[first : first + 6]) for u in self.states])
        return np.hypot(places[:, 0], places[:, 1])

    def peak(self, station: str, slowest: float = 0.0, fastest: float = np.inf) -> Peak:
        """Largest distance at speeds between the limits; parabola through three samples."""
        distance, speed = self.distance(station), self.rate(f"{station}.phi")
        i = int(np.argmax(np.where((speed >= slowest) & (speed <= fastest), distance, -1.0)))
        if not 0 < i < len(distance) - 1:
            raise ValueError(f"the largest distance of {station} is at the end of the run")
        (a, b, c), step = distance[i - 1 : i + 2], self.times[i + 1] - self.times[i]
        shift = 0.5 * (a - c) / (a - 2 * b + c)
        p, q, r = speed[i - 1 : i + 2]
        return Peak(
            amplitude=float(b - 0.25 * (a - c) * shift),
            speed=float(q + 0.5 * (r - p) * shift + 0.5 * (p - 2 * q + r) * shift**2),
            time=float(self.times[i] + shift * step),
        )

    def energy(self, sample: int = -1) -> float:
        q, v = np.split(self.states[sample], 2)
        return self.system.kinetic_energy(q, v) + self.system.potential_energy(q)

    @property
    def energy_error(self) -> float:
        """Work - dissipated - gained, over the work."""
        gained = self.energy(-1) - self.energy(0)
        return float((self.work[-1] - self.work[0] - self.dissipated[-1] + self.dissipated[0] - gained) / (self.work[-1] - self.work[0]))


def start(system: System, speed: float = 0.0, sagged: bool = True) -> Array:
    """State at a speed of all stations, spin angles zero; ``sagged``: in the static position under gravity."""
    n = len(system.labels)
    spins = [first + 5 for first, _ in system.bodies]
    free = [i for i in range(n) if i not in spins]
    state = np.zeros(2 * n)
    state[[n + i for i in spins]] = speed
    if sagged and system.line.gravity:

        def unbalanced(free_positions: Array) -> Array:
            q = np.zeros(n)
            q[free] = free_positions
            return np.asarray((system.nominal @ system.acceleration(q, np.zeros(n)))[free])

        state[free] = fsolve(unbalanced, np.zeros(len(free)), xtol=1e-13)
    return state


def phi_functions(matrix: Array) -> tuple[Array, ...]:
    """exp(A), phi_1(A), phi_2(A), phi_3(A): phi_k(A) = A phi_(k+1)(A) + 1/k!, from one exponential."""
    n = len(matrix)
    large = np.zeros((4 * n, 4 * n))
    large[:n, :n] = matrix
    for k in range(3):
        large[k * n : (k + 1) * n, (k + 1) * n : (k + 2) * n] += np.eye(n)
    top = expm(large)[:n]
    return tuple(top[:, k * n : (k + 1) * n] for k in range(4))


def exponential(system: System, *, end: float, step: float, state: Array | None = None, keep: int = 1) -> RunUp:
    """Constant steps; every ``keep``-th state is kept."""
    n = len(system.labels)
    lower = -np.linalg.solve(system.nominal, np.hstack([system.stiffness, system.damping]))
    L = np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower])
    e_half, p1_half, p2_half, _ = phi_functions(0.5 * step * L)
    e, p1, p2, p3 = phi_functions(step * L)
    half_1, half_2 = 0.5 * step * p1_half[:, n:], step * p2_half[:, n:]
    full_1, full_2 = step * p1[:, n:], 2 * step * p2[:, n:]
    first, middle, last = (step * x[:, n:] for x in (p1 - 3 * p2 + 4 * p3, 2 * p2 - 4 * p3, 4 * p3 - p2))
    drive, C = system.line.drive, system.damping

    def evaluate(u: Array) -> tuple[Array, float, float]:
        q, v = u[:n], u[n:]
        return system.acceleration(q, v) - lower @ u, drive(v[5]) * v[5], v @ (C @ v)

    count = round(end / step)
    u = start(system) if state is None else state.copy()
    states = np.empty((count // keep + 1, 2 * n))
    sums = np.zeros((count // keep + 1, 2))
    states[0] = u
    work = lost = 0.0
    for i in range(1, count + 1):
        eu = e_half @ u
        N1, P1, D1 = evaluate(u)
        near = eu + half_1 @ N1
        N2, P2, D2 = evaluate(near)
        N3, P3, D3 = evaluate(near + half_2 @ (N2 - N1))
        eu = e @ u
        N4, P4, D4 = evaluate(eu + full_1 @ N1 + full_2 @ (N3 - N1))
        u = eu + first @ N1 + middle @ (N2 + N3) + last @ N4
        work += step / 6 * (P1 + 2 * P2 + 2 * P3 + P4)
        lost += step / 6 * (D1 + 2 * D2 + 2 * D3 + D4)
        if i % keep == 0:
            states[i // keep], sums[i // keep] = u, (work, lost)
    if not np.isfinite(states).all():
        raise FloatingPointError(f"the run-up blew up: the step of {step} s is too long for the nonlinear terms")
    return RunUp(system, step * keep * np.arange(len(states)), states, sums[:, 0], sums[:, 1])


def radau(system: System, *, end: float, step: float, state: Array | None = None, tolerance: float = 1e-9) -> RunUp:
    """Error control; states at multiples of ``step``."""
    n = len(system.labels)

    def slope(_: float, u: Array) -> Array:
        q, v = u[:n], u[n : 2 * n]
        power = system.line.drive(v[5]) * v[5]
        return np.concatenate([v, system.acceleration(q, v), [power, v @ (system.damping @ v)]])

    def jacobian(_: float, u: Array) -> Array:
        J = np.zeros((2 * n + 2, 2 * n + 2))
        J[: 2 * n, : 2 * n] = system.jacobian(u[:n], u[n : 2 * n])
        return J

    begin = np.concatenate([start(system) if state is None else state, [0.0, 0.0]])
    small = np.concatenate([np.full(n, 1e-4), np.full(n, 1e-1), [1.0, 1.0]])
    times = step * np.arange(round(end / step) + 1)
    run = solve_ivp(slope, (0.0, times[-1]), begin, method="Radau", jac=jacobian, rtol=tolerance, atol=tolerance * small, t_eval=times)
    if not run.success:
        raise RuntimeError(run.message)
    return RunUp(system, times, run.y[: 2 * n].T, run.y[-2], run.y[-1])
