"""Every bearing law under a running rotor: on the engine, and in scipy (rotor_on_two_bearings.py)."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.linearisation import linearise
from tests.contracts.test_bearings import laws_of_package
from tests.verification.rotor_on_two_bearings import (
    BALLS,
    DURATION,
    FRICTION,
    LAWS,
    SITUATIONS,
    SLIDING,
    SPEED,
    Equations,
    Situation,
    channel,
    scene,
)


def shown(label: str, values: np.ndarray, times: np.ndarray) -> np.ndarray:
    """A history as it is compared: of the spin, what is left beside the steady spin."""
    if label.endswith(".speed"):
        return values - SPEED
    return values - SPEED * times if label.endswith(".angle") else values


def differences(law: hm.BearingLaw, situation: Situation) -> dict[str, float]:
    """Largest difference of each coordinate, rate and bearing force over its largest value."""
    equations = Equations(law, situation)
    sliding = {f"{station}.z_rate": SLIDING for station in equations.stations}
    solver = hm.RungeKutta4(step=8e-6)
    response = hm.simulate(scene(law, situation), DURATION, solver=solver, initial_speed=SPEED, initial=sliding, progress=False)
    assert "python" not in response.lowering.values()
    every = slice(None, None, 8)
    times = response.times[every]
    rows = equations.history(times)
    q, v = np.split(rows, 2, axis=1)
    wanted = {channel(label, rate): u[:, k] for rate, u in ((False, q), (True, v)) for k, label in enumerate(equations.labels)}
    for bearing, place in equations.places.items():
        forces = np.array([equations.force(place @ a, place @ b) for a, b in zip(q, v)])
        wanted |= {f"{bearing}.force_{axis}": forces[:, k] for k, axis in enumerate("xy")}
    result = {}
    for name, values in wanted.items():
        theirs, ours = (shown(name, item, times) for item in (values, response.values[name][every]))
        result[name] = float(np.max(np.abs(ours - theirs)) / np.max(np.abs(theirs)))
    return result


LIMIT = 1e-4
"""Runge-Kutta of order 4 at 8e-6 s leaves up to 1e-5 (1e-6 where laws are smooth), scipy at 1e-8 a step up to 4e-5: a
journal at rest in the middle of its bearing has a force that is not smooth."""


@pytest.mark.slow
@pytest.mark.parametrize("housed", [name for name, situation in SITUATIONS.items() if situation.housed or situation.merged is None])
@pytest.mark.parametrize("name", LAWS)
def test_rotor_on_each_bearing_follows_the_equations_in_scipy(name: str, housed: str) -> None:
    worst = differences(LAWS[name], SITUATIONS[housed])
    assert max(worst.values()) < LIMIT, worst


@pytest.mark.parametrize("merged", ["merged", "merged at a distance"])
def test_rotor_merged_with_a_bearing_on_the_ground_follows_the_equations_in_scipy(merged: str) -> None:
    worst = differences(LAWS["power"], SITUATIONS[merged])
    assert max(worst.values()) < LIMIT, worst


# -- no Python in the loop -----------------------------------------------------------------------------


def test_every_law_of_the_package_is_here() -> None:
    assert {type(law) for law in LAWS.values()} == set(laws_of_package())


@pytest.mark.parametrize("situation", SITUATIONS)
@pytest.mark.parametrize("friction", [False, True], ids=["", "with friction"])
def test_no_built_in_bearing_needs_a_python_callback(friction: bool, situation: str) -> None:
    for name, law in LAWS.items():
        laid = hm.WithFriction(law=law, **FRICTION) if friction else law
        with warnings.catch_warnings():
            warnings.simplefilter("error", hm.LoweringWarning)
            assembly = assemble(scene(laid, SITUATIONS[situation]).network())
        lowered = {item.element: item.how for item in assembly.lowered}
        part = "coefficients" if name == "linear" and not friction else "force"
        assert any(element.startswith(f"b.{part}") for element in lowered), lowered
        assert set(lowered.values()) <= {"native", "symbolic"}, (name, lowered)


SOLVERS = {
    "RungeKutta4": hm.RungeKutta4(step=1e-5),
    "Trapezoidal": hm.Trapezoidal(step=1e-5),
    "GeneralizedAlpha": hm.GeneralizedAlpha(step=1e-5),
}


@pytest.mark.parametrize("solver", SOLVERS)
def test_copies_of_a_rotors_coordinates_are_exact_in_every_integrator(solver: str) -> None:
    """A law under a rotor with a housing acts on copies of z, psi, theta and the spin; as a Python callback on themselves."""
    law = hm.WithFriction(law=LAWS["power"], **FRICTION)
    line = scene(law, SITUATIONS["merged at a distance, housing"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", hm.LoweringWarning)
        with_copies, direct = (
            hm.simulate(line, 0.005, solver=SOLVERS[solver], initial_speed=SPEED, progress=False, lowering=how)
            for how in ("symbolic", "python")
        )
    assert (with_copies.lowering["b.force"], direct.lowering["b.force"]) == ("symbolic", "python")
    for name, values in direct.values.items():
        # rounding; of implicit solvers Newton's tolerance of 1e-10
        limit = 1e-11 if solver == "RungeKutta4" else 1e-8
        if not name.endswith("acceleration"):
            np.testing.assert_allclose(with_copies.values[name], values, rtol=0.0, atol=limit * np.max(np.abs(values)), err_msg=name)


def test_line_with_copies_is_linearised_as_without() -> None:
    """Exudyn differentiates by steps of about 1e-9 m, which at 1e-5 m is 1e-4 of the slope of a cubic."""
    line = scene(LAWS["power"], SITUATIONS["merged at a distance, housing"])
    rotor = line.parts["rotor"].replacing(eccentricity=0.0, tilt=0.0)
    network = replace(line, parts={**line.parts, "rotor": rotor}).network()
    assembly, lines = assemble(network), LineMatrices(network)
    assert {"rotor.z", "rotor.psi", "rotor.theta"} <= {name for copy in assembly.copies for name in copy}
    angles = {name: 1e-5 * (k % 5 - 2) for k, name in enumerate(lines.names)}
    speeds = dict.fromkeys(lines.names, 0.0)
    wanted = lines.at(angles, speeds)
    found = linearise(assembly, angles=angles, speeds=speeds, states={})
    at = [found.bodies.index(name) for name in lines.names]
    for ours, theirs in ((found.stiffness, wanted.stiffness), (found.damping, wanted.damping)):
        assert np.all(np.abs(ours[np.ix_(at, at)] - theirs) <= 2e-4 * np.max(np.abs(theirs), axis=1, keepdims=True) + 1e-9)
    row, column = lines.names.index("rotor.psi"), lines.names.index("b.across_y")
    assert abs(wanted.stiffness[row, column]) > 1e-2 * np.max(np.abs(wanted.stiffness[row]))


# -- ball pass -----------------------------------------------------------------------------------------


def test_balls_that_pass_under_the_load_shake_a_balanced_rotor_at_ball_pass_frequency() -> None:
    """Balls take the weight in turn.  With damping enough that no higher harmonic meets the bearing's resonance."""
    law = BALLS.replacing(damping=1.5e4)
    rotor = hm.Rotor(mass=8.0, polar_inertia=0.04, transverse_inertia=0.0206)
    parts = {"rotor": rotor, "bearing": hm.Bearing(law=law), "gravity": hm.Gravity()}
    line = hm.Scene(name="rotor in a ball bearing", parts=parts, connections=[("rotor", "bearing")])
    speed = 200.0
    at_rest = law.static_position(load=(0.0, -8.0 * 9.80665), speed=speed)
    initial = {"rotor.x": at_rest[0], "rotor.y": at_rest[1]}
    response = hm.simulate(line, 0.5, solver=hm.Trapezoidal(step=1e-4), initial_speed=speed, initial=initial, progress=False)
    assert response.values["rotor.speed"] == pytest.approx(speed, rel=1e-4)
    passing = 7 * speed * 0.5 * (1.0 - 7.94 / 39.04)  # Z times the speed of the cage
    for axis in "xy":
        found = hm.spectrum(response, f"rotor.{axis}", start=0.1, end=0.5)
        peaks = [peak.frequency for peak in found.peaks(4)]
        assert peaks[0] == pytest.approx(passing, abs=0.5 * found.resolution)
        for peak in peaks:
            assert peak == pytest.approx(passing * round(peak / passing), abs=0.5 * found.resolution)
