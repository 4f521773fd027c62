"""The rotor bench as a diagnosis lays it beside its records: two views of each, and lines that start at rest."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.compiled.equilibrium import equilibria
from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.experiment.choose import next_records
from hdrive_mbs.diagnosis.experiment.detectability import DISTINGUISHABLE
from hdrive_mbs.diagnosis.experiment.plan import Plan
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.following import following
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.lines import _network
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from models import rotor_bench
from tests.unit.rotor_bench_records import bench, compiled, factors, recorded


def test_a_record_of_the_engine_differs_from_both_views_by_its_noise_alone() -> None:
    scene = rotor_bench.build("steps")
    response = hm.simulate(scene, 0.1, solver=rotor_bench.SOLVER, **rotor_bench.start("steps", scene))
    times = rotor_bench.SAMPLE_TIME * np.arange(400)
    columns = {column: response.at(item.channel, times) for column, item in bench().measured.items()}
    trials = bench().trials(recorded("steps", columns, noisy=True))
    assert [trial.name for trial in trials] == ["steps, lateral", "steps, torsion"]
    simulator = Simulator(trials, rotor_bench.STEP)
    nominal = Hypothesis(factors=factors("youngs_modulus"))
    [residuals] = simulator.residuals(nominal, [np.zeros(1)])
    assert residuals is not None
    for segment in simulator.segments:
        # the mean square of 400 samples of white noise spreads by sqrt(2/400) = 0.07; four of these
        assert np.mean(residuals[segment.span] ** 2) == pytest.approx(1.0, abs=0.28), segment.column


def test_trials_that_share_a_line_are_simulated_as_if_each_were_alone() -> None:
    trials = [trial for name in ("bump", "run_up", "steps") for trial in bench().trials(recorded(name, compiled(name, 0.1), noisy=False))]
    assert [trial.name for trial in trials] == ["bump, lateral", "run_up, lateral", "run_up, torsion", "steps, lateral", "steps, torsion"]
    hypothesis = Hypothesis(factors=factors("bearing_stiffness", "rotor_1_mass"))
    points = [np.zeros(2), np.array([1.0, -2.0])]
    together = Simulator(trials, rotor_bench.STEP).residuals(hypothesis, points)
    for k in range(2):
        alone = [Simulator([trial], rotor_bench.STEP).residuals(hypothesis, points)[k] for trial in trials]
        # a trial alone starts where its own forces at t = 0 balance, beside the others where those of the first do.  While a drive
        # end that follows 180 rad/s drags rotor 1 at rest (d k_t 180/J_p = 3e-5 s 7.6e4 N m/rad 180/0.36 = 1.1e3 rad/s^2), its
        # unbalance of 8 um pulls with 1e-3 of its weight: 1e-3 of its sag of 48 um, 0.2 standard deviations of a probe
        np.testing.assert_allclose(together[k], np.concatenate(alone), rtol=0.0, atol=0.2)  # type: ignore[arg-type]


def test_trials_whose_scenes_differ_in_a_number_share_nothing() -> None:
    run_up, steps = (bench().trials(recorded(name, compiled(name, 0.05), noisy=False))[1] for name in ("run_up", "steps"))
    heavy = dataclasses.replace(steps, scene=steps.scene.replacing({"rotor_1.polar_inertia": 0.4}))
    hypothesis, points = Hypothesis(factors=factors("youngs_modulus")), [np.zeros(1)]

    def torsion(trial: Trial) -> np.ndarray:
        [found] = Simulator([trial], rotor_bench.STEP).residuals(hypothesis, points)
        assert found is not None
        return found

    [together] = Simulator([run_up, heavy], rotor_bench.STEP).residuals(hypothesis, points)
    # where trials start is settled with the lateral coordinates of the first, which does not depend on a polar inertia
    np.testing.assert_allclose(together, np.concatenate([torsion(run_up), torsion(heavy)]), rtol=0.0, atol=1e-6)  # type: ignore[arg-type]
    assert np.abs(torsion(heavy) - torsion(steps)).max() > 1.0


def test_equal_runs_are_made_once() -> None:
    trials = bench().trials(recorded("steps", compiled("steps", 0.05), noisy=False))
    simulator = Simulator(trials, rotor_bench.STEP)
    hypothesis = Hypothesis(factors=factors("bearing_stiffness"))
    simulator.residuals(hypothesis, [np.zeros(1), np.zeros(1), np.ones(1)])
    assert simulator.runs == 4
    simulator.residuals(hypothesis, [np.ones(1)])
    assert simulator.runs == 4


def test_the_controller_holds_its_torque_for_a_line_with_other_inertias_too() -> None:
    # in steps the torque is limited in every ramp, so that a heavier line leaves the limit later than the nominal one
    free = rotor_bench.undriven("steps", rotor_1_polar_inertia=0.36 * 1.01)
    angles, _, torques = rotor_bench.held_control("steps", free)
    assert np.abs(torques).max() == rotor_bench.TORQUE_LIMIT
    driven = free.replacing({"drive.characteristic": rotor_bench.build("steps").parts["drive"].characteristic})  # type: ignore[attr-defined]
    network = driven.without("gravity").network()
    channels = tuple(channel for channel in network.channels if channel.name in ("bearing_1.angle", "drive.command"))
    line = CompiledLine(dataclasses.replace(network.turning(), channels=channels), ["bearing_1.angle", "drive.command"])
    speeds = dict.fromkeys(rotor_bench.POSITIONS, 180.0)
    run = line.run(len(torques), rotor_bench.SAMPLE_TIME, step=rotor_bench.STEP, speeds=speeds)
    # a quarter of what an encoder's step does to a reading
    limit = 0.25 * rotor_bench.RESOLUTION["spin_angle"] / np.sqrt(12.0)
    np.testing.assert_allclose(run.values["bearing_1.angle"], angles[:-1], atol=limit)
    nominal, _, _ = rotor_bench.held_control("steps", rotor_bench.undriven("steps"))
    assert np.abs(nominal - angles).max() > 100.0 * limit
    left = np.sqrt(np.mean((run.values["drive.command"] - torques) ** 2))
    assert left < 0.25 * rotor_bench.NOISE["motor_torque"]


@pytest.mark.parametrize(
    "effect",
    [None, hm.BearingClearance(gap=2e-5), hm.BearingClearance(gap=1e-6, film_damping=0.0), hm.DampedClearance(gap=1.8e-5)],
    ids=repr,
)
def test_a_line_stays_where_it_settles(effect: hm.Effect | None) -> None:
    scene = rotor_bench.undriven("bump", hammer={})
    scene = scene if effect is None else scene.with_effect(effect, at="bearing_1")
    network = without_idle(scene.network())
    line = CompiledLine(network, ["rotor_1.y"])
    first, second = equilibria([line, line])
    assert first == second
    # the exact equations of the rigid bodies, not those that were compiled
    exact = scene.network()
    zero = {body.name: 0.0 for body in exact.bodies}
    left = exact.accelerations(exact.moment(0.0, {**zero, **first}, zero, {}))
    lateral = [float(left[body.name]) for body in exact.bodies if body.lateral]
    assert np.abs(lateral).max() < 1e-6 * 9.81
    if effect is None:
        still = rotor_bench.start("bump", scene)["initial"]
        assert first == pytest.approx({name: still[name] for name in first}, rel=1e-6, abs=1e-12)
    else:
        across = np.hypot(*(first[f"bearing_1.{d}"] - first[f"bearing_1.housing.{d}"] for d in "xy"))
        assert across > effect.gap  # type: ignore[attr-defined]


def test_a_line_without_lateral_motion_settles_nowhere() -> None:
    scene = hm.Scene(
        name="one inertia",
        parts={"motor": hm.Motor(inertia=1.0, characteristic=lambda speed: 1.0 - speed)},
        connections=[],
    )
    assert equilibria([CompiledLine(scene.network(), ["motor.speed"])]) == [{}]


def test_a_place_that_follows_an_angle_turns_by_it_and_no_torque_moves_it() -> None:
    network = rotor_bench.undriven("bump", hammer={}).network()
    pushed = rotor_bench.undriven("bump", hammer={}).replacing(
        {"drive.characteristic": hm.TorqueHistory(times=(0.0, 1.0), torques=(50.0, 50.0))}
    )
    angle = lambda time: 3.0 * time  # noqa: E731
    runs = []
    for given in (network, pushed.network()):
        line = CompiledLine(without_idle(following(given, {"drive": angle})), ["bearing_1.angle", "rotor_2.angle"])
        runs.append(line.run(40, 1e-3, step=5e-5).values)
    np.testing.assert_allclose(runs[0]["bearing_1.angle"], 3e-3 * np.arange(40), atol=1e-15)
    np.testing.assert_array_equal(runs[0]["rotor_2.angle"], runs[1]["rotor_2.angle"])
    assert runs[0]["rotor_2.angle"][-1] > 0.0


def test_rotors_held_places_and_unknown_ones_cannot_follow() -> None:
    network = rotor_bench.undriven("bump", hammer={}).network()
    still = lambda time: 0.0 * time  # noqa: E731
    with pytest.raises(hm.ParameterError, match="'rotor_1' cannot follow a measured angle: it is a rotor"):
        following(network, {"rotor_1": still})
    with pytest.raises(hm.ParameterError, match="held already"):
        following(following(network, {"bearing_1": still}), {"bearing_1": still})
    with pytest.raises(hm.PlaceError, match="bearing_3"):
        following(network, {"bearing_3": still})


def test_a_record_that_is_none_of_the_bench_or_has_no_encoder_is_refused() -> None:
    columns = {"r1_x": np.zeros(100)}
    with pytest.raises(hm.RecordError, match=r"'coast' is none of the rotor bench: run_up, steps, bump"):
        bench().trials(recorded("coast", columns, noisy=False))
    with pytest.raises(hm.RecordError, match="'spin_angle', which drives the scene"):
        bench().trials(recorded("steps", columns, noisy=False))
    [only] = bench().trials(recorded("bump", columns, noisy=False))
    assert isinstance(only, Trial)
    assert tuple(only.columns) == ("r1_x",)


def test_a_softer_support_is_found_in_a_bump() -> None:
    soft = rotor_bench.build("bump", support_stiffness_x=0.95 * 3.2e7)
    trials = bench().trials(recorded("bump", compiled("bump", 0.2, soft), noisy=True))
    simulator = Simulator(trials, rotor_bench.STEP, 2)
    hypothesis = Hypothesis(factors=factors("support_stiffness_x", "bearing_damping"))
    found = fit(simulator, hypothesis, np.zeros(2), steps=6)
    spread = np.sqrt(np.diag(found.covariance))
    stiffness = hypothesis.values(found.z)["bearing_1.housing.stiffness_x"]
    assert stiffness == pytest.approx(0.95 * 3.2e7, abs=4.0 * spread[0] * 0.02 * 3.2e7)
    assert abs(found.z[1]) < 4.0 * spread[1]
    assert spread[0] < 0.3  # of the prior's standard deviation: the record, not the prior, says so
    assert found.chi_fit == pytest.approx(1.0, abs=0.1)


def test_a_clearance_whose_film_damps_fully_and_has_no_gap_is_the_bearing() -> None:
    scene = rotor_bench.build("bump")
    closed = scene.with_effect(hm.DampedClearance(gap=0.0, film_damping=1.0), at="bearing_1")
    plain, with_it = (compiled("bump", 0.08, item) for item in (scene, closed))
    for column in (*rotor_bench.PROBES, *rotor_bench.ACCELEROMETERS):
        np.testing.assert_allclose(with_it[column], plain[column], rtol=1e-9, atol=1e-6 * rotor_bench.NOISE[column])


def test_a_phased_crack_with_the_weights_phase_is_the_breathing_crack() -> None:
    common = {"compliance": 5e-7, "position": 0.6, "angle": 0.4}
    # the weight acts along -y: the crack points down at f + angle = -pi/2
    laws = (hm.BreathingCrack(**common), hm.PhasedCrack(phase=-0.4 - 0.5 * np.pi, **common))
    scenes = [rotor_bench.build("steps").with_effect(law, at="section_1") for law in laws]
    first, second = (compiled("steps", 0.1, scene) for scene in scenes)
    for column in rotor_bench.PROBES:
        np.testing.assert_allclose(second[column], first[column], rtol=1e-9, atol=1e-6 * rotor_bench.NOISE[column])


def test_an_effect_of_the_sensors_leaves_the_torsion_view_as_it_is() -> None:
    trials = bench().trials(recorded("steps", compiled("steps", 0.05), noisy=False))
    simulator = Simulator(trials, rotor_bench.STEP)
    gain = Added(hm.ProbeGain(error=0.1), "probe_r1_x", "probe_gain")
    hypothesis = Hypothesis(factors=factors("bearing_stiffness"), added=(gain,))
    start = hypothesis.start()
    changed = start.copy()
    changed[1] += 0.1
    simulator.residuals(hypothesis, [start, changed])
    assert simulator.runs == 3  # lateral twice, torsion once


def test_a_planned_record_is_what_the_bench_would_record() -> None:
    """The reference of the run-up as a plan: the same columns as its record, which follows its own spin angle."""
    duration = 0.5
    plan = Plan(
        name="again", inputs={rotor_bench.SPEED: rotor_bench.REFERENCES["run_up"]}, duration=duration, every=rotor_bench.SAMPLE_TIME
    )
    columns = compiled("run_up", duration)
    hypothesis, origin = Hypothesis(factors=factors("youngs_modulus")), np.zeros(1)
    shown = Simulator(bench().planned(plan), rotor_bench.STEP).columns(hypothesis, origin)
    assert [set(part) for part in shown] == [set(rotor_bench.LATERAL), set(rotor_bench.TORSION)]
    for column, values in {**shown[0], **shown[1]}.items():
        noise = rotor_bench.noise()[column]
        # at the smallest a fifth of the noise's rms, which the steps of both runs and the smoothed controller leave
        assert np.sqrt(np.mean((values - columns[column]) ** 2)) < 0.2 * noise, column


def test_plans_of_the_rotor_bench_tell_causes_apart() -> None:
    plans = {plan.name: plan for plan in bench().menu()}
    assert len(plans) == 4
    assert all(plan.duration == rotor_bench.MENU_TIME for plan in plans.values())
    [blows] = [plan for name, plan in plans.items() if "blows" in name]
    short = dataclasses.replace(blows, duration=0.5)
    seen = dataclasses.replace(bench().planned(short)[0], held_out=np.arange(short.samples) % 16 < 4)
    simulator = Simulator([seen], rotor_bench.STEP, 4)
    fits = {}
    for where, change in (("bearing_1", 0.2), ("bearing_2", 0.2)):
        added = Added(hm.SupportStiffnessChange(change=change), where, "softer")
        hypothesis = Hypothesis(factors("youngs_modulus"), (added,))
        fits["support_stiffness", where] = fit(simulator, hypothesis, hypothesis.start(), steps=0)
    [found] = next_records(bench(), fits, [short], step=rotor_bench.STEP, every=4, alone=True)
    assert found.detectability > DISTINGUISHABLE


def test_a_plan_that_the_rotor_bench_cannot_run_says_why() -> None:
    course = ((0.0, 1.0), (0.0, 50.0))
    with pytest.raises(hm.ParameterError, match="no input 'load_torque'"):
        bench().planned(Plan(name="a", inputs={"load_torque": course}, duration=1.0, every=rotor_bench.SAMPLE_TIME))
    with pytest.raises(hm.ParameterError, match=r"samples every 0\.00025 s"):
        bench().planned(Plan(name="a", inputs={rotor_bench.SPEED: course}, duration=1.0, every=1e-3))


def test_a_cause_that_does_not_go_with_a_place_cannot_be_run_there() -> None:
    # a half sine between two bearings has no place on the overhang: a search that moves it there goes on without it
    scene = rotor_bench.undriven("run_up")
    bow = hm.ShaftBow(amplitude=1e-6, shape="sine")
    tried = [Hypothesis((), (Added(bow, place, "bow"),)) for place in ("rotor_1", "rotor_2")]
    networks = [_network(hypothesis, scene, hypothesis.start()) for hypothesis in tried]
    assert networks[0] is not None
    assert networks[1] is None
