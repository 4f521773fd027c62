"""Whirl frequencies, critical speeds and steady unbalance response of the reference rotor line.

With everything turning at one speed W and small motion (W G from the gyroscopic moments)

    M q'' + (C + W G) q' + K q = 0,             q = Q exp(lambda t)

Synchronous whirl without damping, lambda = i W:  K Q = W^2 (M - i G) Q, a generalised Hermitian
problem whose positive eigenvalues W^2 are all critical speeds, forward and backward, at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig
from scipy.optimize import brentq

from tests.verification.reference_rotors import Array, System


@dataclass(frozen=True)
class Mode:
    frequency: float
    """Damped, Im lambda [rad/s]."""
    damping_ratio: float
    whirl: str


def whirl(system: System, shape: Array) -> str:
    """Kind of a shape with positive frequency; forward: y and -psi a quarter turn behind x and theta."""
    M = np.diag(system.nominal)
    weight = {"lateral": 0.0, "axial": 0.0, "torsional": 0.0}
    turn = 0.0
    for i, label in enumerate(system.labels):
        coordinate = label.rsplit(".", 1)[1]
        kind = {"z": "axial", "phi": "torsional"}.get(coordinate, "lateral")
        weight[kind] += float(M[i] * abs(shape[i]) ** 2)
        if coordinate == "x":
            turn -= float(M[i] * np.imag(np.conj(shape[i]) * shape[i + 1]))
        if coordinate == "psi":
            turn -= float(M[i] * np.imag(np.conj(shape[i + 1]) * -shape[i]))
    kind = max(weight, key=weight.__getitem__)
    if kind != "lateral":
        return kind
    if abs(turn) < 1e-6 * weight["lateral"]:
        return "straight"
    return "forward" if turn > 0 else "backward"


def modes(system: System, speed: float) -> list[Mode]:
    """Oscillating modes (damping ratio below 0.99), slowest first; at rest the whirl of a pair is arbitrary."""
    n = len(system.labels)
    lower = -np.linalg.solve(system.nominal, np.hstack([system.stiffness, system.damping + speed * system.gyroscopic]))
    values, shapes = np.linalg.eig(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower]))
    found = [
        Mode(value.imag, -value.real / abs(value), whirl(system, shape[:n]))
        for value, shape in zip(values, shapes.T)
        if value.imag > 0.14 * abs(value) and value.imag > 1e-3
    ]
    return sorted(found, key=lambda mode: mode.frequency)


def undamped_frequencies(system: System, speed: float) -> list[tuple[float, str]]:
    """Frequency and whirl without any damping."""
    n, M = len(system.labels), system.nominal
    lower = -np.linalg.solve(M, np.hstack([system.stiffness, speed * system.gyroscopic]))
    values, shapes = np.linalg.eig(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower]))
    found = [(float(value.imag), whirl(system, shape[:n])) for value, shape in zip(values, shapes.T) if value.imag > 1e-3]
    return sorted(found)


def lateral(system: System) -> list[int]:
    return [i for i, label in enumerate(system.labels) if label.rsplit(".", 1)[1] in ("x", "y", "psi", "theta")]


def critical_speeds(system: System, fastest: float) -> list[tuple[float, str]]:
    """Undamped synchronous critical speeds up to ``fastest`` [rad/s] and their whirl."""
    keep = lateral(system)
    some = np.ix_(keep, keep)
    values, vectors = eig(system.stiffness[some], (system.nominal - 1j * system.gyroscopic)[some])
    found = []
    for value, vector in zip(values, vectors.T):
        if value.real > 0 and np.sqrt(value.real) <= fastest:
            shape = np.zeros(len(system.labels), complex)
            shape[keep] = vector
            found.append((float(np.sqrt(value.real)), whirl(system, shape)))
    return sorted(found)


def damped_critical_speed(system: System, near: float, direction: str, reach: float = 0.02) -> float:
    """Where the damped frequency of the whirl nearest to ``near`` equals the speed."""

    def difference(speed: float) -> float:
        branch = [mode.frequency for mode in modes(system, speed) if mode.whirl == direction]
        return min(branch, key=lambda w: abs(w - near)) - speed

    return float(brentq(difference, near * (1 - reach), near * (1 + reach), xtol=1e-9))


def unbalance_response(system: System, speed: float) -> Array:
    """Complex Q of q = Re(Q exp(i W t)), spin angle W t.

    Force m e W^2 along the eccentricity; moment (Jt - Jp) d W^2 about the axis at 90 degrees to the direction of the tilt.
    """
    F = np.zeros(len(system.labels), complex)
    for i, body in system.bodies:
        force = body.mass * body.eccentricity * speed**2 * np.exp(1j * body.eccentricity_direction)
        moment = 1j * (body.transverse - body.polar) * np.sin(body.tilt) * np.cos(body.tilt) * speed**2 * np.exp(1j * body.tilt_direction)
        F[i : i + 2] += force * np.array([1.0, -1j])
        F[i + 3 : i + 5] += moment * np.array([1.0, -1j])
    keep = lateral(system)
    some = np.ix_(keep, keep)
    dynamic = system.stiffness - speed**2 * system.nominal + 1j * speed * (system.damping + speed * system.gyroscopic)
    Q = np.zeros(len(system.labels), complex)
    Q[keep] = np.linalg.solve(dynamic[some], F[keep])
    return Q


def unbalance_torque(system: System, speed: float) -> float:
    """Mean torque that holds the speed against the damping of the steady response: Q* C Q W^2 / 2 over W."""
    Q = unbalance_response(system, speed)
    return float(0.5 * speed * np.real(np.conj(Q) @ (system.damping @ Q)))
