"""Which record to take next: predicted detectability, plans within limits, and the multisine made for two causes."""

from __future__ import annotations

import dataclasses
import functools
import math

import numpy as np
import pytest
from scipy.optimize import minimize

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.bench import Bench, Input, Uncertain
from hdrive_mbs.diagnosis.experiment.choose import next_records, separation
from hdrive_mbs.diagnosis.experiment.detectability import DISTINGUISHABLE, Predictions, detectability, holding, least_squares
from hdrive_mbs.diagnosis.experiment.limits import MARGIN, Limits, limits_of
from hdrive_mbs.diagnosis.experiment.menu import standard_menu
from hdrive_mbs.diagnosis.experiment.multisine import low_phases, multisine, schroeder_phases
from hdrive_mbs.diagnosis.experiment.optimise import optimised_multisine
from hdrive_mbs.diagnosis.experiment.plan import Plan
from hdrive_mbs.diagnosis.experiment.rotor_menu import rotor_menu
from hdrive_mbs.diagnosis.experiment.within import largest, nominal_model, peaks
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Added, FloatArray, Hypothesis
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record
from tests.unit import rotor_scenes
from tests.unit.diagnosis_cases import standing

EVERY, STEP, SECONDS = 1e-3, 5e-4, 1.0
"""Sample time, step of the integration and length of the records [s]."""
TORQUE_LIMIT = 3.0
LIMITS = Limits(speed=60.0, torque=2.5, load=1.0)
COMPLIANCE, FRICTION, DRAG = ("extra_compliance", "shaft"), ("friction", "load"), ("viscous", "load")


@functools.cache
def bench() -> Bench:
    """Servo motor, shaft and braked load: 35 Hz on the shaft, which is known to 1 %."""
    reference = hm.SpeedTable(times=(0.0, 1.0), speeds=(0.0, 0.0))
    servo = hm.ServoMotor(torque_limit=TORQUE_LIMIT, proportional_gain=0.3, integral_gain=3.0, reference=reference)
    scene = hm.Scene(
        name="small train",
        parts={
            "motor": hm.Motor(inertia=2e-3, characteristic=servo),
            "shaft": hm.Shaft(stiffness=60.0, damping=0.05),
            "load": hm.Load(inertia=3e-3, viscous=2e-3, torque=hm.TableTorque(times=(0.0, 1.0), torques=(0.0, 0.0))),
        },
        connections=[("motor", "shaft", "load")],
    )
    return Bench(
        scene=scene,
        knowledge={
            "motor_inertia": Uncertain(paths=("motor.inertia",), sigma=0.03),
            "load_inertia": Uncertain(paths=("load.inertia",), sigma=0.03),
            "stiffness": Uncertain(paths=("shaft.stiffness",), sigma=0.01),
            "drag": Uncertain(paths=("load.viscous",), sigma=0.3),
        },
        measured={
            "motor_torque": Measured(channel="motor.torque", noise=0.2),
            "motor_angle": Measured(channel="motor.angle", noise=1e-4),
            "load_angle": Measured(channel="load.angle", noise=3e-4),
        },
        inputs={
            "speed": Input(path="motor.characteristic.reference", law=lambda t, v: hm.SpeedTable(times=t, speeds=v)),
            "brake": Input(path="load.torque", law=lambda t, v: hm.TableTorque(times=t, torques=v)),
        },
    )


def factors() -> tuple[Factor, ...]:
    known = bench()
    return tuple(
        Factor(path=item.paths[0], name=name, nominal=dict(zip(item.paths, known.nominal(name), strict=True)), sigma=item.sigma)
        for name, item in known.knowledge.items()
    )


def soft(compliance: float) -> Hypothesis:
    return Hypothesis(factors(), (Added(hm.SeriesCompliance(compliance=compliance), "shaft", "soft"),))


def rubbing(coulomb: float) -> Hypothesis:
    return Hypothesis(factors(), (Added(hm.CoulombStribeckFriction(coulomb=coulomb, smoothing_speed=0.5), "load", "friction"),))


def dragging(coefficient: float) -> Hypothesis:
    return Hypothesis(factors(), (Added(hm.ViscousDrag(coefficient=coefficient), "load", "drag"),))


