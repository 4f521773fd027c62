"""How far the lateral modes of two models of one line part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

LOWEST = 4
"""Modes compared where no speed is given: two in each of two planes."""

CREEPS = 0.9
"""Damping ratio above which a motion counts as creeping, not as a mode."""

ROUNDING = 1e-6
"""Share of the largest root below which a root is a zero (of a line that nothing holds) and rounding."""


@dataclass(frozen=True)
class LateralModes:
    """Lateral modes in the order of their frequencies [rad/s], with damping ratios."""

    frequency: FloatArray
    damping_ratio: FloatArray


@dataclass(frozen=True)
class ModeShifts:
    """Modes of the full line at a spin speed [rad/s], and what became of each in a model (nan: nothing)."""

    speed: float
    full: LateralModes
    model: LateralModes

    @property
    def frequency(self) -> FloatArray:
        """Relative change of each frequency; infinite for a mode that is missing."""
        return _change(self.full.frequency, self.model.frequency)

    @property
    def damping(self) -> FloatArray:
        """Relative change of each damping ratio, where the full line has damping."""
        return np.where(self.full.damping_ratio > 1e-6, _change(self.full.damping_ratio, self.model.damping_ratio), 0.0)


def _change(full: FloatArray, model: FloatArray) -> FloatArray:
    found = np.where(np.isnan(model), np.inf, model)
    return np.asarray(np.divide(found, full, out=np.ones_like(full), where=full != 0.0) - 1.0)


def mode_shifts(full: Scene, model: Scene, highest_speed: float | None = None, *, deflected: bool = True) -> tuple[ModeShifts, ...]:
    """Lateral modes up to a frequency [rad/s], at rest and at that speed of the reference shaft; without it the lowest at rest.

    deflected : about the static deflection at the speed, and a speed where there is none (a journal bearing at rest) is
        left out; False: about zero, which is faster and does where both have the same nonlinear laws
    """
    made = []
    for speed in (0.0,) if highest_speed is None else (0.0, highest_speed):
        try:
            whole, part = (lateral_roots(scene, speed, deflected=deflected) for scene in (full, model))
        except AnalysisError:
            continue
        count = LOWEST if highest_speed is None else int(np.sum(np.abs(whole) <= highest_speed))
        whole = whole[:count]
        made.append(ModeShifts(speed, _modes(whole), _modes(_partners(whole, part))))
    return tuple(made)


def lateral_roots(scene: Scene, speed: float, *, deflected: bool = True) -> ComplexArray:
    """Roots s of bending at a spin speed [rad/s] of the reference shaft, by frequency; axial and torsional motion held."""
    network = scene.network()
    lines = LineMatrices(network)
    lines.check_memory()
    if deflected:
        point = rotor_point(scene, speed, lines=lines)
        system = lines.at(point.angles, point.speeds, point.states)
    else:
        speeds = {body.name: 0.0 if body.lateral else body.sense * body.ratio * speed for body in network.bodies}
        system = lines.at(dict.fromkeys(lines.names, 0.0), speeds, {state.name: state.initial for state in network.states})
    kept = [k for k, body in enumerate(network.bodies) if body.lateral and not body.name.endswith(".z")]
    at = np.ix_(kept, kept)
    n = len(kept)
    first_order = np.zeros((2 * n, 2 * n))
    first_order[:n, n:] = np.eye(n)
    first_order[n:, :n] = -np.linalg.solve(system.mass[at], system.stiffness[at])
    first_order[n:, n:] = -np.linalg.solve(system.mass[at], system.damping[at])
    roots = np.linalg.eigvals(first_order)
    size = np.abs(roots)
    roots = roots[(roots.imag > 0.0) & (np.abs(roots.real) < CREEPS * size) & (size > ROUNDING * size.max())]
    return np.asarray(roots[np.argsort(np.abs(roots))])


def _partners(whole: ComplexArray, part: ComplexArray) -> ComplexArray:
    """For each root of the full line the one of the model that it has become, all in all the nearest; nan for none."""
    found = np.full(len(whole), np.nan, complex)
    rows, columns = linear_sum_assignment(np.abs(whole[:, None] - part) / np.abs(whole[:, None]))
    found[rows] = part[columns]
    return found


def _modes(roots: ComplexArray) -> LateralModes:
    return LateralModes(np.abs(roots), -roots.real / np.abs(roots))
