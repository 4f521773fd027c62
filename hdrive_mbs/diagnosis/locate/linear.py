"""A network linearised along a motion: x' = A x + B f, y = C x + D f with unknown forces f and channels y."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.equations import accelerations
from hdrive_mbs.compiled.readings import readings
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

CHANGE = {"rad": 1e-6, "m": 1e-9, "state": 1e-4}
"""Half the distance of the points of the differences; that of a rate: a hundred times as much."""
CELLS = 16_000
"""Moments that are evaluated at a time."""
AGREES = 1e-5
"""Relative difference up to which a sum over modes stands for a solved system."""


@dataclass(frozen=True, eq=False)
class Linear:
    """A, B, C, D at n moments: shape (n, states, states), (n, states, forces), (n, channels, states), (n, channels, forces)."""

    a: FloatArray
    b: FloatArray
    c: FloatArray
    d: FloatArray

    def mean(self, spans: Sequence[npt.NDArray[np.int64]]) -> Linear:
        """Averages over moments."""
        return Linear(*(np.array([part[span].mean(axis=0) for span in spans]) for part in (self.a, self.b, self.c, self.d)))


def linearised(
    network: Network, channels: Sequence[str], forces: Sequence[str], times: FloatArray, motion: Mapping[str, FloatArray]
) -> Linear:
    """Central differences of rates and channels at each moment of a motion.

    forces : states that stand for unknown forces;  motion : ``angle:name``, ``speed:name``, ``state:name`` -> values, (n,)
    """
    names = [body.name for body in network.bodies]
    kept = [state.name for state in network.states if state.name not in forces]
    keys = [*(f"angle:{n}" for n in names), *(f"speed:{n}" for n in names), *(f"state:{n}" for n in (*kept, *forces))]
    change = [CHANGE[body.unit] for body in network.bodies]
    h = np.array([*change, *(100.0 * value for value in change), *[CHANGE["state"]] * (len(kept) + len(forces))])
    n, size, own = len(times), len(keys), 2 * len(names) + len(kept)
    point = np.array([motion.get(key, np.zeros(n)) for key in keys])
    shift = np.concatenate([np.diag(h), -np.diag(h)], axis=1)
    parts = []
    stride = max(1, CELLS // (2 * size))
    for first in range(0, n, stride):
        at = slice(first, first + stride)
        count = len(times[at])
        moved = (point[:, at, None] + shift[:, None, :]).reshape(size, -1)
        moment = _moment(network, np.repeat(times[at], 2 * size), dict(zip(keys, moved, strict=True)))
        found = accelerations(network, moment)
        read = readings(network, channels, moment, lambda found=found: found)  # type: ignore[misc]
        rows = [*(moment.speed(name) for name in names), *(found[name] for name in (*names, *kept)), *read]
        values = np.array([np.broadcast_to(np.asarray(row, float), count * 2 * size) for row in rows]).reshape(-1, count, 2 * size)
        parts.append((values[..., :size] - values[..., size:]) / (2.0 * h))
    slopes = np.concatenate(parts, axis=1).transpose(1, 0, 2)
    return Linear(slopes[:, :own, :own], slopes[:, :own, own:], slopes[:, own:, :own], slopes[:, own:, own:])


def _moment(network: Network, times: FloatArray, values: Mapping[str, FloatArray]) -> Moment:
    picked: dict[str, dict[str, FloatArray]] = {"angle": {}, "speed": {}, "state": {}}
    for key, item in values.items():
        kind, name = key.split(":", 1)
        picked[kind][name] = item
    return network.moment(times, picked["angle"], picked["speed"], picked["state"])


class Transfers:
    """C (s - A)^-1 B + D of a linearised network at each s, for the forces that are asked for.

    As a sum over eigenvectors, sum_m C v_m w_m B / (s - lambda_m); where these are nearly parallel, a system is solved for each s.
    """

    def __init__(self, linear: Linear, rates: ComplexArray) -> None:
        self._linear, self._rates = linear, rates
        self._modes = [_modes(*parts, rates) for parts in zip(linear.a, linear.b, linear.c, strict=True)]

    def of(self, forces: Sequence[int]) -> ComplexArray:
        """Shape (n, rates, channels, forces asked for)."""
        at, linear, rates = list(forces), self._linear, self._rates
        parts = [
            _solved(a, b[:, at], c, rates) if modes is None else modes.transfer(at)
            for modes, a, b, c in zip(self._modes, linear.a, linear.b, linear.c, strict=True)
        ]
        return np.asarray(np.array(parts) + linear.d[:, None][..., at])


@dataclass(frozen=True, eq=False)
class _Modes:
    """Modes at one moment.

    rates : s, (rates,);  values : lambda, (modes,);  read : C V, (channels, modes);  driven : V^-1 B, (modes, forces)
    """

    rates: ComplexArray
    values: ComplexArray
    read: ComplexArray
    driven: ComplexArray

    def transfer(self, forces: Sequence[int]) -> ComplexArray:
        """Shape (rates, channels, forces asked for)."""
        driven = self.driven[:, list(forces)]
        residues = self.read.T[:, :, None] * driven[:, None, :]
        poles = 1.0 / (self.rates[:, None] - self.values)  # not kept: those of all moments of a rotor line are 20 MB
        return np.asarray((poles @ residues.reshape(len(driven), -1)).reshape(len(poles), len(self.read), -1))


def _modes(a: FloatArray, b: FloatArray, c: FloatArray, rates: ComplexArray) -> _Modes | None:
    """None where a sum over eigenvectors is not what a solved system gives, or there is no force."""
    if not b.shape[1]:
        return None
    values, vectors = np.linalg.eig(a)
    check = [0, len(rates) // 2]
    right = _solved(a, b, c, rates[check])
    try:
        left = np.linalg.solve(vectors, b.astype(complex))
    except np.linalg.LinAlgError:
        return None
    made = _Modes(rates, values, c @ vectors, left)
    found = replace(made, rates=rates[check]).transfer(range(b.shape[1]))
    return None if np.max(np.abs(found - right)) > AGREES * np.max(np.abs(right)) else made


def _solved(a: FloatArray, b: FloatArray, c: FloatArray, rates: ComplexArray) -> ComplexArray:
    if not b.shape[1]:
        return np.zeros((len(rates), len(c), 0), complex)
    system = rates[:, None, None] * np.eye(len(a)) - a
    return np.asarray(c @ np.linalg.solve(system, np.broadcast_to(b, (len(rates), *b.shape)).astype(complex)))
