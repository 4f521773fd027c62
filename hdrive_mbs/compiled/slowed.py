"""Vibrations that are too fast for a step, slowed down while all others stay as they are.

The fastest vibrations of a rotor line, those of light rings between stiff sections, set the step of an explicit method and follow
whatever else moves with next to no delay.  With mass and stiffness at rest M, K and their vibrations K v = w^2 M v, v.M v = 1, the
mass matrix

    M' = M + sum over k of (w_k^2/w_0^2 - 1) M v_k (M v_k)^T

gives the vibrations k the angular frequency w_0 and leaves every other pair (w, v) of K and M as it is, since v.M v_k = 0.  By
M'^-1 = M^-1 - sum of b_k v_k v_k^T, b_k = 1 - w_0^2/w_k^2, it takes

    q''  ->  q'' - sum of b_k v_k (M v_k).q''

of the accelerations that the line has.  M' is positive: of M and K as they are, nothing grows by it.  Where a law or another parameter
changes K or M, what it adds to a slow vibration u is (w_k^2/w_0^2 - 1) ((M v_k).u)^2, of second order in the change; where it changes
both, the vibrations that are slowed may come to exchange energy, of which a step that is a good part of their period takes more.

In explicit codes for finite elements this is known as selective mass scaling (Olovsson, Simonsson, Unosson, Int. J. Numer. Meth. Engng 63,
2005, 1436), which there leaves translations of elements alone; here all vibrations below w_0 are.

Left out: parts of a vibration below SMALL of its largest one, in terms of energy; that a spinning line vibrates otherwise than one at rest,
and one that is bent otherwise than a straight one; forces of bearings that couple x to y and not y to x alike (their mean is taken); the
torque that unbalance takes from a spin by accelerations before they are changed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.groups import groups
from hdrive_mbs.compiled.rotor_equations import masses
from hdrive_mbs.compiled.step_limit import jacobian
from hdrive_mbs.expression import Value
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]

SMALL = 1e-3
"""What is left out of a vibration: the root of it times its mass against that of the largest part."""
APART = 1e-7
"""Entries of a matrix, its diagonal scaled to 1, that differences of rates leave of a zero: they join nothing."""


@dataclass(frozen=True)
class Slowed:
    """A vibration that is slowed.

    parts : (coordinate, factor of its acceleration in what is taken, what is taken from it per unit of that)
    """

    parts: tuple[tuple[str, float, float], ...]


def slowed_vibrations(network: Network, fastest: float) -> tuple[Slowed, ...]:
    """The lateral and tilting vibrations of a network at rest that are faster than this [rad/s], to be slowed to it; none of a network
    whose rates are not finite there."""
    names = [body.name for body in network.bodies]
    lateral = [k for k, body in enumerate(network.bodies) if body.lateral]
    if not lateral or not network.is_coupled:
        return ()
    n, (order, whole) = len(names), masses(network)
    places = [order.index(names[k]) for k in lateral]
    mass = np.asarray(whole, float)[np.ix_(places, places)]
    stiffness = -mass @ jacobian(network)[n : 2 * n, :n][np.ix_(lateral, lateral)]
    if not np.isfinite(stiffness).all():
        return ()
    found = []
    for at in groups(_joined(mass) | _joined(stiffness)):  # planes that are alike have equal vibrations, which would mix
        own = np.ix_(at, at)
        found += _faster([names[lateral[k]] for k in at], mass[own], 0.5 * (stiffness[own] + stiffness[own].T), fastest)
    return tuple(found)


def _joined(matrix: FloatArray) -> npt.NDArray[np.bool_]:
    size = np.sqrt(np.abs(np.diag(matrix)))
    return np.asarray(np.abs(matrix) + np.abs(matrix.T) > APART * np.outer(size, size)) | np.eye(len(matrix), dtype=bool)


def _faster(names: Sequence[str], mass: FloatArray, stiffness: FloatArray, fastest: float) -> list[Slowed]:
    root = np.linalg.cholesky(mass)
    scaled = np.linalg.solve(root, np.linalg.solve(root, stiffness).T)
    squares, shapes = np.linalg.eigh(0.5 * (scaled + scaled.T))
    found = []
    for square, shape in zip(squares.tolist(), np.linalg.solve(root.T, shapes).T, strict=True):
        if square > fastest**2:
            weights, share = mass @ shape, 1.0 - fastest**2 / square
            size = np.abs(shape) * np.sqrt(np.diag(mass))
            kept = np.flatnonzero(size > SMALL * size.max()).tolist()
            found.append(Slowed(tuple((names[k], float(weights[k]), float(share * shape[k])) for k in kept)))
    return found


def slowed_accelerations(found: Mapping[str, Value], slowed: Sequence[Slowed]) -> Mapping[str, Value]:
    """Accelerations with vibrations slowed; one of which a coordinate is missing, which nothing moves then, stays as it is."""
    taken: dict[str, Value] = {}
    for vibration in slowed:
        if all(name in found for name, _, _ in vibration.parts):
            size = sum(weight * found[name] for name, weight, _ in vibration.parts)
            for name, _, share in vibration.parts:
                taken[name] = taken.get(name, 0.0) + share * size
    return {name: value - taken[name] if name in taken else value for name, value in found.items()}
