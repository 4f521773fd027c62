"""Damped Gauss-Newton with normal priors: the most probable parameters of a hypothesis.

Minimises the misfit of the fitted samples (robust.py; |r|^2/2 where the model is right) + sum(p z^2)/2.  Each step solves
(J^T W J + P + lambda D) d = -(J^T W r + P z) for several lambda at once, runs all of them side by side and keeps the
best: Levenberg, Marquardt (e.g. Nocedal, Wright, Numerical Optimization, 10.3), with the damping found by
trial, and parts of the undamped step.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bounded import bounded_step
from hdrive_mbs.diagnosis.curved import SHORT, End, Run, Valley
from hdrive_mbs.diagnosis.differences import believed, jacobian, unseen_in
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.normal_equations import normal_equations, promised
from hdrive_mbs.diagnosis.simulator import Simulator, chi_square
from hdrive_mbs.errors import AnalysisError

FloatArray = npt.NDArray[np.float64]

SHORTER = ((1.0, (1.0, 0.5, 0.25, 0.12, 0.06)), (0.5, (1.0, 0.3, 0.1)), (0.0, (1.0, 0.3, 0.1)))
"""Power of the weights, and parts of the undamped step: tried side by side.  A weakly determined direction may wave where
the strongly determined ones are as narrow as they are, and then a part of the step is right and the whole is not.  With a
power below 1 the stretches that fit worst count for more than the misfit says."""
DAMPED = ((1.0, 1e-2), (1.0, 0.3), (1.0, 5.0), (0.5, 3e-2), (0.0, 0.1))
"""Power of the weights, and times the damping at hand: tried besides."""
AS_PROMISED, WELL_PROMISED = 0.6, (0.8, 1.3)
"""Shares of what the whole undamped step promises: from the first on it is taken without trying others, and between the
other two the Jacobian was good enough to be mended by what the step showed, in place of new differences."""
LATELY = 2
"""Last steps by which a fit is judged that has to come down to a cost."""
LONG, PATIENTLY, SLOWEST = 6, 0.01, 0.02
"""Steps in which a patient fit has to gain a share of what it stands above noise, the part of a gain that ends others which ends it, and
that share.  A friction with 21 parameters ended 710 above the bottom of its valley; told to go on, it gained 0.4, 1, 3, 8, 12 and 18, which
is 0.06 in six steps, and was there after 26 (c24 of our own sixteenth drive set, labels open)."""
TINY = 1e-300


@dataclass(frozen=True, eq=False)
class Fitted:
    """A hypothesis at its most probable parameters.

    z : search coordinates;  residuals : whitened, all samples;  cost : misfit of the fitted samples and priors
    curvature : J^T W J over the fitted samples at (or just before) z, shape (size, size)
    converged : whether the last step changed the cost by less than asked for;  patient : and whether it had gone on until it stalled
    chi_fit, chi_held : mean squares over the samples that it saw and those that it did not
    typical : twice the misfit of the fitted samples over their number: chi_fit with each stretch that fits badly counted by its logarithm.
        Impacts of a contact come a little early or late with every law that is nearly right, and few samples then hold most of the
        sum of squares (practice rotor-p03, a clearance: 1.50 where it is 1.04 so).
    misfit_held : misfit of the samples that no fit saw, counted as that of the others
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
    typical: float
    misfit_held: float
    history: tuple[float, ...] = field(default=())
    patient: bool = False

    @property
    def covariance(self) -> FloatArray:
        """Of the search coordinates: inverse of J^T W J + prior."""
        total = self.curvature + np.diag(self.hypothesis.curvatures(self.z))
        return np.asarray(np.linalg.inv(total))


