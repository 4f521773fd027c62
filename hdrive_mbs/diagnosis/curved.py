"""Steps that follow a valley which bends: what a step missed says how it bends.

Along the bottom of a narrow valley  z(s) = z + s v + a(s),  with the undamped Gauss-Newton step v, the residuals come down as the
tangent promises,  r(z(s)) = r + s J v,  as far as parameters can see to that:

    (J^T W J + P) a = -J^T W d,   d = r(z + m) - r - J m,

where m = s v + a is a step that was run: at first the straight one, then the one that this a has bent, which repeats it as a chord
method.  Priors are straight in z: they add P on the left and nothing to d.  Farther along a grows as s^2, which is exact to second
order where J is that of the point itself, no update of an older one.

Parameters that stand in for what is missing make such valleys.  Of our own eighth rotor set (c09, labels open, a bearing too soft by
16 %) a straight step promised 79 and half of it lost 1,930; eleven steps later the fit ended on its way, 10 above the bottom.

Source: M. K. Transtrum, J. P. Sethna, arXiv:1201.5885 (geodesic acceleration).  The first bend is from runs that a fit makes anyway.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bounded import bounded_step
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.normal_equations import normal_equations, promised

FloatArray = npt.NDArray[np.float64]

TINY = 1e-200

SHORT = 0.5
"""Share of what the undamped step promises: where no step gains as much, curved ones are tried."""
ROUNDS = 4
"""Times that a curve is bent anew at most, as long as each gains."""
GAINS = 1.2
"""Times the gain before, which a round has to give for another one."""
SHRINK, TRIES = 0.8, 20
"""A curve that leads farther than a step may is shortened by this factor, so often at most (to a hundredth)."""


@dataclass(frozen=True, eq=False)
class End:
    """A step that was run.

    part : of the undamped step;  point : where it led;  residuals : of all samples there, None where it cannot be run
    """

    part: float
    point: FloatArray
    residuals: FloatArray | None
    cost: float


Run = Callable[[list[FloatArray]], list[tuple[FloatArray | None, float]]]
"""Residuals and costs of points."""


@dataclass(frozen=True, eq=False)
class Valley:
    """A point of a fit with what is known there.

    step : v, the undamped step within its ranges, however long;  cost : at the point
    columns : J, shape (n, size);  weights : diagonal of W, (n,);  normal : J^T W J + P, (size, size)
    slope : J^T W r + P z, (size,);  residuals : r, (n,);  fit : mask of the fitted samples, which J and r are of
    """

    hypothesis: Hypothesis
    z: FloatArray
    step: FloatArray
    cost: float
    columns: FloatArray
    weights: FloatArray
    normal: FloatArray
    slope: FloatArray
    residuals: FloatArray
    fit: npt.NDArray[np.bool_]

    @property
    def longest(self) -> float:
        """Part of the undamped step that one step of a fit may take, at most 1."""
        reaches = self.hypothesis.reaches(self.z)
        return float(min(1.0, np.min(reaches / np.maximum(np.abs(self.step), TINY), initial=1.0)))

    @property
    def promised(self) -> float:
        """What the quadratic model says that this part of the step gains."""
        return promised(self.longest * self.step, self.normal, self.slope)

    def followed(self, straight: Sequence[End], known: float, run: Run) -> list[End]:
        """Ends of curved steps: of the straight part that came out best and the next longer one, then of the best so far.

        straight : parts of the undamped step that were run, longest first; those that were cut are left out
        known : the least cost of all steps that were tried
        """
        whole = [end for end in straight if np.allclose(end.point - self.z, end.part * self.step, rtol=1e-9, atol=1e-12)]
        if not whole:
            return []
        best = min(range(len(whole)), key=lambda k: whole[k].cost)
        asked, leading = whole[max(best - 1, 0) : best + 1], whole[best]
        found: list[End] = []
        for number in range(ROUNDS):
            curves = [(part, point) for end in asked for part, point in self._along(end)]
            runs = run([point for _, point in curves])
            ends = [End(part, point, *item) for (part, point), item in zip(curves, runs, strict=True)]
            found += ends
            better = min(ends, key=lambda end: end.cost, default=leading)
            if better.cost >= leading.cost:
                break
            gain, before = self.cost - better.cost, self.cost - min(known, leading.cost)
            if gain > SHORT * self.promised or gain < GAINS * before or (number > 0 and gain <= 0.0):
                break
            asked, leading = [better], better
        return found

    def _along(self, end: End) -> list[tuple[float, FloatArray]]:
        """Parts and points of the curve that an end gives: at this part, as far as a step may go and half-way in between by ratio."""
        if end.residuals is None:
            return []
        move = end.point - self.z
        missed = end.residuals[self.fit] - self.residuals - self.columns @ move
        slope = normal_equations(self.columns, self.weights, missed)[1]
        top = max(self.longest, end.part)
        reaches = self.hypothesis.reaches(self.z)
        curve: dict[float, FloatArray] = {}
        for part in (end.part, math.sqrt(end.part * top), top):
            for _ in range(TRIES):
                straight = self.hypothesis.clipped(self.z + part * self.step)
                bend = bounded_step(self.hypothesis, straight, self.normal, (part / end.part) ** 2 * slope)
                point = self.hypothesis.clipped(straight + bend)
                if np.all(np.abs(point - self.z) <= reaches):
                    curve[part] = point
                    break
                part *= SHRINK
        return sorted(curve.items())
