"""Steps along a valley that bends, on misfits that are known in closed form."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pytest
from scipy.optimize import least_squares

from hdrive_mbs.diagnosis import fit as fitting
from hdrive_mbs.diagnosis.curved import SHORT, End, Valley
from hdrive_mbs.diagnosis.fit import Fitted, fit
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


def fitted(bent: Bent) -> Fitted:
    return fit(bent, two(), np.zeros(2), steps=40, enough=1e-6, share=0.0)  # type: ignore[arg-type]


@pytest.mark.parametrize("twist", [0.0, 0.2], ids=["parabola", "waves"])
def test_a_bent_valley_is_followed_in_fewer_runs_than_straight_steps_take(twist: float, monkeypatch: pytest.MonkeyPatch) -> None:
    bent, straight = Bent(0.5, twist), Bent(0.5, twist)
    curved = fitted(bent)
    monkeypatch.setattr(fitting, "SHORT", 0.0)
    plain = fitted(straight)
    assert curved.converged
    # 1e-6 of the cost, whose curvature along the valley is 750 ALONG^2 = 68: a width of 2e-4
    np.testing.assert_allclose(curved.z, bent.bottom(), rtol=0.0, atol=1e-3)
    assert curved.cost <= plain.cost + 1e-3
    assert curved.steps < 0.5 * plain.steps
    assert bent.runs < straight.runs


def test_where_the_valley_is_a_parabola_the_whole_curved_step_is_the_bottom() -> None:
    """r'' is the same everywhere then, so the first bend is exact; without priors the residuals come down as the tangent promises."""
    bent, hypothesis, z = Bent(0.5), two(), np.zeros(2)
    here = bent.one(z)
    columns = np.column_stack(
        [np.where(np.arange(SAMPLES) < SAMPLES // 2, ALONG, 0.0), np.where(np.arange(SAMPLES) < SAMPLES // 2, 0.0, ACROSS)]
    )
    columns, residuals = columns[bent.fit], here[bent.fit]
    normal = columns.T @ columns
    step = -np.linalg.solve(normal, columns.T @ residuals)
    promised = 0.5 * float(step @ normal @ step)

    def run(points: list[FloatArray]) -> list[tuple[FloatArray | None, float]]:
        return [(r, 0.5 * float(r[bent.fit] @ r[bent.fit])) for r in map(bent.one, points)]

    cost = run([z])[0][1]
    tried = [End(part, z + part * step, *run([z + part * step])[0]) for part in (1.0, 0.5, 0.25, 0.12, 0.06)]
    assert all(end.cost > cost - SHORT * promised for end in tried)  # it is bent
    valley = Valley(hypothesis, z, step, promised, cost, columns, np.ones(len(residuals)), normal, residuals, bent.fit)
    ends = valley.followed(tried, run)
    best = min(ends, key=lambda end: end.cost)
    assert best.part == 1.0
    assert cost - best.cost == pytest.approx(promised, rel=1e-6)


def test_a_step_that_cannot_be_run_leads_nowhere() -> None:
    hypothesis, z = two(), np.zeros(2)
    mask = np.ones(3, bool)
    valley = Valley(hypothesis, z, np.ones(2), 1.0, 10.0, np.zeros((3, 2)), np.ones(3), np.eye(2), np.zeros(3), mask)
    assert valley.followed([End(1.0, np.ones(2), None, np.inf)], lambda points: []) == []
