"""Free vibration with which a record begins is taken out of the comparison, and nothing else."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.digest import digest
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.noise import Free, Whitener
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.ringing import LOWEST, POWERS, Ringing, ringing_words
from hdrive_mbs.diagnosis.search import fit_nominal
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.traces import traces
from hdrive_mbs.diagnosis.verify import engine_difference, step_error, verified
from models import jeffcott

EVERY, SAMPLES, NOISE = 5e-4, 4000, 2e-7
ROOTS = (-1.7 + 315.0j, -2.0 + 317.0j)
PROBES = ("right_probe", "left_probe")
STEP = 5e-5


def ringing(amplitude: float, root: complex, first: int = 0) -> np.ndarray:
    t = EVERY * np.arange(SAMPLES - first)
    return np.concatenate((np.zeros(first), amplitude * np.real(np.exp(1j * 0.7 + root * t))))


@pytest.mark.parametrize("coloured", [(0.0, 0.0), (NOISE, 0.95)])
@pytest.mark.parametrize("every", [1, 4])
def test_free_vibration_is_taken_out_also_a_little_off_its_frequency_and_noise_stays_noise(
    every: int, coloured: tuple[float, float]
) -> None:
    rng = np.random.default_rng(3)
    there = np.ones(SAMPLES, bool)
    there[:100] = False
    measured = Measured(channel="x", noise=NOISE, coloured=coloured)
    whiten, free = Whitener(measured, there, every), Free(Ringing(300.0, 100).courses(ROOTS, SAMPLES, EVERY))
    white = NOISE * rng.standard_normal(SAMPLES) * there
    # 0.2 % off: 0.6 rad/s for 0.6 s is 0.35 rad; the third power that is left out is 0.35^3/6 = 0.7 % of the vibration, 5e-5 of its square
    shaken = white + ringing(3e-6, -1.75 + 315.6j, 100)
    seen = there[::every]
    alone, left, before = (float(np.mean(item[seen] ** 2)) for item in (whiten(white, free), whiten(shaken, free), whiten(shaken)))
    samples = np.count_nonzero(seen)
    assert before > 3.0
    assert left == pytest.approx(alone, abs=5e-5 * before)
    if coloured[0] == 0.0:  # the noise that was drawn is white
        assert alone == pytest.approx(1.0, abs=3.0 * math.sqrt(2.0 / samples))


@pytest.mark.parametrize("aside", [-15.0, -10.0, 10.0, 20.0])
@pytest.mark.parametrize("decay", [1.7, 4.0])
def test_of_a_vibration_that_goes_on_beside_it_as_much_is_lost_as_laguerre_functions_hold(decay: float, aside: float) -> None:
    """t^p exp(-d t), p = 0, 1, .., made orthonormal, are Laguerre functions, each with the spectrum 2 d/(d^2 + w^2) (Szego, Orthogonal
    Polynomials, 5.1): of a vibration that lasts for T they hold 2 d/(T (d^2 + D^2)) each, D aside.  What it does at the other side of
    zero, 2 w away, adds a share of some D/w to that."""
    rate, samples = 315.0, 24_000
    there = np.ones(samples, bool)
    whiten = Whitener(Measured(channel="x", noise=NOISE), there)
    free = Free(Ringing(300.0, 0).courses((complex(-decay, rate),), samples, EVERY))
    other = np.sin((rate + aside) * EVERY * np.arange(samples))
    kept = float(np.sum(whiten(other, free) ** 2) / np.sum(whiten(other) ** 2)) * (1.0 - 2 * POWERS / samples)  # without degrees of freedom
    held = POWERS * 2.0 * decay / (samples * EVERY * (decay**2 + aside**2))
    assert 1.0 - kept == pytest.approx(held, rel=abs(aside) / rate)


def test_columns_of_equal_noise_share_what_leaves_it_out() -> None:
    free = Free(Ringing(300.0, 0).courses(ROOTS, SAMPLES, EVERY))
    there = np.ones(SAMPLES, bool)
    for name, noise in (("x", 1.0), ("y", 1.0), ("x", 2.0)):
        Whitener(Measured(channel=name, noise=noise), there)(np.zeros(SAMPLES), free)
    assert len(free._known) == 2


def test_courses_begin_with_the_record_and_have_length_one() -> None:
    courses = Ringing(300.0, 50).courses(ROOTS, 1000, EVERY)
    assert courses.shape == (1000, len(ROOTS) * POWERS * 2)
    assert not courses[:50].any()
    np.testing.assert_allclose(np.linalg.norm(courses, axis=0), 1.0)
    assert Ringing(300.0, 50).courses((), 1000, EVERY).shape == (1000, 0)


# -- of a line -----------------------------------------------------------------------------------------


def line() -> hm.Scene:
    """A disc that is lightly damped: free vibration halves in 0.4 s."""
    return jeffcott.build(
        eccentricity=20e-6, damping_ratio=0.008, bearing_stiffness=5e6, bearing_damping=100.0, torque=40.0, final_speed=320.0
    )


def bench(scene: hm.Scene, run_in: float) -> Bench:
    drive = next(name for name, part in scene.parts.items() if isinstance(part, hm.DriveTorque))
    return hm.Bench(
        scene=scene,
        knowledge={"disc": hm.Uncertain(paths=("disc.mass",), sigma=0.02)},
        measured={name: hm.Measured(channel=name, noise=NOISE) for name in ("disc.x", "disc.y")},
        inputs={
            "angle": hm.Input(path=f"{drive}.characteristic", law=lambda t, angle: hm.IdealSpeedMotor(motion=hm.smoothed_motion(t, angle)))
        },
        run_in=run_in,
        settled=False,
    )


def logged(scene: hm.Scene) -> hm.Record:
    """A run-up of a scene from behind its critical speed on, where it rings from the passage, on the multibody engine."""
    run = hm.simulate(scene, 2.0, solver=hm.RungeKutta4(step=STEP), progress=False)
    fold = round(EVERY / STEP)
    turning = run["disc.speed"].values
    first = int(np.argmax(turning > 1.15 * critical()))
    samples = slice(first, None, fold)
    times = run.times[samples] - run.times[first]
    rng = np.random.default_rng(5)
    columns = [
        hm.TimeHistory(name, "m", times, run[name].values[samples] + NOISE * rng.standard_normal(len(times)))
        for name in ("disc.x", "disc.y")
    ]
    return hm.Record.of("run", [hm.TimeHistory("angle", "rad", times, run["disc.angle"].values[samples]), *columns])


@pytest.fixture(scope="module")
def record() -> hm.Record:
    return logged(line())


def critical() -> float:
    return float(np.min(hm.campbell(line(), np.linspace(0.0, 400.0, 9)).critical_speeds))


def left(known: Bench, record: hm.Record, *, ringing: bool = True) -> float:
    trials = [trial if ringing else dataclasses.replace(trial, ringing=None) for trial in known.trials(record)]
    simulator = Simulator(trials, STEP)
    hypothesis = Hypothesis(factors=())
    [found] = simulator.residuals(hypothesis, [np.zeros(0)])
    assert found is not None
    return float(np.mean(found[simulator.used] ** 2))


def test_a_run_up_that_is_cut_out_behind_its_critical_speed_is_reproduced(record: hm.Record) -> None:
    known = bench(line(), 0.3)
    assert left(known, record, ringing=False) > 100.0
    assert left(known, record) == pytest.approx(1.0, abs=3.0 * math.sqrt(2.0 / (2 * len(record.times))))
    [trial] = known.trials(record)
    assert trial.ringing is not None
    assert 0 < len(trial.ringing.roots(trial.scene, EVERY)) <= LOWEST
    [words] = ringing_words([trial])
    assert "'run' begins in rotation" in words
    assert digest(trial.ringing) != digest(dataclasses.replace(trial.ringing, first=1))


@pytest.mark.parametrize("off", [0.01, 0.03, -0.03])
def test_a_modulus_is_found_from_beside_its_data_sheet_although_the_line_rings(off: float) -> None:
    """3 % of it are 1.5 % of the frequencies, 3.5 rad/s: several radians while it rings."""
    scene = line()
    moduli = tuple(path for path in scene.parameters() if path.endswith("youngs_modulus"))
    true = scene.replacing({path: (1.0 + off) * scene.parameters()[path].value for path in moduli})
    known = dataclasses.replace(bench(scene, 0.3), knowledge={"shaft": hm.Uncertain(paths=moduli, sigma=0.03)})
    simulator = Simulator(known.trials(logged(true)), STEP)
    fitted = fit_nominal(simulator, factors_of(known))
    [moved], deviation = 0.03 * fitted.z, 0.03 * math.sqrt(fitted.covariance[0, 0])
    assert moved == pytest.approx(off, abs=3.0 * deviation)
    assert deviation < 2e-4
    samples = np.count_nonzero(simulator.fit)
    assert fitted.chi_fit == pytest.approx(1.0, abs=3.0 * math.sqrt(2.0 / samples))


def test_without_a_run_in_or_a_line_that_bends_nothing_is_taken_out(record: hm.Record) -> None:
    [trial] = bench(line(), 0.0).trials(record)
    assert trial.ringing is None
    assert ringing_words([trial]) == ()
    assert Ringing(0.0, 5).roots(line(), 10.0) == ()  # sampled too slowly for any of it


def test_a_law_with_which_the_line_finds_no_rest_rings_like_the_nominal_line(record: hm.Record, monkeypatch: pytest.MonkeyPatch) -> None:
    trials = bench(line(), 0.3).trials(record)
    hypothesis = Hypothesis(factors=())
    [before] = Simulator(trials, STEP).residuals(hypothesis, [np.zeros(0)])
    roots = Ringing.roots
    monkeypatch.setattr(Ringing, "roots", lambda ringing, scene, every: roots(ringing, scene, every) if scene is trials[0].scene else ())
    [found] = Simulator(trials, STEP).residuals(hypothesis, [np.zeros(0)])
    np.testing.assert_array_equal(found, before)
    monkeypatch.setattr(Ringing, "roots", lambda ringing, scene, every: ())
    [found] = Simulator(trials, STEP).residuals(hypothesis, [np.zeros(0)])
    assert found is not None
    assert float(np.mean(found**2)) > 100.0


def test_pictures_show_the_model_with_it(record: hm.Record) -> None:
    simulator = Simulator(bench(line(), 0.3).trials(record), STEP)
    fitted = fit(simulator, Hypothesis(factors=()), np.zeros(0), steps=0)
    for trace in traces(simulator, fitted, fitted, fitted):
        there = np.isfinite(trace.measured)
        assert float(np.std((trace.measured - trace.nominal)[there])) < 2.0 * NOISE


def test_the_engine_is_compared_without_the_error_of_its_own_step(record: hm.Record, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of second order, on a line that whirls on for 100 rad, with a step of half of that of the search, which is of fourth order.

    By a rule of fourth order itself, and where that is not stable by extrapolation.
    """
    sharp = {name: hm.Measured(channel=name, noise=2e-9) for name in ("disc.x", "disc.y")}
    simulator = Simulator(dataclasses.replace(bench(line(), 0.2), measured=sharp).trials(record.between(0.0, 0.2)), STEP)
    fitted = fit(simulator, Hypothesis(factors=()), np.zeros(0), steps=0)
    monkeypatch.setattr("hdrive_mbs.diagnosis.verify.FINER", (2.0, 4.0))
    explicit = engine_difference(simulator, fitted)
    monkeypatch.setattr("hdrive_mbs.diagnosis.verify.EXPLICIT", 1e-3)
    sharpened = engine_difference(simulator, fitted)
    monkeypatch.setattr("hdrive_mbs.diagnosis.verify.AGREES", math.inf)
    plain = engine_difference(simulator, fitted)
    assert plain > 0.3
    # what the extrapolation leaves is of fourth order: some (w h)^2 of it, 2e-5 at 240 rad/s, and what the search errs
    assert sharpened < 0.01 * plain
    assert explicit < 0.01 * plain
    assert explicit != sharpened


