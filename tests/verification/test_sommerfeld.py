"""Sommerfeld effect: a rigid disc captured at its critical speed by its own whirl, against an independent integration.

Disc of 2 kg, J = 0.5625 kg m^2 about its centre of mass, e = 1.48 mm, on 1600 N/m and 0.452548 N s/m, driven from rest by
a constant torque T.  ``reference_sommerfeld`` integrates the same three coordinates with scipy (DOP853).
"""

from __future__ import annotations

import functools
import math
import re

import numpy as np
import pytest

import hdrive_mbs as hm
from tests.verification.reference_sommerfeld import SpinUp, UnbalancedDisc, spin_up

DISC = UnbalancedDisc()
WEAK, STRONG = 0.15, 0.3
"""Torques [N m] well below and above the threshold."""

THRESHOLD = 0.1971
"""Torque [N m] that parts capture from passage: between 0.19703 and 0.19719 by bisection of ``spin_up(UnbalancedDisc(),
torque, end=160.0, tolerance=1e-9).passed``."""

END = {WEAK: 160.0, STRONG: 85.0}


def scene(torque: float) -> hm.Scene:
    """The rotor's polar inertia counts about its centre of mass; tilt and axial motion are held and never excited."""
    law = hm.LinearBearing.isotropic(
        radial=DISC.stiffness, damping=DISC.damping, axial=1600.0, axial_damping=1.0, tilt=500.0, tilt_damping=0.1
    )
    parts = {
        "drive": hm.DriveTorque(characteristic=hm.TorqueSpeedTable(speeds=(0.0, 1.0), torques=(torque, torque))),
        "disc": hm.Rotor(mass=DISC.mass, polar_inertia=DISC.inertia, transverse_inertia=0.5 * DISC.inertia, eccentricity=DISC.eccentricity),
        "bearing": hm.Bearing(law=law),
    }
    return hm.Scene(name="Sommerfeld's disc", parts=parts, connections=[("drive", "disc", "bearing")])


@functools.cache
def run(torque: float, accuracy: float = 1e-3) -> hm.RunUp:
    return hm.run_up(scene(torque), END[torque], accuracy=accuracy)


@functools.cache
def independent(torque: float) -> SpinUp:
    return spin_up(DISC, torque, end=END[torque], step=0.01, tolerance=1e-9, stop=False)


def test_a_weak_motor_gets_stuck_at_the_critical_speed() -> None:
    weak = run(WEAK)
    assert weak.captured
    assert not independent(WEAK).passed
    assert re.match(r"complete; captured: the speed stays at 28\.1\d* rad/s, 99\.\d+ % of the critical speed of 28\.284 rad/s", weak.status)
    # undamped critical speed sqrt(k/m)
    assert weak.critical_speeds == pytest.approx([DISC.critical_speed], rel=1e-9)
    # without whirl the constant torque would have driven it to T t/J
    assert WEAK * END[WEAK] / DISC.inertia > 1.5 * weak.final_speed
    assert weak.driven_speed == math.inf


def test_a_strong_motor_passes() -> None:
    strong = run(STRONG)
    assert not strong.captured
    assert independent(STRONG).passed
    assert strong.final_speed > 1.5 * DISC.critical_speed


@pytest.mark.parametrize("torque", [WEAK, STRONG])
def test_the_peak_agrees_with_the_independent_integration_within_the_accuracy_asked_for(torque: float) -> None:
    own, other = run(torque), independent(torque)
    # samples of 0.01 s: the whirl turns by 0.28 rad meanwhile, its distance changes by less than 1e-5 near the top
    top = int(np.argmax(other.distance))
    assert own.peak_amplitude["disc"] == pytest.approx(other.distance[top], rel=1e-3)
    # a captured disc nods about its speed with a period of 10 s and tops that hardly differ
    assert own.peak_time["disc"] == pytest.approx(other.times[top], abs=0.25)
    assert own.final_speed == pytest.approx(other.speed[-1], rel=1e-3)


@pytest.mark.parametrize("torque", [WEAK, STRONG])
def test_capture_and_passage_converge_with_the_step(torque: float) -> None:
    reference = independent(torque).distance.max()
    coarse, fine = (run(torque, accuracy=value) for value in (1e-3, 2.5e-4))
    assert coarse.captured == fine.captured == (torque == WEAK)
    errors = [abs(item.peak_amplitude["disc"] / reference - 1.0) for item in (coarse, fine)]
    # half the step: a quarter of the error (order 2), of which Newton's tolerance and the sampling of the reference blur some 1e-5
    assert errors[1] == pytest.approx(errors[0] / 4.0, abs=3e-5)


def test_the_captured_disc_settles_where_whirl_takes_the_whole_torque() -> None:
    weak = run(WEAK)
    # the steady balance c w |Z|^2 w = T w below the resonance, from the reference: 28.130 rad/s
    low, high = 27.0, DISC.largest_steady_torque()[0]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if DISC.steady_torque(middle) < WEAK else (low, middle)
    # it nods with a period of 10 s; over four swings the mean is off by some share of a swing of 0.1 rad/s
    mean = float(np.mean(weak.values["disc.speed"][weak.times > 120.0]))
    assert mean == pytest.approx(low, abs=0.02)
    # the last tenth is 1.6 swings, in which the torque swings by some 0.1 x J x 2 pi/10 s = 0.035 N m: 10 % of that is left
    assert weak.whirl_torque == pytest.approx(WEAK, abs=0.0035 + 1e-3)


@pytest.mark.parametrize("share", [0.997, 1.003])
def test_the_threshold_of_capture_is_that_of_the_independent_integration(share: float) -> None:
    # errors of 1e-3 in the amplitude are errors of some 1e-3 in the torque that is held
    own = hm.run_up(scene(share * THRESHOLD), 140.0)
    assert own.captured == (share < 1.0)
    # at a quarter of the error the bracket is narrower too
    fine = hm.run_up(scene((1.0 + 0.5 * (share - 1.0)) * THRESHOLD), 140.0, accuracy=2.5e-4)
    assert fine.captured == (share < 1.0)


def test_the_independent_integration_has_this_threshold() -> None:
    assert not spin_up(DISC, 0.997 * THRESHOLD, end=140.0, step=0.5, tolerance=1e-8).passed
    assert spin_up(DISC, 1.003 * THRESHOLD, end=140.0, step=0.5, tolerance=1e-8).passed
