"""Small pieces of rotor lines, and what the linearised line says about them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices, LineSystem

FloatArray = npt.NDArray[np.float64]
E, G, STEEL = 2.1e11, 8.1e10, 7800.0
EARTH = 9.80665
ROUNDING = 1e-10
"""Of quantities that come out of eigenvalues or solved equations with condition numbers up to 1e5."""


def section(length: float, **fields: Any) -> hm.ShaftSection:
    return hm.ShaftSection(**({"length": length, "diameter": 0.03, "youngs_modulus": E, "shear_modulus": G} | fields))


def bearing(radial: float, *, mass: float = 0.0, damping: float = 0.0, **fields: float) -> hm.Bearing:
    ring = {"mass": mass, "polar_inertia": 1e-3 * mass, "transverse_inertia": 1e-3 * mass}
    return hm.Bearing(law=hm.LinearBearing.isotropic(radial=radial, damping=damping, **fields), **ring)


DISC = hm.Rotor(mass=8.0, polar_inertia=0.04, transverse_inertia=0.0206)


def line(name: str, parts: Mapping[str, hm.Component], *chains: Sequence[str]) -> hm.Scene:
    return hm.Scene(name=name, parts=parts, connections=chains)


def steady(scene: hm.Scene, speed: float = 0.0) -> LineSystem:
    """Linearised about straight, steady rotation."""
    network = scene.network()
    speeds = {body.name: body.sense * body.ratio * speed for body in network.bodies}
    return LineMatrices(network).at(dict.fromkeys(speeds, 0.0), speeds)


def system_matrix(system: LineSystem, names: Sequence[str]) -> FloatArray:
    """A of d/dt (q, q') = A (q, q'), restricted to coordinates that do not couple with others."""
    at = np.ix_(*[[system.names.index(name) for name in names]] * 2)
    M, D, K = system.mass[at], system.damping[at], system.stiffness[at]
    n = len(M)
    return np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])


def eigenvalues(system: LineSystem, names: Sequence[str] | None = None) -> npt.NDArray[np.complex128]:
    """Of M q'' + D q' + K q = 0."""
    return np.linalg.eigvals(system_matrix(system, names or system.names))


def frequencies(system: LineSystem, names: Sequence[str]) -> FloatArray:
    """Undamped natural frequencies [rad/s], ascending."""
    at = np.ix_(*[[system.names.index(name) for name in names]] * 2)
    squares = np.linalg.eigvals(np.linalg.solve(system.mass[at], system.stiffness[at])).real
    return np.sqrt(np.sort(np.maximum(squares, 0.0)))
