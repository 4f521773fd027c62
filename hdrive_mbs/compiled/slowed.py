"""Vibrations that are too fast for a step, slowed down while all others stay as they are.

The fastest vibrations of a rotor line, those of light rings between stiff sections, set the step of an explicit method and follow
whatever else moves without a delay that shows.  With mass and stiffness at rest M, K and their vibrations K v = w^2 M v, v.M v = 1, the
mass matrix

    M' = M + sum over k of (w_k^2/w_0^2 - 1) M v_k (M v_k)^T

gives the vibrations k the angular frequency w_0 and leaves every other pair (w, v) of K and M as it is, since v.M v_k = 0.  By
M'^-1 = M^-1 - sum of b_k v_k v_k^T, b_k = 1 - w_0^2/w_k^2, it takes

    q''  ->  q'' - sum of b_k v_k (M v_k).q''

of the accelerations that the line has.  M' is positive, so nothing grows by it.  Where a law or another parameter changes K or M, what it
adds to a slow vibration u is (w_k^2/w_0^2 - 1) ((M v_k).u)^2, of second order in the change.  In explicit codes for finite elements this is
known as selective mass scaling (Olovsson, Simonsson, Unosson, Int. J. Numer. Meth. Engng 63, 2005, 1436), which leaves rigid motions
alone; here all vibrations below w_0 are.

Left out: parts of a vibration below SMALL of its largest one, in terms of energy; that a spinning line vibrates otherwise than one at rest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.compiled.rotor_equations import masses
from hdrive_mbs.compiled.step_limit import jacobian
from hdrive_mbs.expression import Value
from hdrive_mbs.network.network import Network

SMALL = 1e-3
"""What is left out of a vibration: the root of it times its mass against that of the largest part."""


@dataclass(frozen=True)
class Slowed:
    """A vibration that is slowed.

    parts : (coordinate, factor of its acceleration in what is taken, what is taken from it per unit of that), equal for equal networks
    """

    parts: tuple[tuple[str, float, float], ...]


def slowed_vibrations(network: Network, fastest: float) -> tuple[Slowed, ...]:
    """The lateral and tilting vibrations of a network at rest that are faster than this [rad/s], to be slowed to it."""
    names = [body.name for body in network.bodies]
    lateral = [k for k, body in enumerate(network.bodies) if body.lateral]
    if not lateral or not network.is_coupled:
        return ()
    n, at = len(names), np.ix_(lateral, lateral)
    order, every = masses(network)
    mass = np.asarray(every, float)[np.ix_([order.index(names[k]) for k in lateral], [order.index(names[k]) for k in lateral])]
    stiffness = -mass @ jacobian(network)[n : 2 * n, :n][at]
    root = np.linalg.cholesky(mass)
    scaled = np.linalg.solve(root, np.linalg.solve(root, 0.5 * (stiffness + stiffness.T)).T)
    squares, shapes = np.linalg.eigh(0.5 * (scaled + scaled.T))
    shapes = np.linalg.solve(root.T, shapes)
    found = []
    for square, shape in zip(squares.tolist(), shapes.T, strict=True):
        if square > fastest**2:
            weights, share = mass @ shape, 1.0 - fastest**2 / square
            size = np.abs(shape) * np.sqrt(np.diag(mass))
            kept = np.flatnonzero(size > SMALL * size.max()).tolist()
            found.append(Slowed(tuple((names[lateral[k]], float(weights[k]), float(share * shape[k])) for k in kept)))
    return tuple(found)


def slowed_accelerations(found: Mapping[str, Value], slowed: Sequence[Slowed]) -> Mapping[str, Value]:
    """Accelerations with vibrations slowed; one of which a coordinate is missing, which nothing moves then, stays as it is."""
    taken: dict[str, Value] = {}
    for vibration in slowed:
        if all(name in found for name, _, _ in vibration.parts):
            size = sum(weight * found[name] for name, weight, _ in vibration.parts)
            for name, _, share in vibration.parts:
                taken[name] = taken.get(name, 0.0) + share * size
    return {name: value - taken[name] if name in taken else value for name, value in found.items()}
