"""Runs: what they are asked for, what stops them, and that they can be repeated anywhere."""

from __future__ import annotations

import math
import multiprocessing
import os
import signal
import threading
import time
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.initial_values import initial_values
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.simulation import run
from hdrive_mbs.errors import HdriveError, LawError, ParameterError, PlaceError, SimulationError
from tests.verification.scenes import train

SOLVERS: dict[str, hm.Solver] = {
    "DormandPrince": hm.DormandPrince(),
    "RungeKutta4": hm.RungeKutta4(step=1e-3),
    "Trapezoidal": hm.Trapezoidal(step=1e-3),
    "GeneralizedAlpha": hm.GeneralizedAlpha(step=1e-3),
}


def rotor(law: Any, inertia: float = 1.0) -> hm.Scene:
    return hm.Scene(name="rotor", parts={"motor": hm.Motor(inertia=inertia, characteristic=law)}, connections=[])


def oscillator() -> hm.Scene:
    """J = 1 kg m^2 on k = 100 N m/rad: q = sin(10 t)/10 for a first speed of 1 rad/s."""
    parts = {"disc": hm.Inertia(inertia=1.0), "shaft": hm.Shaft(stiffness=100.0)}
    return hm.Scene(name="oscillator", parts=parts, connections=[("disc", "shaft", "ground")])


# -- runs that do not reach their end -----------------------------------------------------------------


@pytest.mark.parametrize("name", SOLVERS)
def test_a_run_that_diverges_names_the_time_the_solver_and_the_way_out(name: str, capfd: pytest.CaptureFixture[str]) -> None:
    # J dw/dt = w^3 + 1 from rest goes to infinity at t = integral of dw/(w^3 + 1) = 2 pi/(3 sqrt 3) = 1.209 s
    with pytest.raises(SimulationError) as caught:
        hm.simulate(rotor(lambda w: w**3 + 1.0), 10.0, solver=SOLVERS[name])
    message = str(caught.value)
    assert f"with {name}(" in message
    assert any(way in message for way in ("smaller step", "shorter step", "tighter tolerances"))
    time_named = float(message.split("t = ")[1].split(" s")[0])
    assert time_named == pytest.approx(2.0 * math.pi / (3.0 * math.sqrt(3.0)), abs=0.03)  # 10 steps and some to overflow
    assert "of 10 s" in message
    assert capfd.readouterr().out == ""


def test_an_adaptive_run_into_infinity_ends_and_does_not_creep_for_ever() -> None:
    started = time.monotonic()
    with pytest.raises(SimulationError, match=r"stopped at t = 1\.2\d* s of 10 s .*step shrinks to nothing"):
        hm.simulate(rotor(lambda w: w**3 + 1.0), 10.0)
    assert time.monotonic() - started < 20.0


def test_a_law_that_gives_no_number_ends_the_run() -> None:
    with pytest.raises(SimulationError, match=r"not finite from t = 0\.\d+ s on"):
        hm.simulate(rotor(lambda w: np.sqrt(0.05 - w)), 1.0, solver=hm.RungeKutta4(step=1e-2))


def test_a_law_that_gives_no_number_at_the_start_is_named() -> None:
    with pytest.raises(LawError, match=r"motor\.torque gives nan on motor at t = 0 \(angle = 0 rad, speed = 0 rad/s\).*np\.sign"):
        hm.simulate(rotor(lambda w: -2.0 * w / abs(w)), 1.0)
    with (
        pytest.warns(hm.LoweringWarning),
        pytest.raises(LawError, match=r"motor\.torque: the law fails at the start \(ZeroDivisionError: .*\)"),
    ):
        hm.simulate(rotor(lambda w: 1.0 / float(w)), 1.0)
    assert hm.simulate(rotor(lambda w: -2.0 * w / abs(w)), 0.1, initial_speed=1.0)["motor.speed"].values[-1] == pytest.approx(0.8)


def test_a_step_that_is_too_long_for_a_stiff_shaft_is_noticed() -> None:
    # the fastest mode of the train is at about 8e3 rad/s; RK4 is stable up to h w = 2.83
    with pytest.raises(SimulationError, match=r"RungeKutta4\.step = 0\.001 s is beyond its limit of stability, 0\.000358 s"):
        hm.simulate(train(), 0.5, solver=hm.RungeKutta4(step=1e-3))


