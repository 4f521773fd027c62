"""Roots that rounding alone keeps apart are one, whose shapes are chosen by the sense of whirl."""

from __future__ import annotations

import numpy as np
import pytest

from hdrive_mbs.analysis.whirl.roots import TOGETHER, solve_roots

LARGEST, LOWEST = 1e8, 800.0
"""rad/s: what a bearing of 1e14 N/m makes of a light ring, and a shaft between such bearings."""
APART = 3e-13
"""Of the largest; seen between the first two roots of a shaft with 776 states (tests/verification/test_published_rotors.py)."""


def senses(planes: int, apart: float) -> np.ndarray:
    """Forward part less the backward part of the two lowest shapes of as many planes x, y, alike but for the first two roots."""
    size = 2 * planes
    frequencies = np.repeat(np.geomspace(LOWEST, LARGEST, planes), 2)
    frequencies[1] += apart
    whirl = np.kron(np.eye(planes), 0.5j * np.array([[0.0, 1.0], [-1.0, 0.0]]))  # positive for x + i y in the positive sense
    still = np.zeros((size, size))
    roots = solve_roots(still, np.diag(frequencies**2), np.zeros((size, 0)), lambda: (still, still), whirl)
    shapes = roots.right[:, :2]
    return np.array([(x.conj() @ whirl @ x).real / (x.conj() @ x).real for x in shapes.T])


def test_two_equal_roots_of_a_long_line_are_one_backward_and_one_forward_whirl() -> None:
    assert TOGETHER[0] < APART  # a bound that knows no size would part them
    assert senses(200, APART * LARGEST) == pytest.approx([-0.5, 0.5], abs=1e-6)


def test_of_a_short_line_as_much_is_more_than_rounding_and_its_planes_stay_apart() -> None:
    assert senses(8, APART * LARGEST) == pytest.approx([0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("planes", [8, 200])
def test_roots_that_differ_by_more_than_rounding_keep_their_planes(planes: int) -> None:
    assert senses(planes, 1e-11 * LARGEST) == pytest.approx([0.0, 0.0], abs=1e-6)
