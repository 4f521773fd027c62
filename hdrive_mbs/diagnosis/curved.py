"""Steps that follow a valley which bends: what a step missed says how it bends.

Along the bottom of a narrow valley  z(s) = z + s v + a(s),  with the undamped Gauss-Newton step v, the residuals come down as the
tangent promises,  r(z(s)) = r + s J v,  as far as parameters can see to that:

    (J^T W J + P) a = -J^T W d,   d = r(z + m) - r - J m,

where m = s v + a is a step that was run: at first the straight one, then the one that this a has bent, which repeats it as a chord
method.  Farther along a grows as s^2, which is exact to second order.

Parameters that stand in for what is missing make such valleys.  Of our own eighth rotor set (c09, labels open, a bearing too soft by
16 %) a straight step promised 79 and half of it lost 1,930; eleven steps later the fit ended on its way, 10 above the bottom.

Source: M. K. Transtrum, J. P. Sethna, arXiv:1201.5885 (geodesic acceleration); the second derivative is from runs that a fit makes anyway.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bounded import bounded_step
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.normal_equations import normal_equations

FloatArray = npt.NDArray[np.float64]

SHORT = 0.5
"""Share of what the whole undamped step promises: where no step gains as much, curved ones are tried."""
ROUNDS = 4
"""Times that a curve is bent anew, as long as each gains."""
GAINS = 1.2
"""Times the gain before, which a round has to give for another one."""


@dataclass(frozen=True, eq=False)
class End:
    """A step that was run.

    part : of the undamped step;  point : where it led;  residuals : of all samples there, None where it cannot be run
    """

    part: float
    point: FloatArray
    residuals: FloatArray | None
    cost: float


@dataclass(frozen=True, eq=False)
class Valley:
    """A point of a fit with what is known there.

    step : v, the undamped step as it may be taken;  promised : what the whole of it should gain;  cost : at the point
    columns : J, shape (n, size);  weights : diagonal of W, (n,);  normal : J^T W J + P, (size, size);  residuals : r, (n,)
    fit : mask of the fitted samples, which J and r are of
    """

    hypothesis: Hypothesis
    z: FloatArray
    step: FloatArray
    promised: float
    cost: float
    columns: FloatArray
    weights: FloatArray
    normal: FloatArray
    residuals: FloatArray
    fit: npt.NDArray[np.bool_]

    def followed(self, straight: Sequence[End], run: Callable[[list[FloatArray]], list[tuple[FloatArray | None, float]]]) -> list[End]:
        """Ends of curved steps: of the straight part that came out best and the next longer one, then of the best so far.

        straight : parts of the undamped step that were run, longest first;  run : residuals and costs of points
        """
        best = min(range(len(straight)), key=lambda k: straight[k].cost)
        asked = list(straight[max(best - 1, 0) : best + 1])
        found: list[End] = []
        leading = straight[best]
        for _ in range(ROUNDS):
            curves = [(part, point) for end in asked for part, point in self._along(end)]
            runs = run([point for _, point in curves])
            ends = [End(part, point, *item) for (part, point), item in zip(curves, runs, strict=True)]
            found += ends
            before, leading = leading, min([leading, *ends], key=lambda end: end.cost)
            gain = self.cost - leading.cost
            if leading is before or gain < GAINS * (self.cost - before.cost) or gain > SHORT * self.promised:
                break
            asked = [leading]
        return found

    def _along(self, end: End) -> list[tuple[float, FloatArray]]:
        """Parts and points of the curve that an end gives: at this part, at the whole step and half-way in between by ratio."""
        if end.residuals is None:
            return []
        move = end.point - self.z
        missed = end.residuals[self.fit] - self.residuals - self.columns @ move
        bend = bounded_step(self.hypothesis, self.z, self.normal, normal_equations(self.columns, self.weights, missed)[1])
        reaches = self.hypothesis.reaches(self.z)
        curve = []
        for part in sorted({end.part, math.sqrt(end.part), 1.0}):
            moved = np.clip(part * self.step + (part / end.part) ** 2 * bend, -reaches, reaches)
            curve.append((part, self.hypothesis.clipped(self.z + moved)))
        return curve