def test_a_law_that_gets_stiffer_on_the_way_makes_a_step_diverge_that_was_stable_at_the_start() -> None:
    # at the start the gear is in its gap, without stiffness, and the limit is 3.58e-4 s; beyond the gap it is shorter
    with pytest.raises(
        SimulationError, match=r"diverged: values are not finite .* with RungeKutta4\(step=0\.00034 s\)\. Use a smaller step"
    ):
        hm.simulate(train(), 0.5, solver=hm.RungeKutta4(step=3.4e-4))


# -- arguments --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "kind", "message"),
    [
        ({"duration": 0.0}, ParameterError, r"duration = 0 s: must be greater than 0 s"),
        ({"duration": -1.0}, ParameterError, r"duration = -1 s: must be greater than 0 s"),
        ({"duration": math.nan}, ParameterError, r"duration = nan s: must be a finite number"),
        ({"duration": math.inf}, ParameterError, r"duration = inf s: must be a finite number"),
        ({"duration": "1 s"}, ParameterError, r"duration = '1 s': must be a number, in s"),
        ({"duration": None}, ParameterError, r"duration = None: must be a number, in s"),
        ({"sample_step": -1e-3}, ParameterError, r"sample_step = -0\.001 s: must be at least 0 s"),
        ({"sample_step": math.nan}, ParameterError, r"sample_step = nan s: must be a finite number"),
        ({"initial_speed": math.nan}, ParameterError, r"initial_speed = nan rad/s: must be a finite number"),
        ({"solver": "rk4"}, ParameterError, r"solver = 'rk4': must be a Solver, for instance DormandPrince\(\)"),
        ({"solver": hm.RungeKutta4(step=1.0)}, ParameterError, r"RungeKutta4\.step = 1 s is longer than the run of 0\.1 s"),
        (
            {"initial": {"load.angel": 1.0}},
            PlaceError,
            r"No initial value 'load\.angel'\. This scene has: motor\.angle/\.speed, .*load\.angle",
        ),
        ({"initial": {"gear.twist": 1.0}}, PlaceError, r"No initial value 'gear\.twist'"),
        ({"initial": {"load.angle": math.nan}}, ParameterError, r"initial value of load\.angle = nan rad: must be a finite number"),
        ({"initial": {"load.speed": "fast"}}, ParameterError, r"initial value of load\.speed = 'fast': must be a number, in rad/s"),
    ],
)
def test_a_bad_argument_is_refused_with_its_value_and_unit(arguments: dict[str, Any], kind: type[HdriveError], message: str) -> None:
    with pytest.raises(kind, match=message):
        hm.simulate(train(), **({"duration": 0.1} | arguments))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: hm.RungeKutta4(step=0.0), r"RungeKutta4\.step = 0 s: must be greater than 0"),
        (lambda: hm.DormandPrince(relative_tolerance=-1.0), r"DormandPrince\.relative_tolerance = -1: must be greater than 0"),
        (lambda: hm.GeneralizedAlpha(step=1e-3, spectral_radius=1.5), r"spectral_radius = 1\.5: must be at most 1"),
    ],
)
def test_a_bad_setting_of_a_solver_is_refused(make: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        make()


# -- initial values -------------------------------------------------------------------------------------------


def test_initial_values_are_given_by_name_in_true_sense() -> None:
    scene = train()
    response = hm.simulate(scene, 1e-4, initial={"load.speed": 0.5, "load.angle": 0.01, "gear.flexspline.angle": 0.02, "motor.speed": 3.0})
    for name, value in (("load.speed", 0.5), ("load.angle", 0.01), ("gear.flexspline.angle", 0.02), ("motor.speed", 3.0)):
        assert response[name].values[0] == value
    assert response["gear.wave_generator.speed"].values[0] == 0.0
    # the load turns backwards when the motor turns forward: its forward coordinate starts at -0.5 rad/s
    starts = initial_values(scene.network(), 0.0, {"load.speed": 0.5})
    assert starts["speeds"]["load"] == -0.5


def test_an_initial_speed_turns_every_place_by_its_ideal_ratio_and_single_values_go_before() -> None:
    response = hm.simulate(train(), 1e-4, initial_speed=100.0, initial={"gear.flexspline.speed": 0.25})
    assert response["motor.speed"].values[0] == 100.0
    assert response["gear.wave_generator.speed"].values[0] == 100.0
    assert response["load.speed"].values[0] == pytest.approx(-1.0, rel=1e-12)
    assert response["gear.flexspline.speed"].values[0] == 0.25


def test_states_have_initial_values_too() -> None:
    scene = train().with_effect(hm.BoucWenHysteresis(torque_limit=2.0, yield_twist=1e-4), at="gear", name="loop")
    response = hm.simulate(scene, 1e-4, initial={"loop.z": 0.5})
    assert response["loop.z"].values[0] == 0.5
    with pytest.raises(PlaceError, match=r"No initial value 'loop\.y'.*loop\.z"):
        hm.simulate(scene, 1e-4, initial={"loop.y": 0.5})


# -- sampling ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SOLVERS)
def test_a_run_is_recorded_from_zero_to_its_end_on_rising_times(name: str) -> None:
    response = hm.simulate(oscillator(), 0.7, initial_speed=1.0, solver=SOLVERS[name])
    assert response.times[0] == 0.0
    assert response.times[-1] == pytest.approx(0.7, rel=1e-9)
    assert np.all(np.diff(response.times) > 0.0)
    assert len(response.times) == response.steps + 1
    assert all(len(response[channel]) == len(response.times) for channel in response.channels)


@pytest.mark.parametrize("name", SOLVERS)
def test_a_sample_step_thins_the_record_and_not_the_integration(name: str) -> None:
    whole = hm.simulate(oscillator(), 0.7, initial_speed=1.0, solver=SOLVERS[name])
    thin = hm.simulate(oscillator(), 0.7, initial_speed=1.0, solver=SOLVERS[name], sample_step=0.05)
    assert thin.steps == whole.steps
    assert 0.7 / 0.05 <= len(thin.times) <= 0.7 / 0.05 + 3
    assert np.diff(thin.times).min() > 0.04
    assert thin.times[-1] == whole.times[-1]
    both = np.isin(whole.times, thin.times)
    assert both.sum() == len(thin.times)
    np.testing.assert_array_equal(whole["disc.angle"].values[both], thin["disc.angle"].values)


def test_a_step_that_does_not_divide_the_duration_is_shortened_and_never_lengthened() -> None:
    response = hm.simulate(oscillator(), 1.0, initial_speed=1.0, solver=hm.RungeKutta4(step=0.03))
    assert response.steps == 34  # 33 steps would be 0.0303 s
    np.testing.assert_allclose(np.diff(response.times), 1.0 / 34, rtol=1e-9)


def test_the_slopes_of_angles_and_speeds_are_the_recorded_speeds_and_accelerations() -> None:
    response = hm.simulate(oscillator(), 0.7, initial_speed=1.0)
    np.testing.assert_array_equal(response["disc.angle"].slope, response["disc.speed"].values)
    np.testing.assert_array_equal(response["disc.speed"].slope, response["disc.acceleration"].values)
    np.testing.assert_allclose(response["disc.acceleration"].values, -100.0 * response["disc.angle"].values, rtol=1e-14)
    # Hermite interpolation between the solver's times: h^4/384 of the fourth derivative 10^3, h <= 0.01 s
    times = np.linspace(0.0, 0.7, 1001)
    np.testing.assert_allclose(response["disc.angle"].at(times), np.sin(10.0 * times) / 10.0, atol=1e-6)


def test_laws_for_plain_numbers_are_read_point_by_point_where_arrays_would_mean_something_else() -> None:
    def drive(speed: float) -> float:  # np.sum and max of an array are the sum and the maximum of the whole history
        return float(np.sum([1.0, -speed])) if np.ndim(speed) == 0 else np.sum([np.ones_like(speed), -speed])

    with pytest.warns(hm.LoweringWarning):
        response = hm.simulate(rotor(drive), 1.0, solver=hm.RungeKutta4(step=1e-2))
    np.testing.assert_allclose(response["motor.torque"].values, 1.0 - response["motor.speed"].values, rtol=1e-14)
    np.testing.assert_allclose(response["motor.acceleration"].values, 1.0 - response["motor.speed"].values, rtol=1e-14)


# -- error estimate -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("solver", "refined"),
    [
        (hm.RungeKutta4(step=0.01), "RungeKutta4(step=0.005 s)"),
        (hm.Trapezoidal(step=0.01), "Trapezoidal(step=0.005 s"),
        (hm.GeneralizedAlpha(step=0.01), "GeneralizedAlpha(step=0.005 s"),
    ],
)
def test_the_estimated_error_of_step_halving_is_the_error_of_the_finer_run(solver: hm.Solver, refined: str) -> None:
    response = hm.simulate(oscillator(), 1.0, initial_speed=1.0, solver=solver, estimate_error=True)
    assert response.settings["solver"].startswith(refined)
    true = np.max(np.abs(response["disc.angle"].values - np.sin(10.0 * response.times) / 10.0)) / np.max(
        np.abs(response["disc.angle"].values)
    )
    # Richardson: both errors go with h^p, so the difference over 2^p - 1 is the finer one's; the next order adds some percent
    assert response.error["disc.angle"] == pytest.approx(true, rel=0.1)
    assert set(response.error) == {"disc.angle", "disc.speed"}


