"""Static torsion curves against closed forms."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from models.harmonic_drive_train import build

RATIO = 100.0
GAP = math.radians(9.0 / 60.0)
K1, K2, K3, T1, T2 = 3.2e4, 6.4e4, 11e4, 23.5, 98.0
K_IN, K_OUT = 1e4, 5.1913e4

ROUNDING = 1e-12
"""Angles of 1e-3 rad come from bisection down to the last bit; sums of a few of them."""


def gear_angle(torque: float) -> float:
    """Seed F (7)-(10), corrected, for torque >= 0."""
    angle = GAP / 2.0 + min(torque, T1) / K1
    angle += max(min(torque, T2) - T1, 0.0) / K2
    return angle + max(torque - T2, 0.0) / K3


def with_law(law: object, **changes: object) -> hm.Scene:
    return build().replacing({"gear.stiffness": law, **changes})


# -- one connection -----------------------------------------------------------------------------------


def test_table_1_of_seed_f_comes_out_at_the_gear() -> None:
    curve = hm.torsion(build(), [0.0, 23.5, 98.0, 137.0])
    # Table 1 prints 1.31, 2.04, 3.21, 3.56 e-3 rad
    np.testing.assert_allclose(np.round(1e3 * curve.angle, 2), [1.31, 2.04, 3.21, 3.56])
    np.testing.assert_allclose(curve.angle, [gear_angle(t) for t in curve.torque], rtol=ROUNDING)


def test_the_curve_is_odd_and_zero_torque_from_below_is_the_lower_edge() -> None:
    curve = hm.torsion(build(), [-0.0, -23.5, -98.0, -137.0])
    np.testing.assert_allclose(curve.angle, [-gear_angle(t) for t in (0.0, 23.5, 98.0, 137.0)], rtol=ROUNDING)
    assert curve.gap == pytest.approx((-GAP / 2.0, GAP / 2.0), rel=ROUNDING)
    assert curve.lost_motion == pytest.approx(GAP, rel=ROUNDING)


def test_the_automatic_curve_rises_and_holds_both_edges_of_the_gap_and_the_corners() -> None:
    curve = hm.torsion(build())
    assert np.all(np.diff(curve.torque) >= 0.0)
    assert np.all(np.diff(curve.angle) > 0.0)
    zero = curve.torque == 0.0
    np.testing.assert_allclose(curve.angle[zero], [-GAP / 2.0, GAP / 2.0], rtol=ROUNDING)
    assert {T1, T2, -T1, -T2} <= set(curve.torque)
    assert curve.torque[-1] == pytest.approx(1.4 * T2)
    np.testing.assert_allclose(curve.corner_torque, [T1, T2])
    np.testing.assert_allclose(curve.corner_angle, [gear_angle(T1), gear_angle(T2)], rtol=ROUNDING)


def test_the_tangent_stiffness_is_that_of_each_piece_on_the_side_of_growing_torque() -> None:
    curve = hm.torsion(build(), [0.0, 10.0, T1, 60.0, T2, 120.0, -10.0, -T1])
    np.testing.assert_allclose(curve.stiffness, [K1, K1, K2, K2, K3, K3, K1, K2])


def test_a_law_without_gap_has_one_zero_and_no_lost_motion() -> None:
    curve = hm.torsion(with_law(hm.CubicStiffness(linear=2e4, cubic=1e9)), largest_torque=50.0)
    assert np.sum(curve.torque == 0.0) == 1
    assert curve.gap == (0.0, 0.0)
    # M = a phi + d phi^3
    np.testing.assert_allclose(2e4 * curve.angle + 1e9 * curve.angle**3, curve.torque, atol=50.0 * ROUNDING)
    np.testing.assert_allclose(curve.stiffness, 2e4 + 3e9 * curve.angle**2, rtol=1e-7)


def test_below_the_torque_of_its_jump_the_jump_law_stands_at_the_edge_of_the_gap() -> None:
    law = hm.JumpTorqueStiffness(lost_motion=GAP, linear=1e4, cubic=0.0)
    assert law.edge_torque == pytest.approx(1e4 * GAP / 2.0)  # 13 N m
    curve = hm.torsion(with_law(law), [0.0, 5.0, 13.0, 20.0])
    np.testing.assert_allclose(curve.angle[:3], GAP / 2.0, rtol=ROUNDING)
    assert curve.angle[3] == pytest.approx(20.0 / 1e4, rel=ROUNDING)


def test_backlash_of_a_coupling_widens_the_gap() -> None:
    scene = build().with_effect(hm.CouplingBacklash(backlash=2e-3), at="gear")
    curve = hm.torsion(scene, [0.0, 23.5])
    # the law acts across the gap of the backlash: everything moves out by b/2
    np.testing.assert_allclose(curve.angle, [gear_angle(0.0) + 1e-3, gear_angle(23.5) + 1e-3], rtol=ROUNDING)
    assert curve.lost_motion == pytest.approx(GAP + 2e-3, rel=ROUNDING)


@pytest.mark.parametrize(
    ("effect", "at"),
    [
        (hm.KinematicError(amplitude=1e-4, order=2.0, phase=1.0), "gear.mesh"),
        (hm.MeshFriction(loss_factor=0.2, no_load=0.05), "gear"),
        (hm.CoulombStribeckFriction(coulomb=3.0), "load"),
    ],
    ids=["kinematic error", "mesh friction", "friction on a body"],
)
def test_what_is_not_elastic_leaves_the_curve_alone(effect: hm.Effect, at: str) -> None:
    scene = build().with_effect(effect, at=at)
    torques = [0.0, 10.0, 50.0, 120.0]
    np.testing.assert_allclose(hm.torsion(scene, torques).angle, hm.torsion(build(), torques).angle, rtol=ROUNDING)
    between = ("motor", "load")
    np.testing.assert_allclose(
        hm.torsion(scene, torques, between=between).angle, hm.torsion(build(), torques, between=between).angle, rtol=ROUNDING
    )


# -- a whole line ---------------------------------------------------------------------------------------


def test_the_line_adds_the_compliances_of_its_parts_on_the_output_axis() -> None:
    torques = [0.0, 10.0, 60.0, 137.0]
    curve = hm.torsion(build(), torques, between=("motor", "load"))
    expected = [t / (RATIO**2 * K_IN) + gear_angle(t) + t / K_OUT for t in torques]
    np.testing.assert_allclose(curve.angle, expected, rtol=ROUNDING)
    # tangent at 60 N m (second piece):  1/(1/(u^2 K_in) + 1/K2 + 1/K_out)
    assert curve.stiffness[2] == pytest.approx(1.0 / (1.0 / (RATIO**2 * K_IN) + 1.0 / K2 + 1.0 / K_OUT), rel=1e-9)
    np.testing.assert_allclose(sum(curve.parts.values()), curve.angle, rtol=ROUNDING)
    np.testing.assert_allclose(curve.parts["output_shaft"], np.array(torques) / K_OUT, rtol=ROUNDING, atol=1e-18)


def test_from_the_input_side_the_angle_is_u_times_larger_at_one_u_th_of_the_torque() -> None:
    torque = 0.6
    curve = hm.torsion(build(), [torque], between=("load", "motor"))
    assert curve.angle[0] == pytest.approx(torque / K_IN + RATIO * gear_angle(RATIO * torque) + RATIO**2 * torque / K_OUT, rel=ROUNDING)


def test_two_shafts_side_by_side_share_the_torque() -> None:
    # a closed loop: equilibrium alone does not decide;  T = (k1 + k2) angle
    parts = {
        "a": hm.Inertia(inertia=1.0),
        "left": hm.Shaft(stiffness=3e3),
        "right": hm.Shaft(stiffness=1e3),
        "b": hm.Inertia(inertia=1.0),
    }
    scene = hm.Scene(name="loop", parts=parts, connections=[("a", "left", "b"), ("a", "right", "b")])
    curve = hm.torsion(scene, [8.0], between=("a", "b"))
    assert curve.angle[0] == pytest.approx(8.0 / 4e3, rel=1e-9)
    assert curve.stiffness[0] == pytest.approx(4e3, rel=1e-9)


def test_a_housing_that_yields_adds_the_compliance_of_the_reaction() -> None:
    # the circular spline carries (1 + 1/u) T, so by the unit-load theorem it adds (1 + 1/u)^2 T/K_h
    nominal = build()
    parts = {**nominal.parts, "gear": nominal.parts["gear"].replacing(circular_spline_inertia=0.01), "housing": hm.Shaft(stiffness=2e5)}
    scene = hm.Scene(name="soft", parts=parts, connections=[*nominal.connections, ("gear.circular_spline", "housing", "ground")])
    torque = 50.0
    curve = hm.torsion(scene, [torque], between=("motor", "load"))
    rigid = hm.torsion(nominal, [torque], between=("motor", "load"))
    assert curve.angle[0] - rigid.angle[0] == pytest.approx((1.0 + 1.0 / RATIO) ** 2 * torque / 2e5, rel=1e-9)


# -- hysteresis ------------------------------------------------------------------------------------------


def test_a_law_with_hysteresis_asks_for_cycles() -> None:
    scene = build().with_effect(hm.BoucWenHysteresis(torque_limit=5.0, yield_twist=2e-4), at="gear")
    with pytest.raises(hm.AnalysisError, match=r"gear has hysteresis .*cycles=2.*scene.without"):
        hm.torsion(scene)
    with pytest.raises(hm.AnalysisError, match="ask at the connection"):
        hm.torsion(scene, between=("motor", "load"), cycles=2)
    with pytest.raises(hm.ParameterError, match="no hysteresis"):
        hm.torsion(build(), cycles=2)


def test_the_loop_of_a_slipping_spring_has_the_width_and_area_of_the_closed_form() -> None:
    # elastic law beside one sharp slider (k, L): it slips along both branches, so the loop crosses zero where the
    # elastic torque is -+L, and its area is that of the slider alone, 4 L (X - L/k) with the largest twist X
    stiffness, limit = 4e4, 4.0
    effect = hm.MaxwellSlipHysteresis(stiffness=(stiffness,), torque_limit=(limit,), rounding=0.0)
    curve = hm.torsion(build().with_effect(effect, at="gear"), cycles=1, largest_torque=100.0, points=801)
    largest = gear_angle(100.0 - limit)
    assert curve.torque.max() == pytest.approx(100.0, rel=1e-6)
    assert curve.angle.max() == pytest.approx(largest, rel=1e-6)
    assert curve.lost_motion == pytest.approx(2.0 * gear_angle(limit), rel=1e-4)
    # trapezoids over 800 steps of a loop with corners: each corner costs less than half the slider's torque
    # step L over one step of twist, and there are 8 of them
    corner = 8 * 0.5 * limit * np.max(np.abs(np.diff(curve.angle)))
    assert abs(curve.loss - 4.0 * limit * (largest - limit / stiffness)) < corner
    assert corner < 0.05 * curve.loss


# -- bad input ---------------------------------------------------------------------------------------------


def test_bad_questions_are_refused_with_the_way_out() -> None:
    scene = build()
    with pytest.raises(hm.PlaceError, match=r"No connection 'gaer'.*input_shaft, gear, output_shaft"):
        hm.torsion(scene, at="gaer")
    with pytest.raises(hm.PlaceError, match=r"No place 'arm'"):
        hm.torsion(scene, between=("motor", "arm"))
    with pytest.raises(hm.ParameterError, match="Give largest_torque"):
        hm.torsion(scene, at="output_shaft")
    with pytest.raises(hm.ParameterError, match="largest_torque = -3 N m"):
        hm.torsion(scene, largest_torque=-3.0)
    with pytest.raises(hm.ParameterError, match="finite"):
        hm.torsion(scene, [1.0, math.nan])
    with pytest.raises(hm.AnalysisError, match="is held itself"):
        hm.torsion(scene, between=("motor", "motor"))


def test_a_torque_that_the_law_never_reaches_is_refused() -> None:
    with pytest.raises(hm.AnalysisError, match=r"gear never reaches 20 N m"):
        hm.torsion(with_law(lambda twist: 10.0 * np.tanh(1e3 * twist)), [20.0])


def test_a_place_that_nothing_holds_is_refused() -> None:
    parts = {"a": hm.Inertia(inertia=1.0), "s": hm.Shaft(stiffness=1e3), "b": hm.Inertia(inertia=1.0)}
    parts |= {"c": hm.Inertia(inertia=1.0), "t": hm.Shaft(stiffness=1e3), "d": hm.Inertia(inertia=1.0)}
    scene = hm.Scene(name="apart", parts=parts, connections=[("a", "s", "b"), ("c", "t", "d")])
    with pytest.raises(hm.AnalysisError, match="'d' turns freely while 'a' is held"):
        hm.torsion(scene, [1.0], between=("a", "d"))


def test_a_law_that_falls_is_named_in_the_status() -> None:
    # rises to 10 N m at 1 mrad, falls to 8 N m at 2 mrad, rises again: 9.5 N m is first reached at 0.95 mrad, 20 N m after the jump
    points = ([-10e-3, -2e-3, -1e-3, 1e-3, 2e-3, 10e-3], [-56.0, -8.0, -10.0, 10.0, 8.0, 56.0])
    curve = hm.torsion(with_law(lambda twist: np.interp(twist, *points)), [9.5, 20.0])
    assert "falls with growing twist" in curve.status
    np.testing.assert_allclose(curve.angle, [0.95e-3, 4e-3], rtol=1e-9)


def test_a_curve_is_saved_and_loaded_whole(tmp_path: Path) -> None:
    curve = hm.torsion(build(), between=("motor", "load"))
    copy = hm.load(curve.save(tmp_path / "torsion.npz"))
    np.testing.assert_array_equal(copy.angle, curve.angle)  # type: ignore[attr-defined]
    assert {len(column) for column in curve.columns().values()} == {len(curve.torque)}
    header = curve.to_csv(tmp_path / "torsion.csv").read_text().splitlines()[0]
    assert header.startswith("torque [N m],angle [rad]")
