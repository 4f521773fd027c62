"""Whirl in step with the spin of unbalanced rotors, by the linearised line: critical speeds and the steady orbit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import LinAlgError, eig

from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import RotorPoint

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

EXCITED = 1e-6
"""Share of the most strongly excited mode, and of the work that the forces on it would do in phase, below which a mode
counts as not excited (backward whirl of a symmetric line)."""


@dataclass(frozen=True)
class CriticalSpeed:
    """Speed of the reference shaft at which unbalance meets a natural frequency.

    speed : of the reference shaft [rad/s];  frequency : of the whirl [rad/s];  damping_ratio : of the mode
    reach : amplitude 0-peak [m] at each place asked for, per unit of the amplification of a resonance
    """

    speed: float
    frequency: float
    damping_ratio: float
    reach: tuple[float, ...]


class Unbalance(NamedTuple):
    """Spin [rad/s] and angle [rad] of a rotor in the true sense, and F in its force Re[F exp(i phi)], shape (n,)."""

    spin: float
    angle: float
    force: ComplexArray


def unbalances(lines: LineMatrices, point: RotorPoint) -> Iterator[Unbalance]:
    """The rotors that turn and are not balanced.

    With the static unbalance s = m e and the product of inertia J (x part + i y part, both in the turning frame)

        F_x = w^2 s,  F_y = -i w^2 s,  M_psi = -i w^2 J,  M_theta = -w^2 J
    """
    index = {name: k for k, name in enumerate(lines.names)}
    for rotor in lines.network.rotors:
        s, product = rotor.body.static_unbalance, rotor.body.product_unbalance
        spin, angle = (rotor.sense * values[rotor.coordinates[5]] for values in (point.speeds, point.angles))
        if (s == 0.0 and product == 0.0) or spin == 0.0:
            continue
        force = np.zeros(len(lines.names), complex)
        x, y, _, psi, theta, _ = (index[name] for name in rotor.coordinates)
        force[[x, y, psi, theta]] = spin**2 * np.array([s, -1j * s, -1j * product, -product])
        yield Unbalance(spin, angle, force)


def critical_speeds(lines: LineMatrices, slower: RotorPoint, faster: RotorPoint, places: Sequence[str] = ()) -> tuple[CriticalSpeed, ...]:
    """Undamped critical speeds that the unbalance of the scene excites, ascending.

    slower, faster : steady rotation at two speeds of the reference shaft; what differs in damping is gyroscopic
    places : whose ``reach`` is wanted

    With the gyroscopic matrix G per unit speed of the reference shaft and a rotor that turns r times as fast,
    K q = W^2 (r^2 M - i r G) q: all critical speeds from one problem.  A mode that the unbalance does no work on
    is left out.  The reach of a shape v under the unbalance F is |v| |v.F| / (v.K v) at a place, its damping ratio
    W v.D v / (2 v.K v).  Leaves out what damping does to shapes and speeds, and takes the stiffness of bearings at
    ``faster`` for all speeds.
    """
    before, system = (lines.at(point.angles, point.speeds, point.states) for point in (slower, faster))
    lateral = [k for k, body in enumerate(lines.network.bodies) if body.lateral]
    at = np.ix_(lateral, lateral)
    difference = (system.damping - before.damping)[at] / (faster.speed - slower.speed)
    gyroscopic = 0.5 * (difference - difference.T)
    stiffness = 0.5 * (system.stiffness + system.stiffness.T)[at]
    order = {lines.names[k]: place for place, k in enumerate(lateral)}
    rows = [[order[f"{lines.network.places[place]}.{key}"] for key in "xy"] for place in places]
    forces: dict[float, list[ComplexArray]] = {}
    for item in unbalances(lines, faster):
        forces.setdefault(round(item.spin / faster.speed, 12), []).append(item.force[lateral])
    found: list[CriticalSpeed] = []
    for ratio, group in forces.items():
        try:
            squares, shapes = eig(stiffness, ratio**2 * system.mass[at] - 1j * ratio * gyroscopic)
        except LinAlgError:
            continue
        real = np.isfinite(squares) & (squares.real > 0.0) & (np.abs(squares.imag) <= 1e-6 * np.abs(squares.real))
        speeds, shapes = np.sqrt(squares[real].real), shapes[:, real]
        elastic = np.abs(np.einsum("ik,ij,jk->k", shapes.conj(), stiffness, shapes))
        lost = np.einsum("ik,ij,jk->k", shapes.conj(), system.damping[at], shapes).real
        total = sum(group, np.zeros(len(lateral), complex))
        work, most = np.abs(shapes.conj().T @ total), np.abs(shapes).T @ np.abs(total)
        work = np.where(work > EXCITED * most, work, 0.0) * (speeds / faster.speed) ** 2
        size = np.where(elastic > 0.0, work / np.where(elastic > 0.0, elastic, 1.0), 0.0)
        largest = size * np.max(np.abs(shapes), axis=0, initial=0.0)
        for k in np.nonzero(largest > EXCITED * float(np.max(largest, initial=0.0)))[0]:
            frequency = abs(ratio) * float(speeds[k])
            reach = tuple(float(size[k]) * float(np.max(np.abs(shapes[row, k]))) for row in rows)
            found.append(CriticalSpeed(float(speeds[k]), frequency, 0.5 * frequency * float(lost[k] / elastic[k]), reach))
    found.sort(key=lambda item: item.speed)
    return tuple(item for k, item in enumerate(found) if k == 0 or item.speed > found[k - 1].speed * (1.0 + 1e-9))


def steady_whirl(lines: LineMatrices, point: RotorPoint) -> tuple[Mapping[str, float], Mapping[str, float]]:
    """Displacements and rates of the lateral coordinates on their steady orbits at the moment of the point.

    (K - w^2 M + i w D) Q = F  for each rotor with its spin w;  what is returned comes on top of the static deflection.
    """
    system = lines.at(point.angles, point.speeds, point.states)
    lateral = [k for k, body in enumerate(lines.network.bodies) if body.lateral]
    at = np.ix_(lateral, lateral)
    places, rates = np.zeros(len(lateral)), np.zeros(len(lateral))
    for spin, angle, force in unbalances(lines, point):
        dynamic = system.stiffness[at] - spin**2 * system.mass[at] + 1j * spin * system.damping[at]
        amplitude = np.linalg.lstsq(dynamic, force[lateral] * np.exp(1j * angle), rcond=None)[0]
        places += amplitude.real
        rates += (1j * spin * amplitude).real
    names = [lines.names[k] for k in lateral]
    return dict(zip(names, places.tolist(), strict=True)), dict(zip(names, rates.tolist(), strict=True))