def test_a_thin_record_does_not_spoil_the_estimated_error() -> None:
    solver = hm.DormandPrince(relative_tolerance=1e-8, absolute_tolerance=1e-10)
    thin = hm.simulate(oscillator(), 1.0, initial_speed=1.0, solver=solver, estimate_error=True, sample_step=0.05)
    whole = hm.simulate(oscillator(), 1.0, initial_speed=1.0, solver=solver, estimate_error=True)
    assert thin.error == whole.error
    assert 20 <= len(thin.times) <= 23
    assert np.diff(thin.times).min() > 0.03
    assert (thin.times[0], thin.times[-1]) == (0.0, whole.times[-1])


def test_the_adaptive_estimate_bounds_the_error_of_the_run_that_is_returned() -> None:
    response = hm.simulate(oscillator(), 1.0, initial_speed=1.0, estimate_error=True)
    true = np.max(np.abs(response["disc.angle"].values - np.sin(10.0 * response.times) / 10.0)) / 0.1
    assert true < response.error["disc.angle"] < 1e-4
    assert hm.simulate(oscillator(), 1.0, initial_speed=1.0).error == {}


# -- stopping -----------------------------------------------------------------------------------------------------


def assert_kept(response: hm.Response, full: float) -> None:
    """What was computed up to the stop is kept, true, and said to be incomplete."""
    reached = response.times[-1]
    assert 0.0 < reached < full
    assert response.status == f"cancelled at t = {reached:.6g} s; the histories end there"
    np.testing.assert_allclose(response["disc.angle"].values, np.sin(10.0 * response.times) / 10.0, atol=1e-5)
    assert all(len(response[name]) == len(response.times) for name in response.channels)


