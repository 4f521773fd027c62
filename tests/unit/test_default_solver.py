"""The solver that is taken when none is given: adaptive for trains, a chosen step for rotor lines."""

from __future__ import annotations

import math

import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.default_solver import default_solver
from models.harmonic_drive_train import build as train
from models.jeffcott import build as jeffcott


def test_a_train_is_integrated_adaptively() -> None:
    assert default_solver(train().network(), 1.0, 0.0).solver == hm.DormandPrince()


def test_the_step_of_a_rotor_line_belongs_to_its_highest_speed() -> None:
    network = jeffcott().network()
    slow, fast = (default_solver(network, 1.0, speed).solver for speed in (2000.0, 4000.0))
    assert isinstance(slow, hm.Trapezoidal)
    assert isinstance(fast, hm.Trapezoidal)
    # (w h)^2/2 = 1e-3, rounded to a whole number of steps; nothing brakes the free spin
    assert fast.step == pytest.approx(math.sqrt(2e-3) / 4000.0, rel=0.01)
    assert slow.step == pytest.approx(2.0 * fast.step, rel=0.01)


def test_a_line_at_rest_takes_its_step_from_its_natural_frequencies() -> None:
    # a mass on springs: w = sqrt(k/m)
    bearing = hm.Bearing(law=hm.LinearBearing.isotropic(radial=4e6, damping=0.0, axial=4e6, tilt=1e5))
    rotor = hm.Rotor(mass=1.0, polar_inertia=0.02, transverse_inertia=0.0125)
    scene = hm.Scene(name="at rest", parts={"rotor": rotor, "bearing": bearing}, connections=[("bearing", "rotor")])
    solver = default_solver(scene.network(), 0.1, 0.0).solver
    assert isinstance(solver, hm.Trapezoidal)
    # x, y, z at 2000 rad/s and the tilts at sqrt(1e5/0.0125) = 2828 rad/s: the fourth of them counts
    assert solver.step == pytest.approx(math.sqrt(2e-3) / math.sqrt(1e5 / 0.0125), rel=0.01)


def test_simulate_takes_it() -> None:
    response = hm.simulate(jeffcott(), 0.05)
    assert response.settings["solver"].startswith("Trapezoidal")
