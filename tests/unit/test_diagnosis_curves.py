"""Curves for pictures of a diagnosis: orders stand where they are, loops have the width they have."""

from __future__ import annotations

import numpy as np
import pytest

from hdrive_mbs.diagnosis.curves import loop_of, order_map

TIMES = 5e-4 * np.arange(8001)


def test_an_order_in_a_residual_stands_at_its_order_with_its_amplitude_at_every_speed() -> None:
    angle = 20.0 * TIMES + 0.5 * 60.0 * TIMES**2  # from 20 to 260 rad/s in 4 s
    before = 3e-5 * np.sin(2.0 * angle + 0.3)
    after = 1e-6 * np.sin(2.0 * angle + 0.3)
    found = order_map("run_up", "motor_angle", "rad", "motor", TIMES, angle, before, after)
    assert found is not None
    peaks = found.orders[np.argmax(found.before, axis=1)]
    assert np.all(np.abs(peaks - 2.0) < 0.05)
    # a Hann window padded four times reads a line between its own at most 1 % low
    assert np.max(found.before, axis=1) == pytest.approx(np.full(len(found.speeds), 3e-5), rel=0.02)
    assert np.max(found.after) == pytest.approx(1e-6, rel=0.02)
    assert found.orders.max() <= 12.0
    assert np.all(np.diff(found.speeds) > 0.0)
    assert 20.0 < found.speeds[0] < found.speeds[-1] < 260.0


def test_gaps_count_as_zero_and_a_missing_model_as_nothing() -> None:
    angle = 100.0 * TIMES + 2.0 * TIMES**2
    residual = np.where((TIMES > 1.0) & (TIMES < 1.1), np.nan, 1e-5 * np.sin(angle))
    found = order_map("r", "c", "rad", "motor", TIMES, angle, residual)
    assert found is not None
    assert np.isfinite(found.before).all()
    assert np.isnan(found.after).all()


def test_a_shaft_that_hardly_turns_has_no_order_map() -> None:
    assert order_map("r", "c", "rad", "motor", TIMES, 0.5 * np.sin(TIMES), np.sin(TIMES)) is None


def test_the_measured_loop_is_the_refitted_one_with_the_unknown_torque() -> None:
    twist = 1e-3 * np.sin(3.0 * TIMES)
    rate = 3e-3 * np.cos(3.0 * TIMES)
    spring, lost = 3e4 * twist, 2.0 * np.sign(rate)
    loop = loop_of("r", "gear", (twist, spring), (twist, spring + lost), lost)
    assert loop.measured.shape == (2, 2667)  # every third of 8001 points
    assert np.array_equal(loop.measured, loop.effect)
    # energy lost in a whole turn of the loop: 4 a T with amplitude a = 1 mrad and T = 2 N m
    whole = round(2.0 * np.pi / 3.0 / 5e-4 / 3) + 1
    x, y = loop.measured[:, :whole]
    assert np.sum(0.5 * (y[1:] + y[:-1]) * np.diff(x)) == pytest.approx(4.0 * 1e-3 * 2.0, rel=0.01)


def test_a_loop_without_a_latent_force_has_no_measured_curve() -> None:
    twist = 1e-3 * np.sin(TIMES)
    loop = loop_of("r", "gear", (twist, twist), None, None)
    assert loop.measured.size == loop.effect.size == 0
