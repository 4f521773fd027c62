"""The longest step of the classical Runge-Kutta method at which a network's vibrations do not grow of themselves."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.equations import accelerations
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]

CHANGE = {"angle": 1e-7, "speed": 1e-5, "state": 1e-6}
"""Half the distance of the points of the differences: rad, rad/s, and of states relative to 1 or their value."""
LATERAL_CHANGE = {"angle": 1e-9, "speed": 1e-6}
"""The same for lateral coordinates, m and m/s."""


def longest_step(
    network: Network,
    *,
    time: float = 0.0,
    angles: Mapping[str, float] | None = None,
    speeds: Mapping[str, float] | None = None,
    states: Mapping[str, float] | None = None,
    margin: float = 0.9,
) -> float:
    """Longest step h [s] with |1 + z + z^2/2 + z^3/6 + z^4/24| <= 1, z = h lambda, for every eigenvalue of the rates, times margin.

    The rates of angles, speeds and states are differentiated by differences at the given point (forward; 0, or the initial
    value of a state, if not given).  A growing vibration counts as an undamped one.  Infinite where nothing vibrates or
    decays.  It knows that point alone: gyroscopes at speed, a stiff stop or a friction at rest need a point there, and
    it says nothing about accuracy.

    Source: Hairer, Wanner, Solving Ordinary Differential Equations II, IV.2.
    """
    if not 0.0 < margin <= 1.0:
        raise ParameterError(f"margin = {margin:g}: must be greater than 0 and at most 1.")
    values = np.asarray(np.linalg.eigvals(jacobian(network, time, angles, speeds, states)), complex)
    if not np.isfinite(values).all():
        raise ParameterError("The rates of this network are not finite at the given point; give another one.")
    return margin * stable_step(values)


def stable_step(values: npt.NDArray[np.complex128]) -> float:
    """Longest stable step [s] for these eigenvalues of the rates [1/s]; infinite where nothing vibrates or decays."""
    steps = [reach(math.atan2(abs(value.imag), min(value.real, 0.0))) / abs(value) for value in _moving(values)]
    return min(steps, default=math.inf)


def _moving(values: npt.NDArray[np.complex128]) -> list[complex]:
    """Eigenvalues that limit a step: without growth, and without those that are zero but for rounding."""
    size = max(abs(values), default=0.0)
    bounded = [complex(min(value.real, 0.0), value.imag) for value in values.tolist()]
    return [value for value in bounded if abs(value) > 1e-9 * size]


def reach(direction: float) -> float:
    """Distance from 0 to the edge of the stability region along exp(i direction), pi/2 to pi (2.83 and 2.79)."""
    low, high = 1.0, 4.0
    for _ in range(50):
        middle = 0.5 * (low + high)
        z = middle * complex(math.cos(direction), math.sin(direction))
        stable = abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))) <= 1.0
        low, high = (middle, high) if stable else (low, middle)
    return low


def jacobian(
    network: Network,
    time: float = 0.0,
    angles: Mapping[str, float] | None = None,
    speeds: Mapping[str, float] | None = None,
    states: Mapping[str, float] | None = None,
) -> FloatArray:
    """d(rates)/d(angles, speeds, states) by central differences, all at once; rates in the order of the angles, speeds and states."""
    angles, speeds, states = angles or {}, speeds or {}, states or {}
    names = [body.name for body in network.bodies]
    n = len(names)
    point = [angles.get(name, 0.0) for name in names] + [speeds.get(name, 0.0) for name in names]
    point += [states.get(state.name, state.initial) for state in network.states]
    change = [(LATERAL_CHANGE if body.unit == "m" else CHANGE)[kind] for kind in ("angle", "speed") for body in network.bodies]
    change += [CHANGE["state"] * max(1.0, abs(value)) for value in point[2 * n :]]
    size, h = len(point), np.array(change)
    moved = np.array(point)[:, None] + np.concatenate([np.diag(h), -np.diag(h)], axis=1)
    moment = network.moment(
        np.full(2 * size, time),
        dict(zip(names, moved[:n], strict=True)),
        dict(zip(names, moved[n : 2 * n], strict=True)),
        {state.name: moved[2 * n + k] for k, state in enumerate(network.states)},
    )
    found = accelerations(network, moment)
    order = [*names, *(state.name for state in network.states)]
    rates = np.array([np.broadcast_to(moment.speed(name), 2 * size) for name in names])
    rates = np.concatenate([rates, [np.broadcast_to(np.asarray(found[name], float), 2 * size) for name in order]])
    return np.asarray((rates[:, :size] - rates[:, size:]) / (2.0 * h))