def plan(name: str, speed: tuple[tuple[float, ...], tuple[float, ...]], brake: tuple[tuple[float, ...], tuple[float, ...]]) -> Plan:
    return Plan(name=name, inputs={"speed": speed, "brake": brake}, duration=SECONDS, every=EVERY)


NO_BRAKE = ((0.0, 1.0), (0.0, 0.0))
RUN_UP = plan("run-up", ((0.0, 0.1, 1.0), (0.0, 0.0, 36.0)), NO_BRAKE)
LOAD_STEP = plan("load step", ((0.0, 0.1, 0.3), (0.0, 0.0, 30.0)), ((0.4, 0.41, 0.6, 0.61, 0.8, 0.81), (0.0, 2.0, 2.0, -2.0, -2.0, 0.0)))


def shown(hypothesis: Hypothesis, z: FloatArray, *plans: Plan, rng: np.random.Generator | None = None) -> list[Trial]:
    """Records of plans as a model makes them, with the bench's noise if there is a generator; all but the last sample to be fitted."""
    trials = [trial for item in plans for trial in bench().planned(item)]
    found = []
    for trial, columns in zip(trials, Simulator(trials, STEP).columns(hypothesis, z), strict=True):
        noise = {name: 0.0 if rng is None else rng.normal(0.0, trial.measured[name].white, trial.samples) for name in columns}
        last = np.arange(trial.samples) == trial.samples - 1
        found.append(dataclasses.replace(trial, columns={name: columns[name] + noise[name] for name in columns}, held_out=last))
    return found


def as_given(hypothesis: Hypothesis) -> Fitted:
    """A hypothesis at its start values, as if records had left it there without saying anything of its parameters."""
    return standing(hypothesis, np.zeros((hypothesis.size, hypothesis.size)))


@functools.cache
def after_run_up() -> tuple[Fitted, Fitted]:
    """A soft coupling and friction at the load, each fitted to a run-up with a soft coupling."""
    truth = soft(1.3e-3)
    simulator = Simulator(shown(truth, truth.start(), RUN_UP, rng=np.random.default_rng(1)), STEP)
    return tuple(fit(simulator, item, item.start(), steps=30, enough=1e-3) for item in (truth, rubbing(1e-2)))  # type: ignore[return-value]


def test_a_run_up_does_not_tell_a_soft_coupling_from_friction_and_a_load_step_does() -> None:
    coupling, friction = after_run_up()
    assert 2.0 * abs(coupling.cost - friction.cost) < DISTINGUISHABLE  # the run-up itself has not told them apart
    for alone in (True, False):
        assert detectability(bench().planned(RUN_UP), coupling, friction, step=STEP, alone=alone) < DISTINGUISHABLE
        assert detectability(bench().planned(LOAD_STEP), coupling, friction, step=STEP, alone=alone) > DISTINGUISHABLE


def test_next_records_puts_the_load_step_before_the_run_up() -> None:
    coupling, friction = after_run_up()
    found = next_records(bench(), {COMPLIANCE: coupling, FRICTION: friction}, [RUN_UP, LOAD_STEP])
    assert [item.record for item in found] == ["load step", "run-up"]
    assert found[0].detectability > DISTINGUISHABLE > found[1].detectability
    assert {found[0].first, found[0].second} == {COMPLIANCE, FRICTION}


def test_processes_that_share_the_plans_come_to_the_same() -> None:
    coupling, friction = after_run_up()
    fits, plans, said = {COMPLIANCE: coupling, FRICTION: friction}, [RUN_UP, LOAD_STEP], []
    alone = next_records(bench(), fits, plans)
    with Team(2) as team:
        shared = next_records(bench(), fits, plans, team=team, report=lambda *words: said.append(words))
    assert [(item.record, item.first, item.second) for item in shared] == [(item.record, item.first, item.second) for item in alone]
    np.testing.assert_allclose([item.detectability for item in shared], [item.detectability for item in alone], rtol=1e-9)
    assert said == [("planning the next record", k, 2) for k in range(3)]