SLOW = hm.RungeKutta4(step=1e-5)


def test_a_cancel_event_stops_a_run_and_keeps_what_was_computed() -> None:
    cancel = threading.Event()
    timer = threading.Timer(0.3, cancel.set)
    timer.start()
    try:
        assert_kept(hm.simulate(oscillator(), 100.0, initial_speed=1.0, solver=SLOW, cancel=cancel, sample_step=1e-3), 100.0)
    finally:
        timer.cancel()


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT to the own process")
def test_control_c_stops_a_run_keeps_what_was_computed_and_is_given_back_its_handler() -> None:
    before = signal.getsignal(signal.SIGINT)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        response = hm.simulate(oscillator(), 100.0, initial_speed=1.0, solver=SLOW, sample_step=1e-3)
    finally:
        timer.cancel()
    assert_kept(response, 100.0)
    assert signal.getsignal(signal.SIGINT) is before


def test_an_error_estimate_that_is_cancelled_returns_the_first_part_without_an_estimate() -> None:
    cancel = threading.Event()
    timer = threading.Timer(0.3, cancel.set)
    timer.start()
    try:
        response = hm.simulate(oscillator(), 100.0, initial_speed=1.0, solver=SLOW, cancel=cancel, sample_step=1e-3, estimate_error=True)
    finally:
        timer.cancel()
    assert_kept(response, 100.0)
    assert response.error == {}


def test_a_run_that_repeats_its_step_without_getting_on_can_be_cancelled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("hdrive_mbs.engine.simulation.STUCK", -1.0)  # never give up by itself
    cancel = threading.Event()
    timer = threading.Timer(0.3, cancel.set)
    timer.start()
    try:
        response = hm.simulate(rotor(lambda w: w**3 + 1.0), 10.0, cancel=cancel)
    finally:
        timer.cancel()
    assert response.status.startswith("cancelled at t = 1.2")


