"""The solver that a simulation takes when none is given."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from hdrive_mbs.analysis.torsional_step import OF_SPEEDS, torsional_step
from hdrive_mbs.analysis.turning_alone import TurningAlone
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.engine.solvers import DormandPrince, Solver, Trapezoidal
from hdrive_mbs.network.network import Network

ACCURACY = 1e-3
"""Relative error of whirl amplitudes that the step of a rotor line is chosen for."""

LOWEST = 2
"""Pairs of lateral natural frequencies that count, besides the highest speed."""


@dataclass(frozen=True)
class ChosenSolver:
    """A solver, and what is to be said of it (or nothing)."""

    solver: Solver
    remark: str = ""


def default_solver(network: Network, duration: float, initial_speed: float, initial: Mapping[str, float] | None = None) -> ChosenSolver:
    """DormandPrince for what only turns; for rotor lines the implicit trapezoidal rule with (w h)^2/2 <= 1e-3.

    w is the highest speed that the drive can reach, or the second lateral natural frequency at rest if that is higher; the
    step is cut where a torsional vibration asks for it (torsional_step).  The adaptive solver measures its error against
    the largest coordinate, which is a spin angle, and a stiff ring holds its step at microseconds.  Faster motion (balls,
    gear teeth, shocks) needs a shorter step: give the solver.
    """
    if not network.is_lateral:
        return ChosenSolver(DormandPrince())
    line = TurningAlone(network, duration, initial_speed, initial)
    fastest = max([*line.fastest().values(), _natural(network)])
    step = math.sqrt(2.0 * ACCURACY) / fastest if fastest > 0.0 else duration / 200.0
    step, tolerance = duration / max(200, math.ceil(duration / step)), 0.01 * ACCURACY
    cut = torsional_step(line, step, OF_SPEEDS * ACCURACY, tolerance)
    return ChosenSolver(Trapezoidal(step=cut.step, newton_tolerance=tolerance), cut.remark)


def _natural(network: Network) -> float:
    """The highest of the lowest lateral natural frequencies at rest [rad/s]; 0 where nothing holds the line."""
    rest = {body.name: 0.0 for body in network.bodies}
    system = LineMatrices(network).at(rest, rest, {state.name: state.initial for state in network.states})
    lateral = [k for k, body in enumerate(network.bodies) if body.lateral]
    at = np.ix_(lateral, lateral)
    stiffness = 0.5 * (system.stiffness[at] + system.stiffness[at].T)
    squares = eigh(stiffness, system.mass[at], eigvals_only=True)
    elastic = squares[squares > 1e-6 * max(1.0, float(np.max(squares)) * 1e-6)]
    return float(np.sqrt(elastic[min(2 * LOWEST, len(elastic)) - 1])) if len(elastic) else 0.0