def test_what_the_step_of_the_search_errs_by_is_told_as_its_own(record: hm.Record) -> None:
    """Engine and search go by the same rule with the same step then, and agree; half of it leaves a sixteenth of the error."""
    sharp = {name: hm.Measured(channel=name, noise=5e-13) for name in ("disc.x", "disc.y")}
    trials = dataclasses.replace(bench(line(), 0.2), measured=sharp).trials(record.between(0.0, 0.2))
    simulator = Simulator(trials, STEP)
    fitted = fit(simulator, Hypothesis(factors=()), np.zeros(0), steps=0)
    [own], [fine] = (Simulator(trials, STEP, parts=parts).columns(fitted.hypothesis, fitted.z) for parts in (1, 16))
    error = max(float(np.sqrt(np.mean((own[name] - fine[name]) ** 2))) for name in own) / 5e-13
    assert error > 0.3
    # the next order is (w h)^2 of it, 1.5e-4 at 240 rad/s
    assert step_error(simulator, fitted) == pytest.approx(15.0 / 16.0 * error, rel=1e-2)
    found = verified(simulator, fitted)
    assert found.differs
    assert "multibody engine agree" in found.text
    assert f"step={0.5 * STEP:.3g}" in found.text
    assert engine_difference(simulator, fitted) < 1e-4