def test_a_run_that_is_cancelled_before_it_begins_does_next_to_nothing() -> None:
    cancel = threading.Event()
    cancel.set()
    response = hm.simulate(oscillator(), 10.0, initial_speed=1.0, cancel=cancel)
    assert response.status.startswith("cancelled")
    assert response.steps <= 2


def test_runs_in_other_threads_leave_control_c_alone() -> None:
    before = signal.getsignal(signal.SIGINT)
    found: list[Any] = []

    def work() -> None:
        found.append(hm.simulate(oscillator(), 0.1, initial_speed=1.0).status)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == ["complete"]
    assert signal.getsignal(signal.SIGINT) is before


def test_progress_is_reported_with_the_time_reached() -> None:
    reported: list[float] = []
    assembly = assemble(oscillator().network())
    cancel = threading.Event()

    def progress(t: float) -> None:
        reported.append(t)
        if len(reported) == 3:
            cancel.set()

    raw = run(
        assembly,
        duration=100.0,
        solver=SLOW,
        angles={},
        speeds={"disc": 1.0},
        states={},
        sample_step=1e-2,
        progress=progress,
        cancel=cancel,
    )
    assert raw.status == "cancelled"
    assert len(reported) == 3
    assert 0.0 < reported[0] < reported[1] < reported[2] <= raw.times[-1] + 1e-2


def test_a_bar_is_drawn_only_where_it_was_asked_for(capfd: pytest.CaptureFixture[str]) -> None:
    hm.simulate(oscillator(), 0.1, progress=False)
    hm.simulate(oscillator(), 0.1)  # pytest is no terminal
    captured = capfd.readouterr()
    assert captured.out + captured.err == ""


# -- repeating ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SOLVERS)
def test_an_assembly_that_is_run_again_gives_the_same_bits(name: str) -> None:
    scene = train() if name == "DormandPrince" else oscillator()
    assembly = assemble(scene.network())
    place = "motor" if name == "DormandPrince" else "disc"

    def once(duration: float) -> Any:
        return run(assembly, duration=duration, solver=SOLVERS[name], angles={}, speeds={place: 2.0}, states={})

    first = once(0.1)
    once(0.03)  # another run in between leaves no trace
    again = once(0.1)
    np.testing.assert_array_equal(first.times, again.times)
    for body in first.angles:
        np.testing.assert_array_equal(first.angles[body], again.angles[body])
        np.testing.assert_array_equal(first.speeds[body], again.speeds[body])
    assert (first.steps, first.rejected) == (again.steps, again.rejected)


def test_a_failed_run_leaves_the_assembly_usable() -> None:
    assembly = assemble(rotor(lambda w: w**3 + 1.0).network())

    def once(duration: float) -> Any:
        return run(assembly, duration=duration, solver=hm.DormandPrince(), angles={}, speeds={}, states={})

    fresh = once(1.0)
    with pytest.raises(SimulationError):
        once(10.0)
    np.testing.assert_array_equal(once(1.0).speeds["motor"], fresh.speeds["motor"])


def final_speed(scene: hm.Scene) -> float:
    return float(hm.simulate(scene, 0.05)["motor.speed"].values[-1])


def test_scenes_are_shipped_to_other_processes_and_solved_there() -> None:
    scenes = [train().replacing({"motor.inertia": inertia}) for inertia in (1e-3, 2e-3, 4e-3)]
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        there = pool.map(final_speed, scenes)
    assert there == [final_speed(scene) for scene in scenes]
    assert there[0] > there[1] > there[2]


def test_a_law_that_chatters_is_given_up_after_max_steps_with_the_way_out() -> None:
    jump = hm.JumpTorqueStiffness(lost_motion=hm.arcmin(9.0), linear=0.0, cubic=3e9)
    scene = train().replacing({"gear.stiffness": jump, "load.torque": hm.ConstantTorque(value=0.5 * jump.edge_torque)})
    with pytest.raises(hm.SimulationError, match=r"max_steps = 20000; a law that jumps .* continuous law"):
        hm.simulate(scene, 1.0, solver=hm.DormandPrince(max_steps=2e4))
