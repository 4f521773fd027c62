"""Mass, damping and stiffness of an assembly at a state, from Exudyn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import exudyn as exu
import numpy as np
import numpy.typing as npt

from hdrive_mbs.engine.assembly import Assembly

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class LinearSystem:
    """M q'' + D q' + K q = 0 for small motions of bodies, with first-order states z.

    Coordinates are forward.  With n bodies and m states the state vector is (q, q', z) and
    ``matrix`` its (2n + m) x (2n + m) system matrix.
    """

    bodies: tuple[str, ...]
    states: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    matrix: FloatArray


def linearise(assembly: Assembly, *, angles: Mapping[str, float], speeds: Mapping[str, float], states: Mapping[str, float]) -> LinearSystem:
    """Linearise at forward angles, speeds and states (time 0).

    Exudyn differentiates numerically; without ``forODE2`` it would drop the velocity dependence of
    connectors.  A state is the velocity of its coordinate, so its column of D is its stiffness-like
    part and its column of K is zero.
    """
    assembly.set_initial(angles, speeds, states)
    settings = exu.SimulationSettings()
    settings.timeIntegration.newton.numericalDifferentiation.forODE2 = True
    settings.staticSolver.newton.numericalDifferentiation.forODE2 = True
    mass, stiffness, damping = (np.asarray(item, float) for item in assembly.mbs.ComputeLinearizedSystem(settings)[:3])
    n, m = len(assembly.bodies), len(assembly.states)
    signs = np.array([assembly.signs[name] for name in assembly.bodies] + [1] * m, float)
    for k, copy in enumerate(assembly.copies, start=n + m):  # what depends or acts on a copy depends or acts on what it follows
        at, factors = [assembly.bodies.index(name) for name in copy], np.array(list(copy.values()))
        for matrix in (stiffness, damping) if copy else ():
            matrix[:, at] += np.outer(matrix[:, k], factors)
            matrix[at, :] += np.outer(factors, matrix[k, :])
    mass, stiffness, damping = (np.outer(signs, signs) * item[: n + m, : n + m] for item in (mass, stiffness, damping))
    body, state = slice(0, n), slice(n, n + m)
    inverse = np.linalg.inv(mass[body, body])
    matrix = np.zeros((2 * n + m, 2 * n + m))
    matrix[:n, n : 2 * n] = np.eye(n)
    matrix[n : 2 * n, :n] = -inverse @ stiffness[body, body]
    matrix[n : 2 * n, n : 2 * n] = -inverse @ damping[body, body]
    matrix[n : 2 * n, 2 * n :] = -inverse @ damping[body, state]
    matrix[2 * n :, :n] = -stiffness[state, body]
    matrix[2 * n :, n : 2 * n] = -damping[state, body]
    matrix[2 * n :, 2 * n :] = -damping[state, state]
    return LinearSystem(
        bodies=assembly.bodies,
        states=assembly.states,
        mass=mass[body, body],
        damping=damping[body, body],
        stiffness=stiffness[body, body],
        matrix=matrix,
    )
