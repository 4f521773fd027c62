"""The models of the two benches: parameters by name and by path, and the sampled controller of the rotor bench."""

from __future__ import annotations

import functools
from types import ModuleType

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hdrive_mbs as hm
from models import drive_bench, rotor_bench

BENCHES = [drive_bench, rotor_bench]


@pytest.mark.parametrize("bench", BENCHES, ids=lambda bench: bench.__name__)
def test_a_parameter_set_by_its_paths_gives_the_scene_that_is_built_with_it(bench: ModuleType) -> None:
    assert bench.PATHS.keys() == bench.NOMINAL.keys()
    build = functools.partial(bench.undriven, "bump") if bench is rotor_bench else bench.build
    nominal = build().parameters()
    for name, value in bench.NOMINAL.items():
        assert {nominal[path].value for path in bench.PATHS[name]} == {value}, name
        changed = {path: item.value for path, item in build(**{name: 0.9 * value}).parameters().items()}
        moved = {path for path, item in nominal.items() if changed[path] != item.value}
        assert moved == set(bench.PATHS[name]), name


@pytest.mark.parametrize("bench", BENCHES, ids=lambda bench: bench.__name__)
def test_what_is_known_of_a_bench_names_its_parameters_and_columns(bench: ModuleType) -> None:
    assert set(bench.KNOWLEDGE) <= set(bench.NOMINAL)
    assert all(0.0 < sigma < 0.1 for sigma in bench.KNOWLEDGE.values())
    assert set(bench.RESOLUTION) <= set(bench.NOISE)
    assert set(bench.NOISE) <= set(bench.CHANNELS)
    assert bench.noise()["motor_torque"] ** 2 == pytest.approx(
        bench.NOISE["motor_torque"] ** 2 + bench.RESOLUTION["motor_torque"] ** 2 / 12.0
    )


@pytest.mark.parametrize("bench", BENCHES, ids=lambda bench: bench.__name__)
def test_an_unknown_parameter_is_refused_with_the_known_ones(bench: ModuleType) -> None:
    with pytest.raises(hm.ParameterError, match=r"No parameter 'stifness'.*lost_motion|No parameter 'stifness'.*drag"):
        bench.build(stifness=1.0)


def test_unknown_records_and_two_drives_at_once_are_refused() -> None:
    with pytest.raises(hm.ParameterError, match=r"record = 'runup': must be one of run_up, steps, bump"):
        rotor_bench.build("runup")
    line = ((0.0, 1.0), (0.0, 1.0))
    with pytest.raises(hm.ParameterError, match="either a speed_reference or a motor_torque"):
        drive_bench.build(speed_reference=line, motor_torque=line)


def test_every_column_of_a_bench_is_a_channel_of_its_scene() -> None:
    response = hm.simulate(drive_bench.build(), 0.01)
    assert set(drive_bench.CHANNELS.values()) <= set(response.channels)
    response = hm.simulate(rotor_bench.build("bump"), 0.001, solver=rotor_bench.SOLVER, **rotor_bench.start("bump"))
    assert set(rotor_bench.CHANNELS.values()) <= set(response.channels)


def test_a_recorded_torque_without_noise_moves_the_drive_like_its_controller() -> None:
    ramp = ((0.0, 0.5, 1.0), (0.0, 100.0, 100.0))
    load = ((0.0, 0.4, 1.0), (0.0, 0.0, 30.0))
    controlled = hm.simulate(drive_bench.build(speed_reference=ramp, load_torque=load), 1.0)
    times = np.arange(0.0, 1.0, drive_bench.SAMPLE_TIME / 4.0)
    torque = controlled.at("motor.torque", times)
    driven = hm.simulate(drive_bench.build(motor_torque=(times, torque), load_torque=load), float(times[-1]))
    # the torque swings at 900 rad/s (input shaft on the motor) at most: straight lines err by (w h)^2/8 = 1.6e-3 of that swing,
    # which is a small part of the torque; 1e-3 of the angle leaves room for what adds up
    at = np.linspace(0.1, 0.99, 50)
    for channel in ("motor.angle", "load.angle"):
        np.testing.assert_allclose(driven[channel].at(at), controlled[channel].at(at), rtol=1e-3)


def test_the_rotor_bench_begins_at_rest_in_its_static_deflection() -> None:
    scene = rotor_bench.build("bump", hammer={})
    response = hm.simulate(scene, 0.02, solver=rotor_bench.SOLVER, **rotor_bench.start("bump", scene))
    assert "hammer" not in scene.parts
    sag = response["rotor_1.y"].values
    assert sag[0] < -2e-5
    # the weight of the eccentric rotors turns the shaft a little; nothing else moves
    assert np.ptp(sag) < 1e-10


def test_the_sampled_controller_is_solved_exactly() -> None:
    # the same line and law by scipy, one sample after the other, without the matrix exponential or the network's matrices
    p = rotor_bench.NOMINAL
    inertia = np.array([p["ring_polar_inertia"], p["rotor_1_polar_inertia"], p["ring_polar_inertia"], p["rotor_2_polar_inertia"]])
    stations = np.array(list(rotor_bench.POSITIONS.values()))
    torsion = p["shear_modulus"] * np.pi * p["shaft_diameter"] ** 4 / 32.0 / np.diff(stations)

    def rates(t: float, y: np.ndarray, torque: float) -> np.ndarray:
        angle, speed = y[:4], y[4:]
        through = torsion * (np.diff(angle) + p["shaft_damping"] * np.diff(speed))
        total = -p["drag"] * speed
        total[:-1] += through
        total[1:] -= through
        total[0] += torque
        return np.concatenate((speed, total / inertia))

    angles, speeds, torques = rotor_bench.held_control("steps", rotor_bench.undriven("steps"))
    y = np.concatenate((np.zeros(4), np.full(4, speeds[0])))
    reference = np.interp(rotor_bench.sample_times("steps"), *rotor_bench.REFERENCES["steps"])
    for k in range(2460):  # at 180 rad/s, and 60 samples of the first ramp
        assert torques[k] == pytest.approx(4.0 * (reference[k] - y[4]), abs=1e-6)
        assert angles[k] == pytest.approx(y[0], abs=1e-6)
        y = solve_ivp(rates, (0.0, 2.5e-4), y, args=(torques[k],), method="DOP853", rtol=1e-9, atol=1e-12).y[:, -1]
    assert np.max(torques) == rotor_bench.TORQUE_LIMIT


def test_on_the_engine_a_balanced_line_turns_like_the_sampled_one() -> None:
    balanced = dict.fromkeys(("rotor_1_eccentricity", "rotor_2_eccentricity", "rotor_1_tilt"), 0.0)
    angles, _, torques = rotor_bench.held_control("steps", rotor_bench.undriven("steps", **balanced))
    scene = rotor_bench.build("steps", **balanced)
    response = hm.simulate(scene, 1.0, solver=rotor_bench.SOLVER, **rotor_bench.start("steps", scene))
    times = rotor_bench.sample_times("steps")[:3999]
    # through the first ramp with its saturation; a count of the encoder is 7.7e-4 rad, a controller without the half sample
    # of delay is 4e-3 rad off there
    difference = response["bearing_1.angle"].at(times) - angles[:3999]
    assert np.max(np.abs(difference)) < 2e-5
    torque = response.at("drive.torque", times + 0.5 * rotor_bench.SAMPLE_TIME) - torques[:3999]
    assert np.sqrt(np.mean(torque**2)) < 0.1 * rotor_bench.NOISE["motor_torque"]
