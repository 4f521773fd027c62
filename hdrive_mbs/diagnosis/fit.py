"""Damped Gauss-Newton with normal priors: the most probable parameters of a hypothesis.

Minimises the misfit of the fitted samples (robust.py; |r|^2/2 where the model is right) + sum(p z^2)/2.  Each step solves
(J^T W J + P + lambda D) d = -(J^T W r + P z) for several lambda at once, runs all of them side by side and keeps the
best: Levenberg, Marquardt (e.g. Nocedal, Wright, Numerical Optimization, 10.3), with the damping found by trial.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.simulator import Simulator, chi_square
from hdrive_mbs.errors import AnalysisError

FloatArray = npt.NDArray[np.float64]

TRIED = ((0.0, 1.0), (1e-2, 1.0), (0.3, 1.0), (5.0, 1.0), (0.0, 0.5), (3e-2, 0.5), (0.0, 0.0), (0.1, 0.0))
"""Each step tries all of these: times the damping at hand, and power of the weights.  With a power below 1 the stretches
that fit worst count for more than the misfit says, which gets through curved valleys in fewer steps."""


@dataclass(frozen=True, eq=False)
class Fitted:
    """A hypothesis at its most probable parameters.

    z : search coordinates;  residuals : whitened, all samples;  cost : misfit of the fitted samples and priors
    curvature : J^T W J over the fitted samples at (or just before) z, shape (size, size)
    converged : whether the last step changed the cost by less than asked for
    """

    hypothesis: Hypothesis
    z: FloatArray
    residuals: FloatArray
    cost: float
    curvature: FloatArray
    converged: bool
    steps: int
    chi_fit: float
    chi_held: float
    history: tuple[float, ...] = field(default=())

    @property
    def covariance(self) -> FloatArray:
        """Of the search coordinates: inverse of J^T W J + prior."""
        total = self.curvature + np.diag(self.hypothesis.curvatures(self.z))
        return np.asarray(np.linalg.inv(total))


def jacobian(simulator: Simulator, hypothesis: Hypothesis, z: FloatArray, residuals: FloatArray) -> FloatArray:
    """d residuals/dz over the fitted samples, shape (n, size), by differences; a column that cannot be run is zero."""
    steps = hypothesis.steps(z)
    points = []
    for k, step in enumerate(steps):
        moved = z.copy()
        moved[k] += step
        clipped = hypothesis.clipped(moved)
        if clipped[k] == z[k]:  # at its upper limit
            moved[k], steps[k] = z[k] - step, -step
        points.append(moved)
    found = simulator.residuals(hypothesis, points)
    base = residuals[simulator.fit]
    columns = np.zeros((len(z), len(base)))
    for k, item in enumerate(found):
        if item is not None:
            columns[k] = (item[simulator.fit] - base) / steps[k]
    return columns.T


def fit(
    simulator: Simulator,
    hypothesis: Hypothesis,
    start: FloatArray,
    *,
    steps: int = 20,
    enough: float = 0.02,
    share: float = 1e-4,
    stop: Callable[[], bool] | None = None,
    begin: FloatArray | None = None,
) -> Fitted:
    """The most probable parameters, from a start.

    steps : most Gauss-Newton steps;  enough, share : a step that lowers the cost by less than enough + share times the cost ends the search
    begin : residuals at the start, if they are there already

    Raises AnalysisError where the start cannot be simulated.
    """
    z = hypothesis.clipped(np.asarray(start, float))
    residuals = begin if begin is not None else simulator.residuals(hypothesis, [z])[0]
    if residuals is None:
        raise AnalysisError(f"{hypothesis.label}: its start values cannot be simulated; give the effect other typical values.")
    precisions = hypothesis.precisions
    mask = simulator.fit

    def cost_of(values: FloatArray, at: FloatArray) -> float:
        return simulator.blocks.cost(values[mask]) + hypothesis.prior_cost(at)

    cost = cost_of(residuals, z)
    history = [cost]
    damping, converged, done = 1.0, False, 0
    curvature = np.zeros((len(z), len(z)))
    for _ in range(steps):
        columns = jacobian(simulator, hypothesis, z, residuals)
        weights = simulator.blocks.weights(residuals[mask])
        systems = {}
        for power in {power for _, power in TRIED}:
            weighted = columns * (weights**power)[:, None]
            systems[power] = weighted.T @ columns, weighted.T @ residuals[mask] + precisions * z
        curvature = systems[1.0][0]
        points = _proposals(hypothesis, z, precisions, systems, damping)
        found = simulator.residuals(hypothesis, [point for point, _ in points])
        costs = [np.inf if item is None else cost_of(item, point) for item, (point, _) in zip(found, points, strict=True)]
        done += 1
        best = int(np.argmin(costs))
        chosen = found[best]
        if chosen is None or costs[best] >= cost:
            if damping > 1e4:
                converged = True
                break
            damping *= 30.0
            continue
        gain = cost - costs[best]
        factor = points[best][1]
        damping = min(max(damping * (30.0 if factor >= 5.0 else 1.0 if factor >= 3e-2 else 0.3), 1e-6), 1e6)
        z, residuals, cost = points[best][0], chosen, costs[best]
        history.append(cost)
        if gain < enough + share * cost:
            converged = True
            break
        if stop is not None and stop():
            break
    return Fitted(
        hypothesis=hypothesis,
        z=z,
        residuals=residuals,
        cost=cost,
        curvature=curvature,
        converged=converged,
        steps=done,
        chi_fit=chi_square(residuals, mask),
        chi_held=chi_square(residuals, simulator.held_out),
        history=tuple(history),
    )


def _proposals(
    hypothesis: Hypothesis,
    z: FloatArray,
    precisions: FloatArray,
    systems: Mapping[float, tuple[FloatArray, FloatArray]],
    damping: float,
) -> list[tuple[FloatArray, float]]:
    """Steps for each damping and weighting, shortened coordinate by coordinate and clipped to what is allowed."""
    reaches = hypothesis.reaches(z)
    points = []
    for factor, power in TRIED:
        curvature, slope = systems[power]
        normal = curvature + np.diag(precisions)
        scale = np.sqrt(np.where(np.diag(normal) > 0.0, np.diag(normal), 1.0))
        scaled = normal / np.outer(scale, scale) + (factor * damping + 1e-12) * np.eye(len(z))
        move = -np.linalg.lstsq(scaled, slope / scale, rcond=None)[0] / scale
        points.append((hypothesis.clipped(z + np.clip(move, -reaches, reaches)), factor))
    return points
