"""The limit: integrators compiled by numba together with the right-hand side, with nothing around them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import hdrive_mbs as hm
from benchmarks.speed.right_sides import FloatArray, numba_or_none, scalar_right_side


def _slope(scene: hm.Scene) -> Any:
    numba = numba_or_none()
    right = numba.njit(scalar_right_side(scene))

    @numba.njit
    def slope(t: float, y: FloatArray, out: FloatArray) -> None:
        out[0], out[1], out[2], out[3], out[4], out[5], out[6], out[7] = right(t, y[0], y[1], y[2], y[3], y[4], y[5], y[6], y[7])

    return slope


def compiled_runge_kutta(scene: hm.Scene) -> Callable[[int, float], tuple[FloatArray, FloatArray]]:
    """loop(steps, duration) -> times, states: the classical Runge-Kutta method of order 4."""
    numba = numba_or_none()
    slope = _slope(scene)

    @numba.njit
    def loop(steps: int, duration: float) -> tuple[FloatArray, FloatArray]:
        h = duration / steps
        times, states = np.empty(steps + 1), np.zeros((steps + 1, 8))
        a, b, c, d, y, z = np.empty(8), np.empty(8), np.empty(8), np.empty(8), np.zeros(8), np.empty(8)
        times[0] = 0.0
        for k in range(steps):
            t = k * h
            slope(t, y, a)
            for i in range(8):
                z[i] = y[i] + 0.5 * h * a[i]
            slope(t + 0.5 * h, z, b)
            for i in range(8):
                z[i] = y[i] + 0.5 * h * b[i]
            slope(t + 0.5 * h, z, c)
            for i in range(8):
                z[i] = y[i] + h * c[i]
            slope(t + h, z, d)
            for i in range(8):
                y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i])
                states[k + 1, i] = y[i]
            times[k + 1] = t + h
        return times, states.T

    loop(2, 1e-5)
    return loop


# Dormand & Prince (1980), as in Hairer, Norsett, Wanner, Solving ODEs I, Table II.5.2
_NODES = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
_STAGES = np.array([
    [0, 0, 0, 0, 0, 0],
    [1 / 5, 0, 0, 0, 0, 0],
    [3 / 40, 9 / 40, 0, 0, 0, 0],
    [44 / 45, -56 / 15, 32 / 9, 0, 0, 0],
    [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0, 0],
    [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0],
    [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
])  # fmt: skip
_DIFFERENCE = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])


def compiled_dormand_prince(scene: hm.Scene) -> Callable[[float, float], tuple[FloatArray, FloatArray]]:
    """loop(tolerance, duration) -> times, states: the method that the engine uses, with the same tolerances."""
    numba = numba_or_none()
    slope = _slope(scene)
    nodes, stages, difference = _NODES, _STAGES, _DIFFERENCE

    @numba.njit
    def loop(tolerance: float, duration: float) -> tuple[FloatArray, FloatArray]:
        room = 1024
        times, states = np.zeros(room), np.zeros((room, 8))
        k, y, z = np.empty((7, 8)), np.zeros(8), np.empty(8)
        t, h, count = 0.0, 1e-7, 0
        slope(t, y, k[0])
        while t < duration:
            h = min(h, duration - t)
            for stage in range(1, 7):
                for i in range(8):
                    total = 0.0
                    for j in range(stage):
                        total += stages[stage, j] * k[j, i]
                    z[i] = y[i] + h * total
                slope(t + nodes[stage] * h, z, k[stage])
            error = 0.0
            for i in range(8):
                total = 0.0
                for j in range(7):
                    total += difference[j] * k[j, i]
                scale = 1e-2 * tolerance + tolerance * max(abs(y[i]), abs(z[i]))
                error += (h * total / scale) ** 2
            error = (error / 8.0) ** 0.5
            if error <= 1.0:
                t += h
                count += 1
                if count == room:
                    times, states = np.append(times, np.zeros(room)), np.concatenate((states, np.zeros((room, 8))))
                    room *= 2
                times[count] = t
                for i in range(8):
                    y[i] = z[i]
                    states[count, i] = z[i]
                    k[0, i] = k[6, i]
            h *= min(5.0, max(0.2, 0.9 * max(error, 1e-10) ** -0.2))
        return times[: count + 1], states[: count + 1].T

    loop(1e-4, 1e-5)
    return loop