def fit(
    simulator: Simulator,
    hypothesis: Hypothesis,
    start: FloatArray,
    *,
    steps: int = 20,
    enough: float = 0.2,
    share: float = 1e-4,
    begin: FloatArray | None = None,
    beat: float | None = None,
    patient: bool = False,
) -> Fitted:
    """The most probable parameters, from a start.

    steps : most Gauss-Newton steps;  enough, share : a step that lowers the cost by less than enough + share times the cost ends the search
    begin : residuals at the start, if they are there already
    beat : a cost that it has to come down to; given up where its last steps, kept up through all that are left, do not lead there
    patient : go on where a step gains a hundredth of that too, until it stalls (``stalls``)

    Raises AnalysisError where the start cannot be simulated.
    """
    z = hypothesis.clipped(np.asarray(start, float))
    residuals = begin if begin is not None else simulator.residuals(hypothesis, [z])[0]
    if residuals is None:
        raise AnalysisError(f"{hypothesis.label}: its start values cannot be simulated; give the effect other typical values.")
    precisions = hypothesis.precisions
    mask = simulator.fit
    noise = 0.5 * int(np.count_nonzero(mask))

    cost = _cost(simulator, hypothesis, residuals, z)
    history = [cost]
    damping, converged, done = 1.0, len(z) == 0, 0  # nothing to search: it is there
    curvature = np.zeros((len(z), len(z)))
    columns: FloatArray | None = None
    sizes: FloatArray | None = None  # of the columns that were known last
    fresh = True  # of differences at this very point
    followed = False  # whether curved steps were tried with it
    unseen = believed(simulator, hypothesis)
    for _ in range(0 if converged else steps):
        if columns is None:
            columns, fresh, followed = jacobian(simulator, hypothesis, z, residuals, unseen=unseen, sizes=sizes), True, False
            unseen = list(unseen_in(simulator, hypothesis, z, residuals, columns)) if len(simulator.spans) > 1 else unseen
        weights = simulator.blocks.weights(residuals[mask])
        systems = {}
        for power, _ in SHORTER:
            squares, slope = normal_equations(columns, weights**power, residuals[mask])
            systems[power] = squares, slope + precisions * z
        curvature = systems[1.0][0] if fresh else curvature
        sizes = np.sqrt(np.diag(systems[1.0][0]))
        points = _proposals(hypothesis, z, precisions, systems, damping)
        squares, slope = systems[1.0]
        normal = squares + np.diag(precisions)
        found, costs, kept_promise = _tried(simulator, hypothesis, points, cost, promised(points[0][0] - z, normal, slope))
        if fresh and not followed and len(found) == len(points):
            followed = True
            step = bounded_step(hypothesis, z, normal, slope)
            valley = Valley(hypothesis, z, step, cost, columns, weights, normal, slope, residuals[mask], mask)
            for end in _curved(valley, points, found, costs, enough + share * cost, partial(_run, simulator, hypothesis)):
                points.append((end.point, 0.0))
                found.append(end.residuals)
                costs.append(end.cost)
            del valley
        done += 1
        best = int(np.argmin(costs))
        chosen = found[best]
        if chosen is None or costs[best] >= cost:
            if not fresh:
                columns = None
                continue
            if damping > 1e4:
                converged = True
                break
            damping *= 30.0
            continue
        gain = cost - costs[best]
        factor = points[best][1]
        damping = min(max(damping * (30.0 if factor >= 5.0 else 1.0 if factor >= 3e-2 else 0.3), 1e-6), 1e6)
        of_differences, well = fresh, best == 0 and WELL_PROMISED[0] < kept_promise < WELL_PROMISED[1]
        moved = points[best][0] - z
        if well:
            mend(columns, chosen[mask] - residuals[mask], moved, np.diag(systems[1.0][0]) + precisions)
        else:
            columns = None
        fresh = False
        z, residuals, cost = points[best][0], chosen, costs[best]
        found.clear()  # of all steps, while the next differences are made
        history.append(cost)
        little = gain < enough + share * cost
        if little and of_differences and (not patient or gain < PATIENTLY * (enough + share * cost) or stalls(history, noise)):
            converged = True
            break
        columns = None if little else columns
        if falls_short(history, beat, steps - done):
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
        typical=2.0 * simulator.blocks.cost(residuals[mask]) / max(int(np.count_nonzero(mask)), 1),
        misfit_held=simulator.held_blocks.cost(residuals[simulator.held_out]),
        history=tuple(history),
        patient=patient,
    )


def falls_short(costs: Sequence[float], beat: float | None, left: int) -> bool:
    """Whether a fit will not come down to a cost although each step that is left gains what the last LATELY ones did together.

    costs : at the start and after each step that gained something;  left : steps
    """
    if beat is None or len(costs) <= LATELY:
        return False
    return costs[-1] - left * (costs[-1 - LATELY] - costs[-1]) > beat