@pytest.mark.parametrize("alone", [True, False], ids=["by itself", "together with the run-up"])
def test_predicted_detectability_is_the_chi_square_that_noisy_records_show(alone: bool) -> None:
    """With e = W(S_1 - S_2) and noise n, the least chi-square of the second model is (e + n)^T M (e + n), M = 1 - J (J^T J + H)^-1 J^T.

    Its mean above n.n is D - p with D = e^T M e and p = tr(1 - M), the number of parameters that the record determines; its
    variance is 4 e^T M^2 e + 2 tr (1 - M)^2 <= 4 D + 2 p.  Truth and the prior of the fit have the nominal parameters.
    Together with the run-up, to which both models were fitted without noise, chi-square there has no noise to begin with.
    """
    truth, other = soft(6e-4), rubbing(2e-3)  # small enough for all parameters to stay within 5 sigma
    plans = (LOAD_STEP,) if alone else (RUN_UP, LOAD_STEP)
    first, second = as_given(truth), as_given(other)
    if not alone:  # e is that of both records, the curvature that of the run-up
        simulator = Simulator(shown(truth, truth.start(), RUN_UP), STEP)
        second = fit(simulator, other, other.start(), steps=30, enough=1e-6, share=0.0)
    predictions = Predictions(bench().planned(LOAD_STEP), (first, second), step=STEP)
    predicted = predictions.between(0, 1, alone=alone)
    before = 0.0 if alone else float(second.residuals @ second.residuals) + 2.0 * other.prior_cost(second.z)
    columns, held = predictions.columns(1), holding(second, alone=alone)
    parameters = float(np.trace(np.linalg.lstsq(columns.T @ columns + held, columns.T @ columns, rcond=None)[0]))
    assert predicted > DISTINGUISHABLE
    assert 3.0 < parameters < other.size

    rng, draws, gains = np.random.default_rng(5), 8, []
    clean = shown(truth, truth.start(), *plans)
    for _ in range(draws):
        noisy, power = [], 0.0
        for trial in clean:
            quiet = trial.name == RUN_UP.name
            noise = {name: 0.0 if quiet else rng.normal(0.0, item.white, trial.samples) for name, item in trial.measured.items()}
            power += sum(float(np.sum((noise[name] / trial.measured[name].white) ** 2)) for name in noise)
            noisy.append(dataclasses.replace(trial, columns={name: trial.columns[name] + noise[name] for name in noise}))
        found = fit(Simulator(noisy, STEP), other, second.z, steps=12, enough=0.01)
        gains.append(float(found.residuals @ found.residuals) + 2.0 * other.prior_cost(found.z) - power - before)
    deviation = math.sqrt((4.0 * predicted + 2.0 * parameters) / draws)
    assert abs(float(np.mean(gains)) - (predicted - parameters)) < 3.0 * deviation


def test_causes_that_are_the_same_equation_are_never_told_apart() -> None:
    """Viscous drag c added to a load whose own is d is the same as a load with d + c."""
    own, extra = bench().nominal("drag")[0], 3e-3
    loose = Hypothesis(factors(), loose={"drag": 10.0})
    z = loose.start()
    z[3] = extra / (own * 0.3 * 10.0)  # straight in its coordinate
    parameter = dataclasses.replace(as_given(loose), z=z)
    effect = as_given(dragging(extra))
    menu = standard_menu(bench(), LIMITS, seconds=0.5, every=EVERY)
    found = next_records(bench(), {DRAG: effect, ("parameter", "drag"): parameter}, menu)
    assert len(found) == len(menu)
    assert max(item.detectability for item in found) < 1e-6
    # and a cause that is not the same is told from both by most of these records
    assert detectability(bench().planned(menu[0]), effect, as_given(soft(2e-2)), step=STEP) > 1.0


def test_a_group_counts_by_its_worst_pair() -> None:
    fits = {COMPLIANCE: as_given(soft(4e-3)), FRICTION: as_given(rubbing(5e-2)), DRAG: as_given(dragging(1e-3))}
    found = separation(bench(), fits, LOAD_STEP)
    labels = list(fits)
    by_pair = {
        (a, b): min(detectability(bench().planned(LOAD_STEP), fits[x], fits[y], step=STEP) for x, y in ((a, b), (b, a)))
        for k, a in enumerate(labels)
        for b in labels[k + 1 :]
    }
    assert found.detectability == pytest.approx(min(by_pair.values()), rel=1e-6)
    assert by_pair[found.first, found.second] == min(by_pair.values())


