"""The reduced two-equation model against hand formulas, and its verdict."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh

import hdrive_mbs as hm
from models.harmonic_drive_train import build

RATIO = 100.0
J_S, J_IN, J_WG, J_FS, J_OUT, J_MR = 1.5e-3, 1e-5, 1.69e-4, 4e-4, 2.465e-5, 0.5
K_IN, K_OUT, K1, K2 = 1e4, 5.1913e4, 3.2e4, 6.4e4

NUMERIC = 1e-7
"""Exudyn differentiates user functions numerically: stiffness to some 1e-8, frequencies to half of it."""


def two_masses(stiffness: float) -> float:
    """First frequency of the reduced model: motor side u^2 (J_s + J_wwe + J_WG) against J_FS + J_wwy + J_MR [rad/s]."""
    motor, machine = RATIO**2 * (J_S + J_IN + J_WG), J_FS + J_OUT + J_MR
    return math.sqrt(stiffness * (1.0 / motor + 1.0 / machine))


def four_masses(stiffness: float, output: float = K_OUT) -> np.ndarray:
    """Elastic frequencies of the full model, all on the output axis [rad/s]."""
    M = np.diag([RATIO**2 * (J_S + 0.5 * J_IN), RATIO**2 * (J_WG + 0.5 * J_IN), J_FS + 0.5 * J_OUT, J_MR + 0.5 * J_OUT])
    K = np.zeros((4, 4))
    for i, k in enumerate((RATIO**2 * K_IN, stiffness, output)):
        e = np.zeros(4)
        e[i], e[i + 1] = 1.0, -1.0
        K += k * np.outer(e, e)
    return np.sqrt(eigh(K, M, eigvals_only=True)[1:])


@pytest.mark.parametrize(("torque", "stiffness"), [(20.0, K1), (60.0, K2)])
def test_both_models_have_the_frequencies_of_the_hand_formulas(torque: float, stiffness: float) -> None:
    result = hm.reduce(build(), torque=torque)
    np.testing.assert_allclose(result.full_undamped, four_masses(stiffness), rtol=NUMERIC)
    np.testing.assert_allclose(result.reduced_undamped, [two_masses(stiffness)], rtol=NUMERIC)
    assert result.mode_error[0] == pytest.approx(two_masses(stiffness) / four_masses(stiffness)[0] - 1.0, abs=3.0 * NUMERIC)


def test_with_the_papers_output_shaft_the_reduction_is_not_valid() -> None:
    # 26 mm x 70 mm steel: 5.19e4 N m/rad, hardly stiffer than the flexspline, so the first mode is 27 % too high
    result = hm.reduce(build(), torque=20.0)
    assert not result.valid
    assert "not valid" in result.reason
    assert "keep the shafts" in result.reason
    compliance = np.array([1.0 / (RATIO**2 * K_IN), 1.0 / K1, 1.0 / K_OUT])
    np.testing.assert_allclose([result.compliance[name] for name in ("input_shaft", "gear", "output_shaft")], compliance, rtol=1e-9)
    assert result.shaft_share == pytest.approx((compliance[0] + compliance[2]) / compliance.sum(), rel=1e-9)
    assert sum(result.shares.values()) == pytest.approx(1.0)


def test_with_a_hundred_times_stiffer_output_shaft_it_is_valid() -> None:
    result = hm.reduce(build().replacing({"output_shaft.stiffness": 100.0 * K_OUT}), torque=20.0)
    error = two_masses(K1) / four_masses(K1, 100.0 * K_OUT)[0] - 1.0
    assert 0.0 < error < 0.01
    assert result.valid
    assert result.mode_error[0] == pytest.approx(error, abs=3.0 * NUMERIC)
    strict = hm.reduce(build().replacing({"output_shaft.stiffness": 100.0 * K_OUT}), torque=20.0, mode_tolerance=0.5 * error)
    assert not strict.valid


def test_it_is_good_up_to_where_the_transfers_part() -> None:
    result = hm.reduce(build(), torque=20.0, transfer_tolerance=0.05)
    difference = np.abs(result.reduced_transfer - result.full_transfer) / np.abs(result.full_transfer)
    below = result.frequency < result.good_to
    assert np.all(difference[below] <= 0.05)
    assert difference[~below][0] > 0.05
    # series springs: below resonance the error grows like  w^2 J_MR (c_full - c_reduced), so 5 % need w ~ sqrt(0.05/(J dc))
    extra = 1.0 / (RATIO**2 * K_IN) + 1.0 / K_OUT
    assert result.good_to == pytest.approx(math.sqrt(0.05 / (J_MR * extra)), rel=0.1)


def test_the_transfer_is_that_of_the_equations() -> None:
    # the reduced model by hand, on the output axis, with the motor's slope as damping and the flexspline's B_FS
    scene = build()
    result = hm.reduce(scene, torque=20.0)
    speed, step = result.settings["motor_speed"], 1e-3
    torque = scene.parts["motor"].characteristic.torque  # type: ignore[attr-defined]
    slope = -(torque(0.0, speed + step) - torque(0.0, speed - step)) / (2.0 * step)
    motor, machine = RATIO**2 * (J_S + J_IN + J_WG), J_FS + J_OUT + J_MR
    for k in (0, 1000, 1500):
        s = 1j * result.frequency[k]
        spring = 20.0 + K1 / s
        A = np.array([[motor * s + RATIO**2 * slope + spring, -spring], [-spring, machine * s + spring]])
        # torque 1 on the motor is u on the output axis
        by_hand = np.linalg.solve(A, [RATIO, 0.0])[1]
        assert result.reduced_transfer[k] == pytest.approx(by_hand, rel=1e-5)


def test_the_reduced_scene_carries_all_inertia_in_two_bodies() -> None:
    reduced = hm.with_rigid_shafts(build())
    inertias = {body.name: body.inertia for body in reduced.network().bodies}
    assert inertias == {"motor": pytest.approx(J_S + J_IN + J_WG), "load": pytest.approx(J_FS + J_OUT + J_MR)}
    assert hm.reduce(build(), torque=20.0).reduced_scene.network().bodies == reduced.network().bodies


def test_no_rest_of_the_rigid_body_motion_counts_as_a_mode() -> None:
    # at 130 N m numeric differentiation leaves 0.008 rad/s of an exact zero
    result = hm.reduce(build(), torque=130.0)
    assert len(result.reduced_undamped) == 1
    assert result.reduced_undamped[0] == pytest.approx(two_masses(11e4), rel=NUMERIC)


def test_what_cannot_be_reduced_is_refused_with_the_way_out() -> None:
    with pytest.raises(hm.AnalysisError, match="no shaft"):
        hm.reduce(hm.with_rigid_shafts(build()), torque=20.0)
    with pytest.raises(hm.AnalysisError, match=r"'backlash' acts on the twist of 'output_shaft'.*without\('backlash'\)"):
        hm.reduce(build().with_effect(hm.CouplingBacklash(backlash=1e-3), at="output_shaft", name="backlash"), torque=20.0)
    with pytest.raises(hm.AnalysisError, match="Give a torque that closes it"):
        hm.reduce(build(), torque=0.0)
    with pytest.raises(hm.ParameterError, match="mode_tolerance = 2"):
        hm.reduce(build(), mode_tolerance=2.0)


def test_a_reduction_is_saved_and_loaded_whole(tmp_path: Path) -> None:
    result = hm.reduce(build(), torque=20.0)
    copy = hm.load(result.save(tmp_path / "reduction.npz"))
    assert isinstance(copy, hm.Reduction)
    assert copy.reason == result.reason
    np.testing.assert_array_equal(copy.full_transfer, result.full_transfer)
    assert {len(column) for column in result.columns().values()} == {len(result.frequency)}
