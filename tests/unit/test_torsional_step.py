"""Torsional vibration that a torque step excites: the chosen step follows it, or the status says that it does not."""

from __future__ import annotations

import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.torsional_step import OF_SPEEDS, torsional_step
from hdrive_mbs.analysis.turning_alone import TurningAlone

PULLEY, WHEEL, TORQUE = 1e-3, 0.2, 60.0
DIAMETER, LENGTH, SHEAR_MODULUS = 0.03, 0.4, 8.1e10
STIFFNESS = SHEAR_MODULUS * math.pi * DIAMETER**4 / 32.0 / LENGTH
FREQUENCY = math.sqrt(STIFFNESS * (1.0 / PULLEY + 1.0 / WHEEL))
DURATION = 0.3


def line(damping: float = 0.0, torque: float = TORQUE, radial: float = 1e7) -> hm.Scene:
    """A light pulley and a heavy wheel on a shaft, driven by a torque that is there at once."""
    bearing = hm.Bearing(law=hm.LinearBearing.isotropic(radial=radial, damping=500.0, axial=1e7, tilt=1e2))
    return hm.rotor_line(
        "fan",
        stations={
            "pulley": (0.0, hm.Rotor(mass=1.0, polar_inertia=PULLEY, transverse_inertia=6e-4)),
            "wheel": (LENGTH, hm.Rotor(mass=10.0, polar_inertia=WHEEL, transverse_inertia=0.12, eccentricity=1e-5)),
        },
        attached={"left": ("pulley", bearing), "right": ("wheel", bearing)},
        shaft=DIAMETER,
        material=hm.ShaftMaterial(youngs_modulus=2.1e11, shear_modulus=SHEAR_MODULUS, damping=damping),
        parts={"drive": hm.DriveTorque(characteristic=hm.TorqueHistory(times=(0.0, 1e3), torques=(torque, torque)))},
        connections=[("drive", "pulley")],
    )


def speeds(times: np.ndarray, delta: float = 0.0) -> np.ndarray:
    """Two inertias, a torque on the first: mean motion, and a vibration that begins with the torque.

    damping delta = c/2 (1/J1 + 1/J2); the twist q obeys q'' + 2 delta q' + w^2 q = T/J1, whose rate from rest is
    T/(J1 w_d) exp(-delta t) sin(w_d t), of which the pulley has the share J2/(J1 + J2).
    """
    damped = math.sqrt(FREQUENCY**2 - delta**2)
    twist = TORQUE / PULLEY / damped * np.exp(-delta * times) * np.sin(damped * times)
    return TORQUE * times / (PULLEY + WHEEL) + WHEEL / (PULLEY + WHEEL) * twist


def test_the_step_of_a_run_up_is_cut_for_a_torque_step_and_the_speed_is_that_of_the_closed_form() -> None:
    damping = 2e-6
    delta = 0.5 * damping * FREQUENCY**2  # c = damping k
    run = hm.run_up(line(damping), DURATION)
    error = np.max(np.abs(run.values["pulley.speed"] - speeds(run.times, delta)))
    assert error <= 1e-3 * OF_SPEEDS * np.max(run.values["pulley.speed"])
    assert "cut to 1/" in run.settings["step"]
    assert "the speed of pulley would be off by" in run.settings["step"]
    assert "torsional" not in run.status
    # without the cut it is not: the same line with the step that its whirl asks for
    steps = int(run.settings["step"].partition("cut to 1/")[2].partition(",")[0])
    rough = hm.run_up(line(damping), DURATION, solver=hm.Trapezoidal(step=steps * DURATION / run.steps))
    assert np.max(np.abs(rough.values["pulley.speed"] - speeds(rough.times, delta))) > 5.0 * error


def test_what_no_step_follows_is_said_and_by_how_much() -> None:
    # undamped, the phase drifts by w t (w h)^2/12 until the vibration is as wrong as it is large, and on
    run = hm.run_up(line(), 20.0 * DURATION)
    assert "torsional vibration is too quick for the step" in run.status
    said = float(run.status.partition("would be off by ")[2].partition(" rad/s")[0])
    error = float(np.max(np.abs(run.values["pulley.speed"] - speeds(run.times))))
    assert said == pytest.approx(error, rel=0.5)  # out of phase it is twice the size of the vibration at most, in phase with luck nothing
    # the same line under a torque that hardly moves it: the vibration is there, and too small to matter
    gentle = hm.run_up(line(torque=1e-3), 0.1, initial_speed=100.0)
    assert "torsional" not in gentle.status
    assert "cut to" not in gentle.settings["step"]


def test_simulate_takes_the_cut_step_too_and_warns_where_none_is_short_enough() -> None:
    response = hm.simulate(line(2e-6), DURATION)
    delta = 1e-6 * FREQUENCY**2
    assert np.max(np.abs(response.values["pulley.speed"] - speeds(response.times, delta))) <= 4e-3 * np.max(response.values["pulley.speed"])
    with pytest.warns(hm.CoarseStepWarning, match=r"too quick for the step"):
        long = hm.simulate(line(radial=1e4), 20.0 * DURATION)
    assert "the speed of pulley would be off by" in long.status


def test_a_step_that_does_is_left_alone() -> None:
    turning = TurningAlone(line(2e-6).network(), DURATION, 0.0)
    fine = torsional_step(turning, 1e-6, 4e-3, 1e-9)
    assert (fine.step, fine.reason, fine.remark) == (1e-6, "", "")


def test_the_error_of_the_step_is_of_order_two_and_that_of_the_closed_form() -> None:
    turning = TurningAlone(line(2e-6).network(), DURATION, 0.0)
    found = []
    for steps in (30_000, 60_000):
        times, values = turning.speeds(steps, 1e-10)
        found.append(float(np.max(np.abs(values["pulley"] - speeds(times, 1e-6 * FREQUENCY**2)))))
    assert found[0] / found[1] == pytest.approx(4.0, rel=0.05)