def test_what_shows_the_same_as_fitted_is_named_without_any_jacobian(monkeypatch: pytest.MonkeyPatch) -> None:
    """Friction at stations of a stiff shaft: of four places that tie, six pairs both ways round would take most of a minute."""
    fits = {COMPLIANCE: as_given(soft(4e-3)), FRICTION: as_given(rubbing(5e-2)), ("drag", "hub"): as_given(dragging(1e-3))}
    fits |= {DRAG: as_given(dragging(1e-3 * (1.0 + 1e-9)))}
    monkeypatch.setattr("hdrive_mbs.diagnosis.experiment.detectability.jacobian", lambda *given: pytest.fail("a Jacobian was made"))
    found = separation(bench(), fits, LOAD_STEP)
    assert {found.first, found.second} == {("drag", "hub"), DRAG}
    assert 0.0 < found.detectability < 1e-6


def test_a_linear_model_comes_as_close_as_any_optimiser_brings_it() -> None:
    rng = np.random.default_rng(2)
    difference, columns = rng.normal(size=50), rng.normal(size=(50, 4)) * (1.0, 1e3, 1e-3, 0.0)
    held, free = np.diag((1.0, 0.0, 2e-6, 0.0)), (np.full(4, -np.inf), np.full(4, np.inf))

    def cost(c: FloatArray) -> float:
        scaled = c * (1.0, 1e-3, 1e3, 1.0)
        left = difference + columns @ scaled
        return float(left @ left + scaled @ held @ scaled)

    assert least_squares(difference, columns, held, free)[1] == pytest.approx(float(minimize(cost, np.zeros(4)).fun), rel=1e-6)
    bounded = minimize(cost, np.zeros(4), bounds=[(None, None), (0.05, 0.5), (None, None), (None, None)])
    found, least = least_squares(
        difference, columns, held, (np.array((-np.inf, 5e-5, -np.inf, -np.inf)), np.array((np.inf, 5e-4, np.inf, np.inf)))
    )
    assert least == pytest.approx(float(bounded.fun), rel=1e-6)
    assert 5e-5 <= found[1] <= 5e-4
    # what the columns span is explained away to rounding
    spanned = columns @ np.array([1.0, 1e-3, 1e3, 0.0])
    assert least_squares(spanned, columns, np.zeros((4, 4)), free)[1] < 1e-18 * float(spanned @ spanned)


def test_what_the_old_records_know_of_the_parameters_makes_a_new_one_sharper() -> None:
    coupling, friction = after_run_up()
    alone, together = (detectability(bench().planned(LOAD_STEP), coupling, friction, step=STEP, alone=alone) for alone in (True, False))
    assert together >= alone


def test_every_plan_of_the_menu_keeps_the_limits_on_the_engine() -> None:
    menu = standard_menu(bench(), LIMITS, seconds=SECONDS, every=EVERY)
    assert len({item.name for item in menu}) == len(menu) >= 10
    for item in menu:
        assert np.abs(item.sampled("speed")).max() <= LIMITS.speed
        assert np.abs(item.sampled("brake")).max() <= LIMITS.load
    used = [peaks(bench(), item, [nominal_model()], STEP).share(LIMITS) for item in menu]
    assert max(used) <= 1.0
    for item in (menu[0], menu[int(np.argmax(used))]):
        [trial] = bench().planned(item)
        run = hm.simulate(trial.scene, SECONDS, solver=hm.RungeKutta4(step=STEP))
        # 0.2 %: the engine meets every sample, and the integration differs by less
        assert np.abs(run["motor.torque"].values).max() <= 1.002 * LIMITS.torque
        assert np.abs(run["motor.speed"].values).max() <= 1.002 * LIMITS.speed


def test_a_plan_that_is_too_hard_at_any_size_is_none() -> None:
    brake = Plan(name="hard", inputs={"brake": ((0.0, 0.1), (0.0, 50.0))}, duration=0.5, every=EVERY)
    assert largest(bench(), lambda size: brake, LIMITS, [nominal_model()], STEP) is None


