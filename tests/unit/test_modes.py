"""Modes at an operating point: closed forms, decay, growth, gaps."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from tests.verification.scenes import chain, train


def pendulum(inertia: float, stiffness: float, damping: float) -> hm.Scene:
    parts = {"disc": hm.Inertia(inertia=inertia), "shaft": hm.Shaft(stiffness=stiffness, damping=damping)}
    return hm.Scene(name="pendulum", parts=parts, connections=[("disc", "shaft", "ground")])


@pytest.mark.parametrize("ratio", [0.0, 0.01, 0.3, 0.999])
def test_a_damped_disc_against_the_ground_follows_the_closed_form(ratio: float) -> None:
    J, k = 0.02, 450.0
    w = math.sqrt(k / J)
    result = hm.modes(pendulum(J, k, 2.0 * ratio * math.sqrt(k * J)))
    assert result.undamped == pytest.approx([w], rel=1e-9)
    assert result.damped == pytest.approx([w * math.sqrt(1.0 - ratio**2)], rel=1e-6)
    assert result.damping_ratio == pytest.approx([ratio], rel=1e-9, abs=1e-12)
    assert (result.rigid_modes, len(result.decay_rates), result.stable, result.status) == (0, 0, True, "complete")


def test_an_overdamped_disc_decays_at_two_rates_and_does_not_oscillate() -> None:
    J, k, ratio = 0.02, 450.0, 2.5
    w = math.sqrt(k / J)
    result = hm.modes(pendulum(J, k, 2.0 * ratio * math.sqrt(k * J)))
    assert len(result.damped) == 0
    root = math.sqrt(ratio**2 - 1.0)
    assert result.decay_rates == pytest.approx([w * (ratio - root), w * (ratio + root)], rel=1e-9)
    assert result.undamped == pytest.approx([w], rel=1e-9)


def test_a_free_rotor_with_drag_has_one_rigid_motion_and_the_rate_of_its_drag() -> None:
    rotor = hm.Scene(name="rotor", parts={"rotor": hm.Inertia(inertia=2.0, viscous=3.0)}, connections=[])
    result = hm.modes(rotor)
    assert (len(result.undamped), len(result.damped), result.rigid_modes) == (0, 0, 1)
    assert result.decay_rates == pytest.approx([1.5], rel=1e-9)


def test_the_slope_of_a_motor_counts_as_damping() -> None:
    # M = 2 - 0.4 w on J = 0.1: dw decays at 0.4/0.1
    rotor = hm.Scene(name="rotor", parts={"motor": hm.Motor(inertia=0.1, characteristic=lambda w: 2.0 - 0.4 * w)}, connections=[])
    result = hm.modes(rotor)
    assert result.motor_speed == pytest.approx(5.0, rel=1e-12)
    assert result.decay_rates == pytest.approx([4.0], rel=1e-6)


def test_two_and_three_inertias_follow_their_closed_forms() -> None:
    i_1, i_2, i_3, k_1, k_2 = 0.5, 1.5, 0.25, 200.0, 900.0
    two = hm.modes(chain([i_1, i_2], [k_1]))
    assert two.undamped == pytest.approx([math.sqrt(k_1 * (1.0 / i_1 + 1.0 / i_2))], rel=1e-9)
    assert two.shapes[:, 0] == pytest.approx([1.0, -i_1 / i_2], rel=1e-9)
    three = hm.modes(chain([i_1, i_2, i_3], [k_1, k_2]))
    # x^2 - (k1/I1 + (k1 + k2)/I2 + k2/I3) x + k1 k2 (I1 + I2 + I3)/(I1 I2 I3) = 0 for x = w^2
    b = k_1 / i_1 + (k_1 + k_2) / i_2 + k_2 / i_3
    c = k_1 * k_2 * (i_1 + i_2 + i_3) / (i_1 * i_2 * i_3)
    assert three.undamped**2 == pytest.approx(sorted(np.roots([1.0, -b, c])), rel=1e-9)
    for k, w in enumerate(three.undamped):  # each disc's own equation, from one end to the other
        q_1, q_2, q_3 = three.shapes[:, k]
        assert (k_1 - i_1 * w**2) * q_1 == pytest.approx(k_1 * q_2, rel=1e-6)
        assert (k_2 - i_3 * w**2) * q_3 == pytest.approx(k_2 * q_2, rel=1e-6)
    assert (two.rigid_modes, three.rigid_modes) == (1, 1)


def test_a_prescribed_motor_holds_its_end() -> None:
    parts = {
        "motor": hm.Motor(inertia=1.0, characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=3.0))),
        "shaft": hm.Shaft(stiffness=50.0),
        "disc": hm.Inertia(inertia=2.0),
    }
    result = hm.modes(hm.Scene(name="driven", parts=parts, connections=[("motor", "shaft", "disc")]))
    assert result.bodies == ("disc",)
    assert result.undamped == pytest.approx([5.0], rel=1e-9)
    assert result.rigid_modes == 0


def test_shapes_are_in_true_sense_with_their_largest_entry_one() -> None:
    result = hm.modes(train(), torque=50.0)
    for shapes in (result.shapes, result.damped_shapes):
        assert np.max(np.abs(shapes), axis=0) == pytest.approx(np.ones(shapes.shape[1]))
    # the lowest mode winds the input against the output: forward twist +, and the output counts backwards
    first = dict(zip(result.bodies, result.shapes[:, 0], strict=True))
    assert first["motor"] == pytest.approx(1.0)
    assert first["load"] > 0.0  # forward negative, true sense turned by the gear


# -- what the status says -----------------------------------------------------------------------------


def test_an_open_gap_is_a_second_rigid_motion_and_is_named() -> None:
    result = hm.modes(train(), torque=0.0, motor_speed=0.0)
    assert result.rigid_modes == 2
    assert result.status == "complete; gear is inside its lost motion or backlash: stiffness 0 there"
    loaded = hm.modes(train(), torque=10.0, motor_speed=0.0)
    assert (loaded.rigid_modes, loaded.status) == (1, "complete")
    assert len(loaded.undamped) == len(result.undamped) + 1


def test_at_a_corner_of_the_law_the_modes_are_those_of_larger_twist_and_the_status_says_so() -> None:
    result = hm.modes(train(), torque=23.5, motor_speed=0.0)
    assert result.status == "complete; gear sits at a corner of its law: the stiffness towards larger twist is taken"
    above = hm.modes(train(), torque=24.5, motor_speed=0.0)
    below = hm.modes(train(), torque=22.5, motor_speed=0.0)
    np.testing.assert_allclose(result.undamped, above.undamped, rtol=1e-6)
    assert np.all(below.undamped < above.undamped)


def test_a_hanging_arm_swings_and_a_standing_one_is_statically_unstable() -> None:
    # small swing: w^2 = m g r / J
    arm = hm.EccentricLoad(mass=2.0, radius=0.3, gravity=10.0)
    J = 0.5
    rotor = hm.Scene(name="arm", parts={"arm": hm.Inertia(inertia=J)}, connections=[])
    hanging = hm.modes(rotor.with_effect(arm, at="arm"))
    assert hanging.undamped == pytest.approx([math.sqrt(2.0 * 10.0 * 0.3 / J)], rel=1e-6)
    assert (hanging.stable, hanging.rigid_modes) == (True, 0)
    standing = hm.modes(rotor.with_effect(arm.replacing(start_angle=math.pi), at="arm"))
    assert len(standing.undamped) == 0
    assert standing.status.endswith("statically unstable: a stiffness is negative there, and a motion grows")
    assert not standing.stable
    assert standing.decay_rates == pytest.approx([-math.sqrt(12.0), math.sqrt(12.0)], rel=1e-6)


def test_negative_damping_is_told_from_positive() -> None:
    # a motor whose torque rises with speed, on a shaft to a heavy disc: the mode grows
    def scene(slope: float) -> hm.Scene:
        parts: dict[str, Any] = {"motor": hm.Motor(inertia=0.1, characteristic=lambda w: slope * w), "s": hm.Shaft(stiffness=90.0)}
        return hm.Scene(name="x", parts=parts | {"disc": hm.Inertia(inertia=100.0)}, connections=[("motor", "s", "disc")])

    growing, decaying = (hm.modes(scene(slope), motor_speed=0.0) for slope in (0.2, -0.2))
    # heavy disc: zeta = -slope/(2 sqrt(k J)) = -+1/30, to about J/100 of it
    assert growing.damping_ratio == pytest.approx([-1.0 / 30.0], rel=0.01)
    assert decaying.damping_ratio == pytest.approx([1.0 / 30.0], rel=0.01)
    assert (growing.stable, decaying.stable) == (False, True)


def test_a_relaxing_state_has_its_own_decay_rate() -> None:
    # current loop: lag dM/dt + M = command, command = kp (w_ref - w) + ki I
    J, lag, kp, ki = 0.01, 2e-3, 0.5, 10.0
    motor = hm.ServoMotor(
        torque_limit=50.0, current_lag=lag, proportional_gain=kp, integral_gain=ki, reference=hm.ConstantSpeed(value=20.0)
    )
    result = hm.modes(hm.Scene(name="servo", parts={"motor": hm.Motor(inertia=J, characteristic=motor)}, connections=[]))
    # J s (lag s + 1) s + kp s + ki = 0 of (I, w, M)
    roots = np.roots([J * lag, J, kp, ki])
    oscillating = roots[roots.imag > 1e-9]
    assert result.damped == pytest.approx(oscillating.imag, rel=1e-5)
    assert result.damping_ratio == pytest.approx(-oscillating.real / np.abs(oscillating), rel=1e-5)
    assert result.decay_rates == pytest.approx(-roots[np.abs(roots.imag) <= 1e-9].real, rel=1e-5)


def test_modes_know_where_they_were_taken() -> None:
    result = hm.modes(train(), torque=50.0, motor_speed=100.0)
    assert result.motor_speed == 100.0
    assert result.torques["gear"] == pytest.approx(50.0, rel=1e-6)
    assert result.scene == train().replacing({"load.torque": hm.ConstantTorque(value=50.0)})
    columns = result.columns()
    np.testing.assert_array_equal(columns["undamped [rad/s]"], result.undamped)
