"""How far the lateral modes of two models of one line part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.line_matrices import LineMatrices
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]

LOWEST = 4
"""Modes compared where no speed is given: two in each of two planes."""

VIBRATES = 0.9
"""Damping ratio above which a motion counts as creeping, not as a mode."""


@dataclass(frozen=True)
class LateralModes:
    """Lateral modes in the order of their frequencies [rad/s], with damping ratios."""

    frequency: FloatArray
    damping_ratio: FloatArray


@dataclass(frozen=True)
class ModeShifts:
    """Modes of the full line and of a model at a spin speed [rad/s], as many as are compared."""

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
    padded = np.concatenate([model, np.full(max(0, len(full) - len(model)), np.inf)])[: len(full)]
    return np.divide(padded, full, out=np.ones_like(full), where=full != 0.0) - 1.0


def mode_shifts(full: Scene, model: Scene, highest_speed: float | None = None) -> tuple[ModeShifts, ...]:
    """Lateral modes up to a frequency [rad/s], at rest and at that speed of the reference shaft; without it the lowest at rest.

    Laws are linearised in the middle of the bearings, all coordinates at zero.
    """
    lines = LineMatrices(full.network()), LineMatrices(model.network())
    speeds = (0.0,) if highest_speed is None else (0.0, highest_speed)
    made = []
    for speed in speeds:
        found = [lateral_modes(line, speed) for line in lines]
        count = LOWEST if highest_speed is None else int(np.sum(found[0].frequency <= highest_speed))
        cut = [LateralModes(modes.frequency[:count], modes.damping_ratio[:count]) for modes in found]
        made.append(ModeShifts(speed, *cut))
    return tuple(made)


def lateral_modes(lines: LineMatrices, speed: float) -> LateralModes:
    """Modes of bending at a spin speed [rad/s] of the reference shaft; axial and torsional motion held."""
    network = lines.network
    spins = {body.name: 0.0 if body.lateral else body.sense * body.ratio * speed for body in network.bodies}
    states = {state.name: state.initial for state in network.states}
    system = lines.at(dict.fromkeys(lines.names, 0.0), spins, states)
    kept = [k for k, body in enumerate(network.bodies) if body.lateral and not body.name.endswith(".z")]
    at = np.ix_(kept, kept)
    n = len(kept)
    first_order = np.zeros((2 * n, 2 * n))
    first_order[:n, n:] = np.eye(n)
    first_order[n:, :n] = -np.linalg.solve(system.mass[at], system.stiffness[at])
    first_order[n:, n:] = -np.linalg.solve(system.mass[at], system.damping[at])
    values = np.linalg.eigvals(first_order)
    values = values[values.imag > 0.0]
    ratios = -values.real / np.abs(values)
    values, ratios = values[np.abs(ratios) < VIBRATES], ratios[np.abs(ratios) < VIBRATES]
    order = np.argsort(np.abs(values))
    return LateralModes(np.abs(values)[order], ratios[order])