def stalls(costs: Sequence[float], noise: float) -> bool:
    """Whether the last LONG steps together gained less than a share of what a fit stood above noise before them.

    costs : at the start and after each step that gained something
    """
    return len(costs) > LONG and costs[-1 - LONG] - costs[-1] < SLOWEST * (costs[-1 - LONG] - noise)


def mend(columns: FloatArray, change: FloatArray, move: FloatArray, scale: FloatArray) -> None:
    """Change a Jacobian to the nearest one that gives the change which a move made: Broyden's update, in place.

    columns : shape (n, size);  change : of the residuals, (n,);  move : (size,);  scale : squares of the coordinates' weights, (size,)

    Source: Dennis, Schnabel, Numerical Methods for Unconstrained Optimization, 8.1, with weighted coordinates.
    """
    weighted = scale * move
    missed, along = change - columns @ move, weighted / max(float(move @ weighted), TINY)
    for k, part in enumerate(along):
        columns[:, k] += part * missed


def _cost(simulator: Simulator, hypothesis: Hypothesis, residuals: FloatArray | None, z: FloatArray) -> float:
    """Misfit of the fitted samples and priors; infinite where a point could not be run."""
    return math.inf if residuals is None else simulator.blocks.cost(residuals[simulator.fit]) + hypothesis.prior_cost(z)


def _run(simulator: Simulator, hypothesis: Hypothesis, points: list[FloatArray]) -> list[tuple[FloatArray | None, float]]:
    """Residuals and costs of points."""
    runs = simulator.residuals(hypothesis, points)
    return [(item, _cost(simulator, hypothesis, item, point)) for item, point in zip(runs, points, strict=True)]


def _tried(
    simulator: Simulator, hypothesis: Hypothesis, points: Sequence[tuple[FloatArray, float]], cost: float, promised: float
) -> tuple[list[FloatArray | None], list[float], float]:
    """Residuals and costs of proposals, and the share of its promise that the first one keeps; the others only if it is small."""
    found: list[FloatArray | None] = []
    costs: list[float] = []
    kept = 0.0
    for some in (points[:1], points[1:]):
        runs = simulator.residuals(hypothesis, [point for point, _ in some])
        found += runs
        costs += [_cost(simulator, hypothesis, item, point) for item, (point, _) in zip(runs, some, strict=True)]
        kept = (cost - costs[0]) / max(promised, TINY)
        if kept > AS_PROMISED:
            break
    return found, costs, kept


def _curved(
    valley: Valley,
    points: Sequence[tuple[FloatArray, float]],
    found: Sequence[FloatArray | None],
    costs: Sequence[float],
    worth: float,
    run: Run,
) -> list[End]:
    """Ends of curved steps, where the steps that were tried keep too little of what is promised.

    points, found, costs : of the proposals, which begin with the parts of the undamped step;  worth : a gain that is worth a step
    """
    known = min(costs)
    if valley.promised <= worth or valley.cost - known > SHORT * valley.promised:
        return []
    parts = SHORTER[0][1]
    return valley.followed([End(part, points[k][0], found[k], costs[k]) for k, part in enumerate(parts)], known, run)


Systems = Mapping[float, tuple[FloatArray, FloatArray]]


def _proposals(
    hypothesis: Hypothesis, z: FloatArray, precisions: FloatArray, systems: Systems, damping: float
) -> list[tuple[FloatArray, float]]:
    """Points to try, each with its damping; steps are limited coordinate by coordinate and clipped to what is allowed."""
    reaches = hypothesis.reaches(z)

    def step(power: float, extra: float) -> FloatArray:
        curvature, slope = systems[power]
        return bounded_step(hypothesis, z, curvature + np.diag(precisions), slope, extra)

    points = []
    for power, parts in SHORTER:
        whole = step(power, 0.0)
        points += [(hypothesis.clipped(z + np.clip(part * whole, -reaches, reaches)), 0.0) for part in parts]
    for power, factor in DAMPED:
        points.append((hypothesis.clipped(z + np.clip(step(power, factor * damping), -reaches, reaches)), factor))
    return points
