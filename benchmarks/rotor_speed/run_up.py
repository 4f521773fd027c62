"""Reference motion of the prescribed run-up, integrated by another method than either tool's."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BPoly

from benchmarks.rotor_speed import rotor
from benchmarks.rotor_speed.beam import FloatArray, matrices

ACCELERATION = rotor.HIGHEST_SPEED / rotor.RAMP_DURATION
"""rad/s^2; the spin is half of it times t^2."""
STAGES = 4
STEPS = 2500


@dataclass(frozen=True)
class RunUp:
    """x and y of the stations that carry the discs [m] over the ramp.

    agreement : largest difference to a run with twice the step, over the largest displacement, at that run's steps
    """

    motion: BPoly
    largest: float
    agreement: float

    def displacements(self, times: FloatArray) -> FloatArray:
        """[[x, y] of each disc] as (discs, 2, times)."""
        return np.asarray(np.moveaxis(self.motion(times), 0, -1))

    def error(self, times: FloatArray, displacements: FloatArray) -> float:
        """Largest difference of (discs, 2, times) displacements, over the largest displacement of the reference."""
        if displacements.shape != (len(rotor.DISCS), 2, len(times)):
            raise ValueError(f"Displacements of shape {displacements.shape}: must be discs x (x, y) x times, {len(times)} times here.")
        return float(np.max(np.abs(displacements - self.displacements(times))) / self.largest)


def run_up(transient_term: float = 0.0) -> RunUp:
    """Integrate, in the planes u (x, theta) and v (y, -psi), with the speed W of the ramp and its acceleration W':

        M u'' + C u' + W P v' + c W' P v + K u = f_x,      M v'' + C v' - W P u' + K v = f_y
        f_x + i f_y = m e (W^2 - i W') exp(i angle)        on the first disc

    ``transient_term`` is c.  0: the torque that spins the rotor up acts along its tilted axis, as a shaft hands it on;
    1: it acts about the fixed z axis (rotation about y before x).  -1 is what ROSS has by default, in its matrix Ksdt:
    the sign that belongs to the axes of its source, beside gyroscopic terms in other axes.

    Gauss's collocation with 4 stages, order 8, joined by quintic Hermite pieces through displacement, velocity and
    acceleration; at the fastest forcing, 0.42 rad a step, these add (0.42)^6 / 46080 = 1e-7 of the motion between the steps.
    """
    fine, coarse = _integrate(transient_term, STEPS), _integrate(transient_term, STEPS // 2)
    times = np.linspace(0.0, rotor.RAMP_DURATION, STEPS // 2 + 1)
    largest = float(np.max(np.abs(fine(np.linspace(0.0, rotor.RAMP_DURATION, 10 * STEPS + 1)))))
    return RunUp(fine, largest, float(np.max(np.abs(coarse(times) - fine(times))) / largest))


def _integrate(transient_term: float, steps: int) -> BPoly:
    plane = matrices(rotor.RAMP_ELEMENTS, rotor.BEARING_DAMPING)
    size = len(plane.mass)
    discs = [2 * station for station in rotor.disc_stations(rotor.RAMP_ELEMENTS)]
    by_mass = np.linalg.inv(plane.mass)
    quarter_turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    damping = np.kron(np.eye(2), by_mass @ plane.damping)
    gyroscopic = np.kron(quarter_turn, by_mass @ plane.polar)
    only_first_plane = np.kron([[0.0, 1.0], [0.0, 0.0]], by_mass @ plane.polar)
    stiffness = np.kron(np.eye(2), by_mass @ plane.stiffness) + transient_term * ACCELERATION * only_first_plane
    push = by_mass[:, discs[0]]

    def driven(times: FloatArray) -> FloatArray:
        speed, angle = ACCELERATION * times, 0.5 * ACCELERATION * times**2
        force = rotor.UNBALANCE * (speed**2 - 1j * ACCELERATION) * np.exp(1j * angle)
        return np.concatenate([np.outer(force.real, push), np.outer(force.imag, push)], axis=1)

    nodes, inner, weights = _gauss()
    twice = inner @ inner
    step = rotor.RAMP_DURATION / steps
    place, rate = np.zeros(2 * size), np.zeros(2 * size)
    track = [(place, rate)]
    fixed = (
        np.eye(STAGES * 2 * size).reshape(STAGES, 2 * size, STAGES, 2 * size)
        + step * np.einsum("ij,ab->iajb", inner, damping)
        + step**2 * np.einsum("ij,ab->iajb", twice, stiffness)
    )
    turning = step * np.einsum("ij,ab->iajb", inner, gyroscopic)
    for number in range(steps):
        times = (number + nodes) * step
        speed = ACCELERATION * times
        system = fixed + speed[:, None, None, None] * turning
        right = driven(times) - damping @ rate - np.outer(speed, gyroscopic @ rate) - stiffness @ place
        right -= step * np.outer(nodes, stiffness @ rate)
        accelerations = np.linalg.solve(system.reshape(right.size, right.size), right.ravel()).reshape(right.shape)
        place = place + step * rate + step**2 * weights @ inner @ accelerations
        rate = rate + step * weights @ accelerations
        track.append((place, rate))

    times = np.linspace(0.0, rotor.RAMP_DURATION, steps + 1)
    places, rates = (np.array(values) for values in zip(*track, strict=True))
    accelerations = driven(times) - places @ stiffness.T - rates @ damping.T - (ACCELERATION * times)[:, None] * (rates @ gyroscopic.T)
    wanted = np.array([[disc, size + disc] for disc in discs])
    return BPoly.from_derivatives(times, np.stack([values[:, wanted] for values in (places, rates, accelerations)], axis=1))


def _gauss() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Nodes, coefficients and weights of the collocation at Gauss's points on [0, 1]."""
    points, weights = np.polynomial.legendre.leggauss(STAGES)
    nodes = 0.5 + 0.5 * points
    orders = np.arange(1, STAGES + 1)
    inner = (nodes[:, None] ** orders / orders) @ np.linalg.inv(np.vander(nodes, increasing=True))
    return nodes, inner, 0.5 * weights
