"""Jacobians by differences against derivatives that are sharper than they are, and how long their differences are."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

from hdrive_mbs.diagnosis.differences import FIRST, SHORT, SHORTEST, jacobian, lengths
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from tests.unit.diagnosis_cases import bench, quiet

FloatArray = npt.NDArray[np.float64]


@pytest.fixture(scope="module")
def simulator() -> Simulator:
    """One record of the small drive bench, its parameters off by their tolerance."""
    return Simulator(bench().trials(quiet()[0]), 2.5e-4, 4)


@pytest.fixture(scope="module")
def near(simulator: Simulator) -> Fitted:
    """A fit that has not ended, away from the bottom."""
    hypothesis = Hypothesis(factors_of(bench()))
    return fit(simulator, hypothesis, np.full(hypothesis.size, 0.8), steps=1)


def central(simulator: Simulator, fitted: Fitted, step: float) -> FloatArray:
    """d residuals/dz by central differences, shape (n, size): their error is of second order in the step."""
    moves = step * np.eye(len(fitted.z))
    ends = simulator.residuals(fitted.hypothesis, [fitted.z + move for move in (*moves, *-moves)])
    values = np.array([item[simulator.fit] for item in ends if item is not None])
    return (values[: len(moves)] - values[len(moves) :]).T / (2.0 * step)


def test_short_differences_miss_less_than_what_they_change(simulator: Simulator, near: Fitted) -> None:
    """Against Richardson's extrapolation of central differences, whose own error the difference of two of them bounds."""
    coarse, fine = (central(simulator, near, step) for step in (2e-3, 1e-3))
    sharp = fine + (fine - coarse) / 3.0
    sizes = np.linalg.norm(sharp, axis=0)
    unsure = np.linalg.norm(sharp - fine, axis=0)
    first = jacobian(simulator, near.hypothesis, near.z, near.residuals)
    again = jacobian(simulator, near.hypothesis, near.z, near.residuals, sizes=sizes)
    for columns in (first, again):
        assert np.all(np.linalg.norm(columns - sharp, axis=0) < SHORT + unsure)
    # differences as long as the coordinates' steps miss many times as much
    whole = jacobian(simulator, near.hypothesis, near.z, near.residuals, sizes=SHORT / near.hypothesis.steps(near.z))
    assert np.max(np.linalg.norm(whole - sharp, axis=0)) > 10.0 * np.max(np.linalg.norm(again - sharp, axis=0))


def test_differences_change_the_residuals_by_as_much_where_it_is_known_what_shows() -> None:
    steps = np.array([0.01, 0.01, 0.01, 0.003])
    np.testing.assert_allclose(lengths(steps, None), FIRST * steps)
    # 0.3 of 3,000 a unit; of 3 a unit no more than the step; of 1e9 no less than a ten-thousandth; of nothing as if it were not known
    np.testing.assert_allclose(lengths(steps, np.array([3e3, 3.0, 1e9, 0.0])), [SHORT / 3e3, 0.01, SHORTEST * 0.01, FIRST * 0.003])
