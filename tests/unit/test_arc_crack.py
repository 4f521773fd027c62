"""The law of a crack that is open over an arc of its own, and a crack that is a keyway where the moment does not move it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import least_squares

import hdrive_mbs as hm
from hdrive_mbs.compiled.line import CompiledLine
from models import rotor_bench

DOWN = (0.0, -1.0)
ANGLES = np.linspace(-np.pi, np.pi, 721)


def opening(crack: hm.CrackEffect, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far it is open at angles between the crack and the weight, and the slope of that."""
    found, slope = crack.opening(0.0, np.cos(angles - 0.5 * np.pi), np.sin(angles - 0.5 * np.pi), DOWN)
    return np.asarray(found), np.asarray(slope)


def arc(steepness: float, opens_at: float) -> hm.ArcCrack:
    return hm.ArcCrack(compliance=1e-7, position=0.5, steepness=steepness, opens_at=opens_at)


@pytest.mark.parametrize("opens_at", [-1.0, -0.4, 0.0, 0.6, 1.0])
@pytest.mark.parametrize("steepness", [0.01, 0.3, 2.0, 10.0])
def test_it_is_open_below_shut_above_and_its_slope_is_the_derivative(steepness: float, opens_at: float) -> None:
    crack = arc(steepness, opens_at)
    found, slope = opening(crack, ANGLES)
    assert found[360] == pytest.approx(1.0, abs=1e-12)
    assert found[[0, -1]] == pytest.approx([0.0, 0.0], abs=1e-12)
    h = 1e-5
    differences = (opening(crack, ANGLES + h)[0] - opening(crack, ANGLES - h)[0]) / (2.0 * h)
    third = 8.0 * max(steepness, 1.0) ** 3 / (1.0 - abs(opens_at) * 0.5) ** 3  # bound of the third derivative, h^2/6 of which is left
    np.testing.assert_allclose(slope, differences, rtol=0.0, atol=third * h**2 / 6.0 + 1e-10)


def test_half_way_round_it_is_the_steep_crack_and_without_steepness_the_breathing_one() -> None:
    common = {"compliance": 1e-7, "position": 0.5}
    for steepness, other in ((2.0, hm.SteepCrack(**common, steepness=2.0)), (0.0, hm.BreathingCrack(**common))):
        for mine, theirs in zip(opening(arc(steepness, 0.0), ANGLES), opening(other, ANGLES), strict=True):
            np.testing.assert_allclose(mine, theirs, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize(
    ("law", "within"),
    [
        *((lambda b, m=m: np.cos(0.5 * b) ** m, 0.008) for m in (3.0, 4.0, 5.0, 6.0)),
        *((lambda b, a=a, e=e: np.clip((e - np.abs(b)) / (e - a), 0.0, 1.0), 0.03) for a, e in ((0.8, 1.6), (1.3, 2.6), (0.4, 1.9))),
    ],
)
def test_it_comes_as_near_to_other_laws_as_it_says(law: object, within: float) -> None:
    """Root mean square over a turn, with the compliance free as in a fit; a steep crack misses each by five times as much and more."""
    wanted = law(ANGLES)  # type: ignore[operator]

    def misfit(x: np.ndarray) -> np.ndarray:
        return np.asarray(x[0] * opening(arc(x[1], x[2]), ANGLES)[0] - wanted)

    fits = [least_squares(misfit, [1.0, 1.0, w], bounds=([0.0, 0.01, -1.0], [3.0, 50.0, 1.0])) for w in (-0.5, 0.5)]
    best = min(fit.cost for fit in fits)
    assert math.sqrt(2.0 * best / len(ANGLES)) < within
    steep = least_squares(lambda x: misfit(np.array([x[0], x[1], 0.0])), [1.0, 1.0], bounds=([0.0, 0.01], [3.0, 50.0]))
    assert steep.cost > 25.0 * best


def test_a_crack_that_the_moment_does_not_move_acts_as_the_keyway_that_is_its_limit() -> None:
    """At 180 rad/s; a moment of some 20 N m opens it by 20/1e5 of what it has, so displacements differ by that share of its effect."""
    crack = hm.MomentCrack(compliance=3e-7, cross_share=0.2, position=0.4, angle=0.5, closing_moment=1e5)
    assert hm.MomentCrack.limits == (hm.Keyway,)
    keyway = hm.Keyway(compliance=1.5e-7, cross_share=0.2, position=0.4, angle=0.5)
    scene = rotor_bench.build("steps")

    def run(effect: hm.Effect | None) -> np.ndarray:
        line = scene if effect is None else scene.with_effect(effect, at="section_1")
        speeds = {body.name: 180.0 for body in line.network().bodies if not body.lateral}
        return np.array([CompiledLine(line.network(), ["probe_r1_y"]).run(401, 5e-4, step=5e-5, speeds=speeds).values["probe_r1_y"]])

    plain, first, second = run(None), run(crack), run(keyway)
    effect = np.max(np.abs(first - plain))
    assert effect > 1e-7
    assert np.max(np.abs(second - first)) < 2e-3 * effect