def test_an_optimised_multisine_beats_the_menu_within_the_limits_or_says_that_it_does_not() -> None:
    coupling, friction = after_run_up()
    menu = [RUN_UP, *standard_menu(bench(), LIMITS, seconds=SECONDS, every=EVERY)]
    usual = next_records(bench(), {COMPLIANCE: coupling, FRICTION: friction}, menu)

    def optimised(evaluations: int, seed: int) -> tuple[float, float, str]:
        found = optimised_multisine(
            bench(), coupling, friction, LIMITS, seconds=SECONDS, every=EVERY, seed=seed, evaluations=evaluations, menu=menu, thinned=4
        )
        assert found.rival == usual[0].record
        assert found.rival_detectability == pytest.approx(usual[0].detectability, rel=1e-6)
        fits = [(item.hypothesis, item.z) for item in (coupling, friction)]
        assert peaks(bench(), found.plan, [nominal_model(), *fits], STEP).share(LIMITS) <= 1.0
        both = separation(bench(), {COMPLIANCE: coupling, FRICTION: friction}, found.plan)
        assert both.detectability == pytest.approx(found.detectability, rel=1e-6)
        return found.detectability, found.rival_detectability, str(found)

    won, rival, says = optimised(24, seed=0)
    assert won > rival
    assert " beats " in says
    lost, rival, says = optimised(1, seed=0)  # falling lines about zero, as they come
    assert lost < rival
    assert "does NOT beat" in says


def test_phases_keep_the_peak_of_many_lines_low() -> None:
    """Twenty equal lines in phase have a crest factor of sqrt(2 * 20) = 6.3; Schroeder's phases come to about 1.7."""
    lines, amplitudes = tuple(range(1, 21)), np.ones(20)
    points = np.arange(4096) / 4096.0

    def crest(phases: FloatArray) -> float:
        wave = multisine(points, lines, amplitudes, phases)
        return float(np.abs(wave).max() / np.sqrt(np.mean(wave**2)))

    assert crest(np.zeros(20)) == pytest.approx(math.sqrt(40.0))
    assert crest(schroeder_phases(amplitudes)) < 1.9
    assert crest(low_phases(lines, amplitudes)) < min(crest(schroeder_phases(amplitudes)), 1.6)


def record(**columns: tuple[str, FloatArray]) -> Record:
    times = EVERY * np.arange(200)
    return Record(
        name="seen",
        times=times,
        channels={name: Measurement(name=name, unit=unit, values=values) for name, (unit, values) in columns.items()},
    )


def test_limits_are_those_that_the_records_have_kept() -> None:
    speed, brake = np.linspace(0.0, -40.0, 200), np.linspace(0.0, 0.7, 200)
    found = limits_of(bench(), [record(speed=("rad/s", speed), brake=("N m", brake))])
    assert found == Limits(speed=40.0, torque=MARGIN * TORQUE_LIMIT, load=0.7)
    with pytest.raises(ParameterError, match=r"limits=Limits\("):
        limits_of(bench(), [record(brake=("N m", brake))])


def test_records_set_length_sampling_and_limits_of_the_menu() -> None:
    fits = {COMPLIANCE: as_given(soft(4e-3)), FRICTION: as_given(rubbing(5e-2))}
    speed, brake = np.linspace(0.0, -40.0, 200), np.linspace(0.0, 0.7, 200)
    found = next_records(bench(), fits, records=[record(speed=("rad/s", speed), brake=("N m", brake))])
    assert "load cycle at standstill" in {item.record for item in found}
    assert [item.detectability for item in found] == sorted((item.detectability for item in found), reverse=True)


