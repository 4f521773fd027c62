"""Steps along a valley that bends, on misfits that are known in closed form."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from hdrive_mbs.diagnosis.curved import SHORT, End, Run, Valley
from hdrive_mbs.diagnosis.fit import Fitted, fit
from tests.unit.bent_valley import ACROSS, ALONG, SAMPLES, Bent, two

FloatArray = npt.NDArray[np.float64]


def fitted(bent: Bent) -> Fitted:
    return fit(bent, two(), np.zeros(2), steps=40, enough=1e-6, share=0.0)  # type: ignore[arg-type]


@pytest.mark.parametrize("twist", [0.0, 0.2], ids=["parabola", "waves"])
def test_a_bent_valley_is_followed_in_fewer_runs_than_straight_steps_take(twist: float, monkeypatch: pytest.MonkeyPatch) -> None:
    bent, straight = Bent(0.5, twist), Bent(0.5, twist)
    curved = fitted(bent)
    monkeypatch.setattr(Valley, "followed", lambda *_: [])
    plain = fitted(straight)
    assert curved.converged
    # 1e-6 of the cost, whose curvature along the valley is 750 ALONG^2 = 68: a width of 2e-4
    np.testing.assert_allclose(curved.z, bent.bottom(), rtol=0.0, atol=1e-3)
    assert curved.cost <= plain.cost + 1e-3
    assert curved.steps < 0.5 * plain.steps
    assert bent.runs < straight.runs


HALF = np.arange(SAMPLES) < SAMPLES // 2


def valley_at(bent: Bent, z: FloatArray, precisions: FloatArray) -> Valley:
    """The valley as a fit sees it from a point on the floor of a parabola at z_0 = 0, where its slope is none."""
    columns = np.column_stack([np.where(HALF, ALONG, 0.0), np.where(HALF, 0.0, ACROSS)])[bent.fit]
    residuals = bent.one(z)[bent.fit]
    normal, slope = columns.T @ columns + np.diag(precisions), columns.T @ residuals + precisions * z
    cost = 0.5 * float(residuals @ residuals) + 0.5 * float(precisions @ z**2)
    step = -np.linalg.solve(normal, slope)
    return Valley(two(), z, step, cost, columns, np.ones(len(residuals)), normal, slope, residuals, bent.fit)


def runs_of(bent: Bent, precisions: FloatArray) -> Run:
    def run(points: list[FloatArray]) -> list[tuple[FloatArray | None, float]]:
        found = [(bent.one(z), z) for z in points]
        return [(r, 0.5 * float(r[bent.fit] @ r[bent.fit]) + 0.5 * float(precisions @ z**2)) for r, z in found]

    return run


def straight_ends(valley: Valley, run: Run) -> list[End]:
    parts = (1.0, 0.5, 0.25, 0.12, 0.06)
    points = [valley.z + np.clip(part * valley.step, -3.0, 3.0) for part in parts]  # 3: as far as a step of a parameter goes
    return [End(part, point, *item) for part, point, item in zip(parts, points, run(points), strict=True)]


@pytest.mark.parametrize("precision", [0.0, 30.0], ids=["free", "prior"])
def test_where_the_valley_is_a_parabola_the_whole_curved_step_keeps_its_promise(precision: float) -> None:
    """r'' is the same everywhere then, so the first bend is exact, and a prior along the valley shortens the step alone."""
    bent, precisions = Bent(0.5), np.array([precision, 0.0])
    run = runs_of(bent, precisions)
    valley = valley_at(bent, np.zeros(2), precisions)
    tried = straight_ends(valley, run)
    assert all(end.cost > valley.cost - SHORT * valley.promised for end in tried)  # it is bent
    ends = valley.followed(tried, min(end.cost for end in tried), run)
    best = min(ends, key=lambda end: end.cost)
    assert best.part == 1.0
    assert valley.cost - best.cost == pytest.approx(valley.promised, rel=1e-6)


def test_a_curve_that_leads_too_far_is_shortened_and_stays_on_the_floor() -> None:
    """The bottom lies at 4 and a step goes 3 far at most: from 0 the floor z_1 = 0.2 z_0^2 is followed to 3, not cut to it."""
    bent, precisions = Bent(0.2), np.zeros(2)
    run = runs_of(bent, precisions)
    near = valley_at(bent, np.zeros(2), precisions)
    valley = Valley(**{**vars(near), "step": 2.0 * near.step})  # as if the bottom lay at twice the distance
    assert valley.longest == pytest.approx(3.0 / 4.0, rel=0.05)
    ends = valley.followed(straight_ends(valley, run), np.inf, run)
    assert ends
    for end in ends:
        moved = end.point - valley.z
        assert np.all(np.abs(moved) <= 3.0)
        assert moved[0] == pytest.approx(end.part * valley.step[0], rel=1e-6)  # no coordinate is cut while the other goes on
    far = max(ends, key=lambda end: end.part)
    assert far.point[1] == pytest.approx(0.2 * far.point[0] ** 2, abs=0.02)


def test_a_straight_step_that_was_cut_says_nothing_of_the_valley() -> None:
    bent, precisions = Bent(0.2), np.zeros(2)
    run = runs_of(bent, precisions)
    valley = Valley(**{**vars(valley_at(bent, np.zeros(2), precisions)), "step": np.array([400.0, 0.0])})
    assert valley.followed([end for end in straight_ends(valley, run) if 400.0 * end.part > 3.0], np.inf, run) == []


def test_a_step_that_cannot_be_run_leads_nowhere() -> None:
    hypothesis, z = two(), np.zeros(2)
    mask = np.ones(3, bool)
    valley = Valley(hypothesis, z, np.ones(2), 10.0, np.zeros((3, 2)), np.ones(3), np.eye(2), -np.ones(2), np.zeros(3), mask)
    assert valley.followed([End(1.0, np.ones(2), None, np.inf)], 10.0, lambda points: []) == []
