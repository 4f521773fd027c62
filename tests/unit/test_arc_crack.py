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
    whole = math.tanh(steepness * (1.0 + opens_at)) + math.tanh(steepness * (1.0 - opens_at))
    # h^2/6 of the third derivative is left: tanh has derivatives of 1, 4/3^1.5 and 2 at most; and rounding of an eps of values up to 1
    third = (steepness + 3.0 * steepness**2 * 4.0 / 3.0**1.5 + 2.0 * steepness**3) / whole
    rounding = 8.0 * np.finfo(float).eps / (2.0 * h)
    np.testing.assert_allclose(slope, differences, rtol=0.0, atol=third * h**2 / 6.0 + rounding)


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


def run(effect: hm.Effect | None) -> np.ndarray:
    """Displacement at a probe from 180 rad/s on, 0.2 s."""
    scene = rotor_bench.build("steps")
    network = (scene if effect is None else scene.with_effect(effect, at="section_1")).network()
    speeds = {body.name: 180.0 for body in network.bodies if not body.lateral}
    return np.asarray(CompiledLine(network, ["probe_r1_y"]).run(401, 5e-4, step=5e-5, speeds=speeds).values["probe_r1_y"])


def test_a_crack_that_the_moment_hardly_moves_goes_over_into_the_keyway_that_is_its_limit() -> None:
    """What is left between them is a share M/M_c of the effect, of moments below 100 N m, and goes with it but for that share of itself."""
    common = {"cross_share": 0.2, "position": 0.4, "angle": 0.5}
    assert hm.MomentCrack.limits == (hm.Keyway,)
    plain, keyway = run(None), run(hm.Keyway(compliance=1.5e-7, **common))
    apart = [np.max(np.abs(run(hm.MomentCrack(compliance=3e-7, closing_moment=moment, **common)) - keyway)) for moment in (1e4, 1e5)]
    share = apart[0] / np.max(np.abs(keyway - plain))
    assert 0.0 < share < 100.0 / 1e4
    assert apart[0] == pytest.approx(10.0 * apart[1], rel=share)


def test_a_crack_with_a_phase_of_its_own_is_the_same_after_half_a_turn_of_its_front() -> None:
    assert "angle" in hm.PhasedCrack.half_turn
    first, second = (run(hm.PhasedCrack(compliance=3e-7, position=0.4, angle=angle, phase=0.8)) for angle in (0.5, 0.5 - math.pi))
    np.testing.assert_allclose(second, first, rtol=0.0, atol=1e-9 * np.max(np.abs(first)))