def rotor_bench() -> Bench:
    """A disc on a support (critical speed 316 rad/s) under speed control, with a hammer at it."""
    reference = hm.SpeedTable(times=(0.0, 1.0), speeds=(0.0, 0.0))
    servo = hm.ServoMotor(torque_limit=20.0, proportional_gain=0.5, integral_gain=1.0, reference=reference)
    scene = hm.Scene(
        name="disc on a support",
        parts={
            "drive": hm.DriveTorque(characteristic=servo),
            "disc": hm.Rotor(mass=2.0, polar_inertia=0.01, transverse_inertia=0.006, eccentricity=1e-5),
            "bearing": hm.Bearing(law=rotor_scenes.support()),
            "hammer": hm.LateralForce(times=(0.0, 1.0), forces_x=(0.0, 0.0)),
        },
        connections=[("drive", "disc", "bearing"), ("hammer", "disc")],
    )
    return Bench(
        scene=scene,
        knowledge={"mass": Uncertain(paths=("disc.mass",), sigma=0.01)},
        measured={"x": Measured(channel="disc.x", noise=2e-7), "y": Measured(channel="disc.y", noise=2e-7)},
        inputs={
            "speed": Input(path="drive.characteristic.reference", law=lambda t, v: hm.SpeedTable(times=t, speeds=v)),
            "force": Input(path="hammer", law=lambda t, v: hm.LateralForce(times=t, forces_x=v)),
        },
    )


def test_a_hammer_at_standstill_says_nothing_of_unbalance_and_turning_does() -> None:
    known = rotor_bench()
    mass = Factor(path="disc.mass", name="mass", nominal={"disc.mass": 2.0}, sigma=0.01)
    unbalanced = as_given(Hypothesis((mass,), (Added(hm.RotorUnbalance(unbalance=1e-5), "disc", "unbalance"),)))
    balanced = as_given(Hypothesis((mass,)))
    critical = rotor_scenes.CRITICAL
    menu = rotor_menu("speed", top=500.0, seconds=0.6, every=5e-4, critical=(critical, 1200.0), hammers={"force": "disc"}, blow=200.0)
    assert [item.name for item in menu] == ["slow run-up", f"dwell at half of {critical:.4g} rad/s", "coast-down", "hammer at disc"]
    assert max(float(np.abs(item.sampled("speed")).max()) for item in menu) == pytest.approx(500.0, rel=1e-3)
    assert float(menu[1].sampled("speed")[-1]) == pytest.approx(critical / 2.0)
    assert float(menu[3].sampled("force").max()) == pytest.approx(200.0, rel=0.05)
    found = {item.name: detectability(known.planned(item), unbalanced, balanced, step=2.5e-4) for item in menu}
    assert found["hammer at disc"] < 1e-6
    assert min(found["slow run-up"], found["coast-down"]) > DISTINGUISHABLE
    with pytest.raises(ParameterError, match="four samples"):
        rotor_menu("speed", top=500.0, seconds=0.6, every=5e-4, hammers={"force": "disc"})
    with pytest.raises(ParameterError, match="top = 0"):
        rotor_menu("speed", top=0.0, seconds=0.6, every=5e-4)


def test_bad_plans_and_groups_say_what_is_wrong() -> None:
    with pytest.raises(ParameterError, match="64 samples"):
        Plan(name="short", inputs={}, duration=0.01, every=EVERY)
    with pytest.raises(ParameterError, match="must rise"):
        Plan(name="back", inputs={"speed": ((0.0, 0.0), (1.0, 2.0))}, duration=1.0, every=EVERY)
    with pytest.raises(ParameterError, match="spede"):
        bench().planned(Plan(name="typo", inputs={"spede": ((0.0,), (1.0,))}, duration=1.0, every=EVERY))
    with pytest.raises(ParameterError, match="overrides planned"):
        dataclasses.replace(bench(), inputs={}).planned(RUN_UP)
    with pytest.raises(ParameterError, match="takes two"):
        next_records(bench(), {FRICTION: as_given(rubbing(0.1))}, [RUN_UP])
    with pytest.raises(ParameterError, match="menu is empty"):
        next_records(bench(), {COMPLIANCE: as_given(soft(1e-3)), FRICTION: as_given(rubbing(0.1))}, [])
    with pytest.raises(ParameterError, match="greater than 0"):
        Limits(speed=0.0, torque=1.0)
    with pytest.raises(ParameterError, match="no speed reference"):
        standard_menu(dataclasses.replace(bench(), inputs={}), LIMITS, seconds=1.0, every=EVERY)
