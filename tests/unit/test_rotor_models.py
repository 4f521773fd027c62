"""The Jeffcott and the overhung rotor of models/ against closed forms and the book."""

from __future__ import annotations

import math

import numpy as np
import pytest

import hdrive_mbs as hm
from models import jeffcott, overhung
from tests.unit.rotor_pieces import eigenvalues, frequencies, steady

SOLVER = hm.Trapezoidal(step=2e-4, newton_tolerance=1e-6)


@pytest.mark.parametrize("bearing_stiffness", [1e8, 1e6])
def test_the_jeffcott_rotor_has_its_critical_speed(bearing_stiffness: float) -> None:
    system = steady(jeffcott.build(bearing_stiffness=bearing_stiffness))
    wanted = jeffcott.critical_speed(bearing_stiffness)
    found = frequencies(system, [name for name in system.names if name.endswith((".x", ".theta"))])
    # the rings move by k/2 k_b of the disc: w^2 falls by 2 m_ring (k/2 k_b)^2 / m
    rings = jeffcott.RING["mass"] / jeffcott.DISC.mass * (jeffcott.stiffness(bearing_stiffness) / (2.0 * bearing_stiffness)) ** 2
    # and by their moment of inertia, as the ends of the shaft tilt by 3 r/L: 2 Jt (3/L)^2/m
    tilts = jeffcott.RING["transverse_inertia"] / jeffcott.DISC.mass * (3.0 / jeffcott.SPAN) ** 2
    assert found[0] == pytest.approx(wanted * (1.0 - rings - tilts), rel=0.1 * (rings + tilts))


@pytest.mark.parametrize("ratio", [0.6, 1.0, 1.7])
def test_the_jeffcott_rotor_whirls_as_the_textbook_says(ratio: float) -> None:
    # r = e n^2 / sqrt((1 - n^2)^2 + (2 D n)^2), n = w/w0, after the start has died out by exp(-D w0 t) = exp(-15)
    damping, e = 0.2, 50e-6
    speed = ratio * jeffcott.critical_speed()
    scene = jeffcott.build(damping_ratio=damping, final_speed=speed)
    step = 5e-5
    response = hm.simulate(scene, 0.3, solver=hm.Trapezoidal(step=step, newton_tolerance=1e-6), initial_speed=speed)
    damping += 0.5e-6 * jeffcott.critical_speed()  # of the shaft, 1e-6 s
    wanted = e * ratio**2 / math.hypot(1.0 - ratio**2, 2.0 * damping * ratio)
    # rings and damping of the bearings change it by 1e-4; the trapezoidal rule sees w (1 + (w h)^2/12), which counts six times at n = 1.7
    assert response.values["disc.radial"][-1] == pytest.approx(wanted, rel=2e-4 + 0.5 * (speed * step) ** 2)
    # heavy side out below the critical speed, in above it
    mass_centre = response.values["disc.mass_centre_radial"][-1]
    lag = math.atan2(2.0 * damping * ratio, 1.0 - ratio**2)
    assert mass_centre == pytest.approx(abs(wanted * np.exp(-1j * lag) + e), rel=1e-3)


def test_the_jeffcott_rotor_runs_up_through_its_critical_speed_and_centres_itself() -> None:
    response = hm.simulate(jeffcott.build(), 1.9, solver=SOLVER)
    radial, speed = response.values["disc.radial"], response.values["disc.speed"]
    peak = int(np.argmax(radial))
    # a run-up peaks later and lower than the steady e/2D
    assert jeffcott.critical_speed() < speed[peak] < 1.3 * jeffcott.critical_speed()
    assert radial[peak] < 50e-6 / (2.0 * 0.03)
    ratio = speed[-1] / jeffcott.critical_speed()
    # what is left of the transient, exp(-D w0 t) over the second half of the run, is about a percent of the peak
    assert radial[-1] == pytest.approx(50e-6 * ratio**2 / (ratio**2 - 1.0), abs=0.02 * radial[peak])


def test_the_overhung_rotor_has_the_frequencies_of_the_book() -> None:
    system = steady(overhung.build(bearing_damping=0.0), 4000.0 * math.pi / 30.0)
    lateral = [name for name in system.names if name.endswith((".x", ".y", ".psi", ".theta"))]
    found = np.abs(eigenvalues(system, lateral).imag)
    for wanted in (76.19, 103.91, 565.99, 647.75, 1174.2):
        assert np.min(np.abs(found - wanted)) < 1e-4 * wanted, wanted


def test_the_overhung_rotor_runs_up_through_its_first_critical_speed() -> None:
    # without spin the mode is at 90.1 rad/s; gyroscopic moments lift the forward one, and a faster run-up peaks later and lower
    peaks = []
    for torque in (200.0, 100.0):
        response = hm.simulate(overhung.build(torque=torque), 140.0 / torque, solver=SOLVER)
        radial, speed = response.values["disc.radial"], response.values["disc.speed"]
        assert speed[-1] > 160.0
        peaks.append((speed[np.argmax(radial)], np.max(radial)))
    (fast, low), (slow, high) = peaks
    assert 90.2 < slow < fast < 130.0
    assert low < high


@pytest.mark.parametrize("build", [jeffcott.build, overhung.build])
def test_models_can_be_kept_in_a_file(build: object, tmp_path: object) -> None:
    scene = build()  # type: ignore[operator]
    assert hm.load_scene(hm.save_scene(scene, tmp_path / "model.toml")) == scene  # type: ignore[operator]
