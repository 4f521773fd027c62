"""Torsional Campbell diagrams: branches followed through crossings, critical speeds, gaps."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import hdrive_mbs as hm
from hdrive_mbs.errors import HdriveError, ParameterError, PlaceError

# A: a prescribed motor, a gear whose torque is k x + k3 x^3, and a load c w^2 (w: speed of the load).
# One degree of freedom: w_A^2 = (k + 3 k3 x^2)/J with k x + k3 x^3 = c (Omega/u)^2.
U, K, K3, J, C = 10.0, 2.0e3, 6.0e8, 0.5, 1.5
# B: a disc on a shaft to the ground, of another train: w_B is constant and crosses w_A.
J_B, K_B = 0.02, 250.0
W_B = math.sqrt(K_B / J_B)


def two_trains(stiffness: Any = None) -> hm.Scene:
    parts = {
        "motor": hm.Motor(inertia=1e-3, characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=1.0))),
        "gear": hm.HarmonicDrive(ratio=U, stiffness=stiffness or (lambda twist: K * twist + K3 * twist**3), damping=1.0),
        "load": hm.Load(inertia=J, torque=hm.QuadraticLoad(coefficient=C)),
        "disc": hm.Inertia(inertia=J_B),
        "spring": hm.Shaft(stiffness=K_B),
    }
    return hm.Scene(name="two trains", parts=parts, connections=[("motor", "gear", "load"), ("disc", "spring", "ground")])


def twist(speed: float) -> float:
    torque = C * (speed / U) ** 2
    return float(brentq(lambda x: K * x + K3 * x**3 - torque, 0.0, 1.0, xtol=1e-16)) if torque else 0.0


def frequency_a(speed: float) -> float:
    return math.sqrt((K + 3.0 * K3 * twist(speed) ** 2) / J)


SPEEDS = np.linspace(0.0, 300.0, 31)


def test_branches_are_followed_by_their_shapes_where_they_cross() -> None:
    result = hm.torsional_campbell(two_trains(), SPEEDS)
    a = np.array([frequency_a(speed) for speed in SPEEDS])
    assert a[0] < W_B < a[-1], "the branches must cross within the speeds"
    # 1e-6: Exudyn differentiates the law by differences
    np.testing.assert_allclose(result.frequencies[:, 0], a, rtol=1e-6)
    np.testing.assert_allclose(result.frequencies[:, 1], W_B, rtol=1e-9)
    assert result.status == "complete"


def test_damping_belongs_to_its_branch_on_both_sides_of_the_crossing() -> None:
    result = hm.torsional_campbell(two_trains(), SPEEDS)
    # branch A: gear damping 1 along the twist, and the slope 2 c w of the load
    damping = 1.0 + 2.0 * C * SPEEDS / U
    np.testing.assert_allclose(result.damping_ratios[:, 0], damping / (2.0 * J * result.frequencies[:, 0]), rtol=1e-5)
    np.testing.assert_allclose(result.damping_ratios[:, 1], 0.0, atol=1e-9)


def test_orders_cross_the_branches_at_the_speeds_of_the_closed_form() -> None:
    result = hm.torsional_campbell(two_trains(), SPEEDS, orders={"motor": (0.5, 3.0), "load": (8.0,)})
    assert result.order_numbers == (0.5, 3.0, 8.0)
    assert result.order_places == ("motor", "motor", "load")
    assert result.order_slopes == pytest.approx((0.5, 3.0, 8.0 / U))
    found = {
        (order, branch): speed
        for speed, order, branch in zip(result.critical_speeds, result.critical_orders, result.critical_branches, strict=True)
    }
    assert list(result.critical_speeds) == sorted(result.critical_speeds)
    # the level branch is met at w_B / slope; that is exact
    assert found.pop((0, 1)) == pytest.approx(W_B / 0.5, rel=1e-9)
    assert found.pop((1, 1)) == pytest.approx(W_B / 3.0, rel=1e-9)
    assert found.pop((2, 1)) == pytest.approx(W_B / (8.0 / U), rel=1e-9)
    # the bent one is interpolated linearly between speeds h apart: error below h^2/8 |w''| / |slope - w'|
    root = brentq(lambda speed: 3.0 * speed - frequency_a(speed), 100.0, 300.0)
    h, d = SPEEDS[1] - SPEEDS[0], 1.0
    first = (frequency_a(root + d) - frequency_a(root - d)) / (2.0 * d)
    second = (frequency_a(root + d) - 2.0 * frequency_a(root) + frequency_a(root - d)) / d**2
    assert found.pop((1, 0)) == pytest.approx(root, abs=1.1 * h**2 / 8.0 * abs(second) / abs(3.0 - first))
    assert not found


def test_a_crossing_at_a_speed_of_the_grid_is_found_once_also_at_its_ends() -> None:
    grid = np.array([W_B, 1.5 * W_B, 2.0 * W_B])  # above the crossing: the level branch is the lower one
    result = hm.torsional_campbell(two_trains(), grid, orders={"motor": (1.0, 0.5, 1.0 / 1.5)})
    assert [(order, branch) for order, branch in zip(result.critical_orders, result.critical_branches, strict=True)] == [
        (0, 0),
        (2, 0),
        (1, 0),
    ]
    np.testing.assert_allclose(result.critical_speeds, grid, rtol=1e-9)


def test_running_backwards_meets_the_orders_at_the_same_speeds() -> None:
    forward = hm.torsional_campbell(two_trains(), SPEEDS, orders={"motor": (0.5, 3.0)})
    backward = hm.torsional_campbell(two_trains(), -SPEEDS[::-1], orders={"motor": (0.5, 3.0)})
    np.testing.assert_allclose(-backward.critical_speeds[::-1], forward.critical_speeds, rtol=1e-6)


def test_by_default_the_first_two_orders_of_the_motor_are_drawn() -> None:
    result = hm.torsional_campbell(two_trains(), [50.0, 60.0])
    assert (result.order_numbers, result.order_places) == ((1.0, 2.0), ("motor", "motor"))


def test_a_branch_that_a_gap_takes_away_is_not_a_number_there() -> None:
    law = hm.PiecewiseLinearStiffness(lost_motion=1e-3, stiffness_1=2e3, stiffness_2=4e3, stiffness_3=8e3, torque_1=20.0, torque_2=200.0)
    result = hm.torsional_campbell(two_trains(law), [0.0, 50.0, 200.0])
    column = int(np.argmax(np.isnan(result.frequencies[0])))
    assert np.isnan(result.frequencies[0]).sum() == 1
    # torque c (Omega/u)^2 = 37.5 and 600 N m: on the second and on the third piece
    np.testing.assert_allclose(result.frequencies[1:, column], [math.sqrt(4e3 / J), math.sqrt(8e3 / J)], rtol=1e-6)
    np.testing.assert_allclose(result.frequencies[:, 1 - column], W_B, rtol=1e-9)
    assert result.status == "complete; gear is inside its lost motion or backlash: stiffness 0 there"


def test_a_torque_driven_train_has_the_modes_of_each_speed() -> None:
    scene = two_trains().replacing({"motor.characteristic": lambda w: 5.0 - 0.01 * w})
    result = hm.torsional_campbell(scene, [50.0, 150.0])
    for row, speed in enumerate((50.0, 150.0)):
        single = hm.modes(scene, motor_speed=speed)
        np.testing.assert_allclose(np.sort(result.frequencies[row]), single.undamped, rtol=1e-9)


# -- arguments --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "kind", "message"),
    [
        ({"speeds": [1.0, 2.0, 2.0]}, ParameterError, r"speeds: give at least two motor speeds \[rad/s\] in increasing order"),
        ({"speeds": [2.0, 1.0]}, ParameterError, r"increasing order"),
        ({"speeds": [1.0]}, ParameterError, r"at least two"),
        ({"speeds": []}, ParameterError, r"at least two"),
        ({"speeds": 5.0}, ParameterError, r"at least two"),
        ({"speeds": [[1.0, 2.0], [3.0, 4.0]]}, ParameterError, r"at least two"),
        ({"speeds": [1.0, math.nan]}, ParameterError, r"increasing order"),
        ({"speeds": [1.0, math.inf]}, ParameterError, r"increasing order"),
        ({"speeds": ["slow", "fast"]}, ParameterError, r"at least two"),
        ({"orders": {"gaer": (1,)}}, PlaceError, r"No place 'gaer'\. This scene has: motor, .*load"),
        ({"orders": {"motor": (0,)}}, ParameterError, r"orders of 'motor' = \(0,\): each must be a number greater than 0"),
        ({"orders": {"motor": (1, -2)}}, ParameterError, r"orders of 'motor'"),
        ({"orders": {"motor": (math.nan,)}}, ParameterError, r"orders of 'motor'"),
        ({"orders": [1, 2]}, ParameterError, r"must name places, like \{'motor': \(1, 2\)\}"),
    ],
)
def test_a_bad_argument_is_refused(arguments: dict[str, Any], kind: type[HdriveError], message: str) -> None:
    with pytest.raises(kind, match=message):
        hm.torsional_campbell(two_trains(), **({"speeds": [1.0, 2.0]} | arguments))
