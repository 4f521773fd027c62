"""A misfit in closed form with a narrow valley that bends, in the place of a simulator."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.robust import Blocks
from hdrive_mbs.diagnosis.unknowns import Factor

FloatArray = npt.NDArray[np.float64]

SAMPLES = 2000
ALONG, ACROSS, CENTRE = 0.3, 15.0, 2.0
"""Standard deviations that a sample changes by, per unit along the valley and across it, and where along it the bottom is."""


class Bent:
    """Residuals ALONG (z_0 - CENTRE) in half of the samples and ACROSS (z_1 - f(z_0)) in the others, beside noise."""

    def __init__(self, bend: float, twist: float = 0.0) -> None:
        self.bend, self.twist = bend, twist
        self.fit = np.ones(SAMPLES, bool)
        self.fit[::4] = False
        self.held_out = ~self.fit
        self.blocks = Blocks(np.zeros(int(self.fit.sum()), int))
        self.held_blocks = Blocks(np.zeros(int(self.held_out.sum()), int))
        self.noise = np.random.default_rng(5).normal(size=SAMPLES)
        self.spans = (slice(0, int(self.fit.sum())),)
        self.unseen: dict[str, frozenset[int]] = {}
        self.runs = 0

    def one(self, z: FloatArray) -> FloatArray:
        floor = self.bend * z[0] ** 2 + self.twist * np.sin(3.0 * z[0])
        first = np.arange(SAMPLES) < SAMPLES // 2
        return np.asarray(self.noise + np.where(first, ALONG * (z[0] - CENTRE), ACROSS * (z[1] - floor)))

    def residuals(self, hypothesis: Hypothesis, points: Sequence[FloatArray], *left_out: object) -> list[FloatArray | None]:
        self.runs += len(points)
        return [self.one(z) for z in points]

    def bottom(self) -> FloatArray:
        """The most probable point as scipy finds it; the noise is white, so weights are one."""
        found = least_squares(lambda z: np.concatenate([self.one(z)[self.fit], z]), [CENTRE, self.bend * CENTRE**2], xtol=1e-14, ftol=1e-14)
        return np.asarray(found.x)


def two() -> Hypothesis:
    names = ("one", "two")
    return Hypothesis(tuple(Factor(path=f"{name}.stiffness", name=name, nominal={f"{name}.stiffness": 1.0}, sigma=0.01) for name in names))
