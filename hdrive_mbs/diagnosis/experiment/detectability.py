"""How far apart the records of two fitted models would be, after the second has adapted its parameters.

    D = min over c of |W (S_1 - S_2(z + c))|^2 + c^T H c,    z + c allowed

S are the columns that the models show in the planned record, the first as it was fitted; W whitens with the bench's
noise; z are all parameters of the second, nominal ones and those of its effect; H is what already holds these: their
priors and, unless the record is to speak alone, the records of the fit.  Signatures are of full size, and the least is
found by Gauss-Newton steps until their linear promise is kept (a resonance that moves by its own width is not linear).
If the first model is right, the logarithm of the odds against the second rises by about D/2; D < 25 (five standard
deviations) is not distinguishable.

Source: T-optimal design, Atkinson, Fedorov, Biometrika 62 (1975) 57, with priors.  Leaves out that the first model is
not known exactly, and a second least far away.  A model that holds the other one as a special case (no friction) can always
follow it in a new record that speaks alone; then only the old records, which the special case did not fit, tell them apart.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt
from scipy.optimize import lsq_linear

from hdrive_mbs.diagnosis.differences import jacobian
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import AnalysisError, ParameterError

FloatArray = npt.NDArray[np.float64]

Bounds = tuple[FloatArray, FloatArray]

DISTINGUISHABLE = 25.0
"""Least D that tells two causes apart."""
ROUNDS, SHARES = 6, (1.0, 0.6, 0.25)
"""Most Gauss-Newton steps, and the shares of each that are tried side by side."""
ENOUGH, KEPT = 0.3, 0.03
"""A step that leaves no more than this above its promise (in noise units, and of D) is the last one."""
FAR, LEAST_ROOM = 1e6, 1e-9
"""A change that leaves whatever is allowed, and the room that a parameter without any is left with."""


def detectability(trials: Sequence[Trial], first: Fitted, second: Fitted, *, step: float, every: int = 1, alone: bool = False) -> float:
    """D of a planned record, if the first model is right and the second is fitted to it.

    trials : of the planned record, see ``Bench.planned``; their noise is that of what they measure
    step : longest step of the integration [s];  every : compare only each such sample
    alone : whether the planned record speaks alone, and not together with the records of the fits

    Raises AnalysisError where one of the models cannot be simulated through the plan.
    """
    return Predictions(trials, (first, second), step=step, every=every).between(0, 1, alone=alone)


class Predictions:
    """What several fitted models predict for a planned record.

    rounds : most Gauss-Newton steps to each D

    Raises AnalysisError where one of them cannot be simulated.
    """

    def __init__(self, trials: Sequence[Trial], fits: Sequence[Fitted], *, step: float, every: int = 1, rounds: int = ROUNDS) -> None:
        if not trials or not fits:
            raise ParameterError("Predictions need a planned record and a fitted model.")
        self._fits, self._rounds = tuple(fits), rounds
        shown = Simulator(trials, step).columns(fits[0].hypothesis, fits[0].z)
        if not all(shown):
            raise _not_run(fits[0], trials)
        # as if measured without noise where the first model is right: differences are then taken before they are whitened
        seen = [replace(trial, columns=own, held_out=np.zeros(trial.samples, bool)) for trial, own in zip(trials, shown, strict=True)]
        self._simulator = Simulator(seen, step, every)
        self._residuals: list[FloatArray] = []
        for fitted in fits:
            residuals = self._simulator.residuals(fitted.hypothesis, [fitted.z])[0]
            if residuals is None:
                raise _not_run(fitted, trials)
            self._residuals.append(residuals)
        self._columns: dict[int, FloatArray] = {}

    def columns(self, number: int) -> FloatArray:
        """J = dr/dz of a model as it was fitted, r = -W S, shape (n, size)."""
        if number not in self._columns:
            fitted = self._fits[number]
            self._columns[number] = jacobian(self._simulator, fitted.hypothesis, fitted.z, self._residuals[number])
        return self._columns[number]

    def between(self, first: int, second: int, *, alone: bool = False) -> float:
        """D, if the first is right; of models that show the same as they are fitted what they differ by, which D is not above."""
        least = self.differ_by(first, second)
        if least < ENOUGH:
            return least
        fitted, simulator = self._fits[second], self._simulator
        held, (low, high) = holding(fitted, alone=alone), allowed(fitted)
        moved, residuals, columns = np.zeros(len(fitted.z)), self._residuals[second], self.columns(second)
        difference = residuals - self._residuals[first]
        for k in range(self._rounds):
            if k > 0:
                columns = jacobian(simulator, fitted.hypothesis, fitted.z + moved, residuals)
            aim, promised = least_squares(difference - columns @ moved, columns, held, (low, high))
            points = [moved + share * (aim - moved) for share in SHARES]
            found = simulator.residuals(fitted.hypothesis, [fitted.z + point for point in points])
            before = least
            for point, item in zip(points, found, strict=True):
                if item is not None:
                    left = item - self._residuals[first]
                    cost = float(left @ left + point @ held @ point)
                    if cost < least:
                        least, moved, residuals, difference = cost, point, item, left
            if least - promised < ENOUGH + KEPT * least or before - least < ENOUGH:
                break
        return least

    def differ_by(self, first: int, second: int) -> float:
        """|W (S_1 - S_2)|^2 of both as they are fitted: D is not above it."""
        difference = self._residuals[second] - self._residuals[first]
        return float(difference @ difference)

    def nearest_first(self) -> list[tuple[int, int]]:
        """All pairs of models, first those that differ least as they are fitted."""
        return sorted(itertools.combinations(range(len(self._fits)), 2), key=lambda pair: self.differ_by(*pair))

    def apart(self, first: int, second: int, *, alone: bool = False) -> float:
        """The smaller D of both ways round: whichever of the two is right, the other one is ruled out by it."""
        return min(self.between(first, second, alone=alone), self.between(second, first, alone=alone))


def holding(fitted: Fitted, *, alone: bool = False) -> FloatArray:
    """H: what holds the parameters of a fit, shape (size, size)."""
    priors = np.diag(fitted.hypothesis.precisions)
    return priors if alone else priors + fitted.curvature


def least_squares(difference: FloatArray, columns: FloatArray, held: FloatArray, bounds: Bounds) -> tuple[FloatArray, float]:
    """The c within bounds with the least |difference + columns c|^2 + c^T held c, and this least."""
    size = columns.shape[1]
    scale = np.sqrt(np.sum(columns**2, axis=0) + np.diag(held))
    scale = 1.0 / np.where(scale > 0.0, scale, 1.0)
    values, vectors = np.linalg.eigh(held * np.outer(scale, scale))
    root = vectors.T * np.sqrt(np.maximum(values, 0.0))[:, None]
    triangle = np.asarray(np.linalg.qr(np.column_stack((columns * scale, difference)), mode="r"))
    part, outside = triangle[:size, size], triangle[size:, size]  # of the difference, and what no c reaches
    system, wanted = np.vstack((triangle[:size, :size], root)), -np.concatenate((part, np.zeros(size)))
    moved = lsq_linear(system, wanted, bounds=(bounds[0] / scale, bounds[1] / scale), method="bvls").x
    left = system @ moved - wanted
    return scale * moved, float(outside @ outside + left @ left)


def allowed(fitted: Fitted) -> Bounds:
    """Least and largest change of each parameter of a fit, the others as they are: a strength cannot fall below zero."""
    found = []
    for far in (-FAR, FAR):
        ends = np.empty(len(fitted.z))
        for k in range(len(ends)):
            moved = fitted.z.copy()
            moved[k] += far
            ends[k] = fitted.hypothesis.clipped(moved)[k] - fitted.z[k]
        found.append(ends)
    low, high = np.minimum(found[0], 0.0), np.maximum(found[1], 0.0)
    return low, np.where(high > low, high, low + LEAST_ROOM)


def _not_run(fitted: Fitted, trials: Sequence[Trial]) -> AnalysisError:
    names = ", ".join(repr(trial.name) for trial in trials)
    return AnalysisError(f"{fitted.hypothesis.label} cannot be simulated through the planned record {names}; plan it smaller or slower.")
