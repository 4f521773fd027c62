"""Forces planted in a line of two rotors at known places, by the compiled model itself with its own noise."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import all_samples, gather
from hdrive_mbs.diagnosis.at_the_place import at_the_place
from hdrive_mbs.diagnosis.beginnings import begun_at
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.force_orders import ForceOrders
from hdrive_mbs.diagnosis.ground import screen_from
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.locate import Localiser
from hdrive_mbs.diagnosis.locate import spectra as spectra_of_rows
from hdrive_mbs.diagnosis.locate.linear import Transfers
from hdrive_mbs.diagnosis.locate.motion import KnownForce, columns_of
from hdrive_mbs.diagnosis.locate.observer import Observer, observer
from hdrive_mbs.diagnosis.locate.response import KEPT
from hdrive_mbs.diagnosis.located import located
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.periods import Periods
from hdrive_mbs.diagnosis.result import NOWHERE
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from models import rotor_bench as bench
from tests.unit import diagnosis_cases

SAMPLES, SPEED = 6000, 380.0
"""1.5 s at 4 kHz; rad/s, between the first critical speeds of the bench."""
TIMES = np.asarray(bench.SAMPLE_TIME * np.arange(SAMPLES), float)
FACTORS = tuple(
    Factor(path=bench.PATHS[name][0], name=name, nominal=dict.fromkeys(bench.PATHS[name], bench.NOMINAL[name]), sigma=bench.KNOWLEDGE[name])
    for name in ("bearing_stiffness", "support_stiffness_y", "rotor_1_eccentricity")
)
NOMINAL = Hypothesis(factors=FACTORS)
ORIGIN = np.zeros(NOMINAL.size)


def trial() -> Trial:
    """Steady rotation that the drive end is held to: probes at the rotors, accelerometers on the housings."""
    scene = bench.undriven("run_up")
    channels = bench.CHANNELS | {name: f"probe_{name}" for name in bench.PROBES}
    items = {
        name: Measured(
            channel=channels[name],
            noise=bench.NOISE[name],
            resolution=bench.RESOLUTION[name],
            offset=math.inf if name in bench.OFFSET_FREE else 0.0,
        )
        for name in bench.LATERAL
    }
    return Trial(
        name="steady",
        scene=scene,
        every=bench.SAMPLE_TIME,
        columns={name: np.zeros(SAMPLES) for name in items},
        measured=items,
        held_out=np.zeros(SAMPLES, dtype=bool),
        speeds=dict.fromkeys(bench.POSITIONS, SPEED),
        settled=True,
        motions={"bearing_1": lambda time: SPEED * time},
    )


def turning() -> Trial:
    """The spin under the controller of the run-up: the drive's torque and the angle of a bearing."""
    measured = bench.bench().measured
    return Trial(
        name="turning",
        scene=bench.build("run_up", hammer=dict.fromkeys("xy", (0.0, 0.0))),
        every=bench.SAMPLE_TIME,
        columns={name: np.zeros(SAMPLES) for name in bench.TORSION},
        measured={name: measured[name] for name in bench.TORSION},
        held_out=np.zeros(SAMPLES, dtype=bool),
        speeds=dict.fromkeys(bench.POSITIONS, bench.REFERENCES["run_up"][1][0]),
        settled=True,
    )


def localiser(*forces: KnownForce, errors: dict[str, np.ndarray] | None = None, bare: Trial | None = None) -> Localiser:
    """Of a record with forces that the model lacks, or errors of columns; without a trial, of steady rotation."""
    bare = bare or trial()
    [simulated] = columns_of(Simulator([bare], bench.STEP), 0, NOMINAL, [ORIGIN], forces)
    assert simulated is not None
    rng = np.random.default_rng(11)
    columns = {}
    for name, values in simulated.items():
        item = bare.measured[name]
        offset = 2e-5 * rng.standard_normal() if item.offset else 0.0
        read = values + offset + item.noise * rng.standard_normal(SAMPLES) + (errors or {}).get(name, 0.0)
        columns[name] = item.resolution * np.round(read / item.resolution)
    simulator = Simulator([dataclasses.replace(bare, columns=columns)], bench.STEP)
    found = simulator.residuals(NOMINAL, [ORIGIN])[0]
    assert found is not None
    null = Fitted(
        hypothesis=NOMINAL,
        z=ORIGIN,
        residuals=found,
        cost=0.0,
        curvature=np.eye(3),
        converged=True,
        steps=0,
        chi_fit=1.0,
        chi_held=1.0,
        typical=1.0,
        misfit_held=0.0,
    )
    return Localiser(simulator, null)


def race_flaw(effect: hm.BallPass) -> list[KnownForce]:
    """What a flaw of a race does between ring and housing of bearing 2."""
    forces = effect.force(TIMES, SPEED * TIMES, SPEED, 0.0, 0.0, 0.0, 0.0)
    factors = [{f"bearing_2.{d}": 1.0, f"bearing_2.housing.{d}": -1.0} for d in "xy"]
    return [KnownForce(f"flaw {d}", factor, TIMES, np.asarray(force)) for d, factor, force in zip("xy", factors, forces, strict=True)]


def burst(size: float) -> np.ndarray:
    """A force that no law of the library has: swelling beats near the first resonances of the line (some 400 and 900 rad/s)."""
    return np.asarray(size * np.sin(4.0 * TIMES) ** 2 * (np.sin(410.0 * TIMES) + 0.5 * np.cos(930.0 * TIMES)), float)


def along_x(**factors: float) -> KnownForce:
    return KnownForce("planted", {f"{name.replace('__', '.')}.x": value for name, value in factors.items()}, TIMES, burst(5.0))


@pytest.mark.parametrize(
    ("place", "force"),
    [
        ("rotor_1", along_x(rotor_1=1.0)),
        ("rotor_2", along_x(rotor_2=1.0)),
        ("bearing_2.law", along_x(bearing_2=1.0, bearing_2__housing=-1.0)),
        ("bearing_1.housing", along_x(bearing_1__housing=1.0)),
        ("bearing_2", along_x(bearing_2=1.0)),
    ],
)
def test_an_unknown_force_on_a_line_of_rotors_is_found_where_it_acts(place: str, force: KnownForce) -> None:
    # 5 N move the rotors by micrometres near a resonance, some ten times the noise of the probes
    best = localiser(force).places()[0]
    assert best.at == place
    assert best.probability > 0.5
    assert best.share > 0.9


def test_a_force_that_turns_with_the_shaft_is_found_as_one() -> None:
    turning = [
        KnownForce(f"planted {d}", {f"rotor_2.{d}": 1.0}, TIMES, 5.0 * wave(SPEED * TIMES)) for d, wave in (("x", np.cos), ("y", np.sin))
    ]
    best = localiser(*turning).places()[0]
    assert best.at == "rotor_2" or "rotor_2" in best.tied


def test_a_surface_that_is_not_round_is_found_at_the_sensors_of_its_station() -> None:
    errors = {"r1_x": 2e-6 * np.cos(3.0 * SPEED * TIMES), "r1_y": 2e-6 * np.sin(3.0 * SPEED * TIMES)}
    located = localiser(errors=errors)
    best = located.places()[0]
    assert best.at == "rotor_1.sensors"
    assert best.probability > 0.9
    assert best.sensor
    courses = {course.way: course.force for course in located.force(best.at)}
    inner = slice(600, 5400)
    for column, error in errors.items():
        assert np.std(courses[column][inner] - error[inner]) < 0.2 * np.std(error[inner])


def test_one_probe_in_error_is_found_alone() -> None:
    best = localiser(errors={"r2_y": burst(2e-6)}).places()[0]
    assert best.at == "probe_r2_y"


def test_a_line_of_rotors_without_a_gap_has_it_nowhere() -> None:
    assert localiser().places()[0].at == NOWHERE


def test_two_forces_that_no_single_place_explains_leave_a_doubt() -> None:
    # 100 N on the stiff support beside 5 N on the soft rotor: both move what is near them by micrometres
    course = 100.0 * np.cos(3.0 * TIMES) ** 2 * (np.cos(520.0 * TIMES) + np.sin(760.0 * TIMES))
    located = localiser(along_x(rotor_1=1.0), KnownForce("other", {"bearing_2.housing.y": 1.0}, TIMES, course))
    assert located.doubt.startswith("Not reliable here: the best single place leaves")
    assert not located.trusted
    # 100 N on some 1e7 N/m is far above the noise of 0.25 um; one place of four directions at most cannot make both
    assert located.left > 10.0
    assert located.places()[0].probability < 0.5


def test_a_small_steady_torque_on_the_spin_is_no_place_but_a_doubt() -> None:
    # it shifts the controller's torque by its own size, 0.05 N m: the noise of one sample, seen in 6000, all in one bin
    located = localiser(KnownForce("planted", {"bearing_1": 1.0}, TIMES, np.full(SAMPLES, 0.05)), bare=turning())
    best = located.places()[0]
    assert best.at == NOWHERE
    assert best.probability < 0.5
    assert located.doubt.startswith("No place was found, yet")


def test_a_torque_on_the_spin_is_tied_to_all_places_of_the_stiff_shaft() -> None:
    # the shaft's torsional modes lie far above what a steady torque moves: where it acts along the shaft does not show
    best = localiser(KnownForce("planted", {"bearing_1": 1.0}, TIMES, np.full(SAMPLES, 2.0)), bare=turning()).places()[0]
    assert best.at != NOWHERE
    assert best.probability < 0.5
    assert len(best.tied) >= 3


def test_transfers_are_worked_out_when_they_are_asked_for_and_only_some_are_kept() -> None:
    """Together or one by one, they are those of a system that is solved at each frequency."""
    about = localiser()._about
    [of] = [item.of for item in about.responses]
    names = list(of)
    assert len(names) == len(of) > 3 * KEPT
    assert len(of._kept) <= KEPT
    acting = [name for name in names if about.responses[0].sources[name].along][:KEPT]
    of._kept.clear()
    of.fetch(acting)
    assert list(of._kept) == acting
    together = {name: of[name].copy() for name in acting}
    for name in acting:
        of._kept.clear()
        np.testing.assert_allclose(of[name], together[name], rtol=0.0, atol=1e-9 * np.max(np.abs(together[name])))
    of.fetch([name for name in names if name not in acting])
    assert len(of._kept) <= KEPT
    assert "no such place" not in of
    with pytest.raises(KeyError):
        of["no such place"]
    linear, rates = about.lines[0].linear, 1j * np.array([30.0, 900.0, 2500.0])
    at = [0, 3]
    solved = [
        [c @ np.linalg.solve(s * np.eye(len(a)) - a, b[:, at]) + d[:, at] for s in rates]
        for a, b, c, d in zip(linear.a, linear.b, linear.c, linear.d, strict=True)
    ]
    found = Transfers(linear, rates).of(at)
    np.testing.assert_allclose(found, np.array(solved), rtol=0.0, atol=1e-5 * np.max(np.abs(solved)))  # what a sum over modes may be off by


def test_the_course_of_a_force_on_a_rotor_comes_out() -> None:
    [found] = [force for force in localiser(along_x(rotor_2=1.0)).force("rotor_2") if force.way == "x"]
    inner, force = slice(600, 5400), burst(5.0)
    left = found.force[inner] - force[inner]
    assert np.sqrt(np.mean(left**2)) < 0.2 * np.sqrt(np.mean(force[inner] ** 2))
    assert found.unit == "N"


def test_the_errors_of_an_observer_forget_a_vibration_and_keep_the_noise_white() -> None:
    place = localiser()
    about = place._about
    spectra = about.spectra[0]
    # at the true parameters, the offsets taken out: nothing but noise, of mean square 1 in every band
    left = np.abs(about.likelihood.residuals(0, place._nowhere.z)[1:-1]) ** 2
    by_band = np.add.reduceat(left.mean(axis=(0, 2)), spectra.bands) / spectra.widths
    # n numbers of a complex normal each: mean 1, standard deviation 1/sqrt(n); overlapping windows make it sqrt(1.5) times that
    n = left.shape[0] * left.shape[2] * spectra.widths
    assert np.all(np.abs(by_band[1:] - 1.0)[n[1:] > 300] < 5.0 * np.sqrt(1.5 / n[1:][n[1:] > 300]))


def test_rows_give_the_same_spectra_one_by_one_as_together(monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    for together in (1, 1000):
        monkeypatch.setattr(spectra_of_rows, "TOGETHER", together)
        found.append(localiser()._about.spectra[0].values)
    alone, together_values = found
    assert alone.shape[-1] == 1 + NOMINAL.size + sum(item.offset > 0.0 for item in trial().measured.values())
    for k in range(alone.shape[-1]):
        largest = float(np.max(np.abs(alone[..., k])))
        assert largest > 0.0
        assert together_values[..., k] == pytest.approx(alone[..., k], abs=4.0 * float(np.finfo(np.float32).eps) * largest)


def test_slopes_from_a_few_points_at_a_time_are_those_from_all_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    for at_once in (2, 1000):
        monkeypatch.setattr(spectra_of_rows, "AT_ONCE", at_once)
        found.append(localiser()._about.spectra[0].slopes)
    few, together = found
    assert len(few) == NOMINAL.size > 2
    assert np.all(np.max(np.abs(few), axis=(1, 2)) > 0.0)
    np.testing.assert_array_equal(few, together)


def ringing() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Two oscillators of 300 and 700 rad/s with 0.5 % of critical damping, joined by what is read: x' = A x + B f, y = C x."""
    a = np.zeros((4, 4))
    for k, rate in enumerate((300.0, 700.0)):
        a[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = [[0.0, 1.0], [-(rate**2), -0.01 * rate]]
    b = np.array([[0.0, 0.0], [1.0, 0.3], [0.0, 0.0], [0.2, 1.0]])
    c = np.array([[1.0, 0.0, 0.5, 0.0], [0.2, 0.0, -1.0, 0.0]])
    return a, b, c, np.zeros((2, 2))


def watching(length: int) -> Observer:
    a, b, c, d = (part[None] for part in ringing())
    return observer(a, b, c, d, np.full(2, 1e-9), bench.SAMPLE_TIME, length)


def test_the_transfer_of_an_observer_is_that_of_its_errors() -> None:
    samples = 4096
    watcher = watching(samples)
    rates = np.asarray(2.0 * np.pi * np.arange(samples // 2 + 1) / (samples * bench.SAMPLE_TIME), float)
    for k in range(2):
        impulse = np.zeros((1, 2, samples))
        impulse[0, k, 0] = 1.0
        spectrum = np.fft.rfft(watcher.errors(impulse)[0], axis=-1)
        assert watcher.noise_transfer(rates)[0, :, :, k] == pytest.approx(spectrum.T, abs=1e-9)


@pytest.mark.parametrize("length", [64, 61, 5])
def test_errors_are_those_of_the_recursion_whatever_the_length_of_a_stretch(length: int) -> None:
    a, b, c, d = ringing()
    stretches, samples = 4, 4 * length - 2
    stiffer = np.array([a * (1.0 + 0.05 * k) for k in range(stretches)])
    pushed, read, through = (np.repeat(part[None], stretches, axis=0) for part in (b, c, d))
    watcher = observer(stiffer, pushed, read, through, np.full(2, 1e-9), bench.SAMPLE_TIME, length)
    rows = np.random.default_rng(4).standard_normal((3, 2, samples))
    wanted = np.empty_like(rows)
    state = np.zeros((4, 3))
    for k in range(samples):
        part = k // length
        wanted[:, :, k] = rows[:, :, k] - (watcher.read[part] @ state).T
        state = expm(stiffer[part] * bench.SAMPLE_TIME) @ state + watcher.gain[part] @ wanted[:, :, k].T
    assert watcher.errors(rows) == pytest.approx(wanted, abs=1e-9)


def test_a_force_that_no_column_shows_leaves_the_observer_as_it_is() -> None:
    """A third oscillator that nothing is joined to: a force on it would have to be without limit to show as much as the others."""
    a, b, c, _ = ringing()
    wide = np.zeros((6, 6))
    wide[:4, :4], wide[4:, 4:] = a, [[0.0, 1.0], [-(500.0**2), -5.0]]
    pushed = np.zeros((6, 3))
    pushed[:4, :2], pushed[5, 2] = b, 1.0
    read = np.hstack([c, np.full((2, 2), 1e-19)])
    made = observer(wide[None], pushed[None], read[None], np.zeros((1, 2, 3)), np.full(2, 1e-9), bench.SAMPLE_TIME, 200)
    assert made.gain[0][:4] == pytest.approx(watching(200).gain[0], rel=1e-6)
    assert np.abs(made.gain[0][4:]).max() < 1e-6 * np.abs(made.gain[0]).max()


def test_errors_that_would_grow_are_refused() -> None:
    """A motion that grows and that no column shows: an observer cannot hold it."""
    a, b, c, d = ringing()
    wide = np.zeros((5, 5))
    wide[:4, :4], wide[4, 4] = a, 40.0
    pushed, read = np.vstack([b, np.zeros((1, 2))]), np.hstack([c, np.zeros((2, 1))])
    with pytest.raises(hm.AnalysisError, match=r"grow by a factor of 7\.39 within 0\.05 s"):
        observer(wide[None], pushed[None], read[None], d[None], np.full(2, 1e-9), bench.SAMPLE_TIME, round(0.05 / bench.SAMPLE_TIME))


def test_an_observer_forgets_a_vibration_soon_after_its_force_has_ended() -> None:
    a, b, c, _ = ringing()
    samples, end, later = 3000, 1000, 1200
    moved = expm(np.block([[a, b], [np.zeros((2, 6))]]) * bench.SAMPLE_TIME)
    state, read = np.zeros(4), np.zeros((1, 2, samples))
    for k in range(samples):
        read[0, :, k] = c @ state
        force = np.array([math.sin(300.0 * k * bench.SAMPLE_TIME), 0.0]) if k < end else np.zeros(2)
        state = moved[:4, :4] @ state + moved[:4, 4:] @ force
    errors = watching(samples).errors(read)[0]
    # 50 ms later 0.5 % of damping has left exp(-0.005*300*0.05) = 93 % of the slow vibration
    assert np.max(np.abs(read[0, :, later:])) > 0.5 * np.max(np.abs(read[0, :, :end]))
    assert np.max(np.abs(errors[:, later:])) < 1e-3 * np.max(np.abs(errors[:, :end]))


def test_a_diagnosis_looks_for_the_place_from_the_model_as_given_on_rotor_lines_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """A missing cause bends the refitted model of a rotor line, and the localisation refits on its own."""
    for name, made in {
        "as_given": lambda fine, nominal: "as given",
        "located": lambda fine, about: f"about the model {about}",
    }.items():
        monkeypatch.setattr(gather, name, made)
    monkeypatch.setattr(all_samples, "located", lambda fine, about: f"about the model {about}")
    monkeypatch.setattr(all_samples, "as_given", lambda fine, nominal: "as given")
    monkeypatch.setattr(all_samples, "run_task", lambda fine, task: "refitted")
    drive = diagnosis_cases.bench()
    trials = {"lateral": [trial()], "torsional": drive.trials(diagnosis_cases.quiet()[0])}
    null: Any = SimpleNamespace(chi_fit=100.0, hypothesis=None, z=None)
    for kind, wanted in (("lateral", "as given"), ("torsional", "refitted")):
        fine: Any = SimpleNamespace(trials=trials[kind])
        with Team(1) as team:
            asked = gather._ask_where(team, fine, ())
            place = None if asked is None else gather._told_where(team, asked, lambda *said: None)
            last = all_samples.on_all_samples(team, fine, null, [], place, lambda *said: None)
        assert last.place == f"about the model {wanted}"


@pytest.mark.slow
def test_a_flaw_of_an_inner_race_is_named_with_its_order_from_the_force_at_its_bearing() -> None:
    """Sidebands one order apart, both ways round, and a mean; another law than the one that is tried."""
    order = 4.8586
    flaw = hm.InnerRacePulses(amplitude=20.0, mean=20.0, order=order, sharpness=0.5, direction=0.7, load_zone=0.8)
    simulator = localiser(*race_flaw(flaw), bare=dataclasses.replace(trial(), held_out=TIMES > 1.3))._simulator
    null = fit(simulator, NOMINAL, ORIGIN, steps=0)
    gap = located(simulator, null)
    assert gap.places[0].at == "bearing_2.law"
    assert {force.way for force in gap.forces} == {"x", "y"}
    first = ForceOrders(gap.turned, Periods(simulator, null)).standing_out("turn", 2.0, 7.0)[:3]
    assert min(abs(found - order) for found in first) < 2.0 * np.pi / (SPEED * TIMES[-1])
    tried = candidates(simulator.trials[0].scene, [hm.BallPass, hm.BallPassHarmonics, hm.InnerRacePass])
    with Team(1) as team:
        best = at_the_place(team, simulator, null, gap, tried, lambda stage, done, total: None)[0]
    assert (best.suspect.label, best.suspect.law) == (("ball_pass", "bearing_2"), "InnerRacePass")
    found = best.fitted.hypothesis.values(best.fitted.z)
    assert next(value for path, value in found.items() if path.endswith(".order")) == pytest.approx(order, abs=3e-4)
    assert best.fitted.chi_fit < 0.5 * null.chi_fit


def test_a_vibration_is_seen_in_a_first_look_whatever_its_direction() -> None:
    """At right angles to where it is begun its amplitude has no slope, and neither has its direction."""
    push = KnownForce("ground", {"bearing_2.housing.y": 1.0}, TIMES, np.asarray(3.0 * np.sin(600.0 * TIMES + 0.4)))
    simulator = localiser(push, bare=dataclasses.replace(trial(), held_out=TIMES > 1.3))._simulator
    null = fit(simulator, NOMINAL, ORIGIN, steps=0)
    above_noise = null.cost - 0.5 * np.count_nonzero(simulator.fit)
    assert above_noise > 1e3
    suspects_of = suspects(NOMINAL, {}, candidates(simulator.trials[0].scene, [hm.GroundVibration]))
    [suspect] = [item for item in suspects_of if item.label[1] == "bearing_2"]
    begun = begun_at(suspect.first, Periods(simulator, null))
    screen = screen_from(simulator, null)

    def gained(starts: Sequence[Hypothesis]) -> float:
        look = screen.look(starts)
        assert look is not None
        return null.cost - look.cost

    along_x_alone = [item for item in begun if item.added[-1].effect.direction == 0.0]  # type: ignore[attr-defined]
    assert gained(along_x_alone) < 0.1 * above_noise
    assert gained(begun) > 0.5 * above_noise


def test_a_place_that_is_kept_alone_shows_what_it_showed() -> None:
    about = localiser(along_x(rotor_1=1.0))._about
    name = next(name for name in about.responses[0].of if about.at(name) == "rotor_1")
    others = [other for other in about.responses[0].of if other != name]
    before = about.transfer(name, 0)
    assert before is not None
    shown, left = before.copy(), about.likelihood.residuals(0, np.zeros(len(about.likelihood.at)))
    kept = about.narrowed(name)
    np.testing.assert_array_equal(kept.transfer(name, 0), shown)
    np.testing.assert_array_equal(kept.likelihood.residuals(0, np.zeros(len(kept.likelihood.at))), left)
    assert len(others) > 10
    assert list(kept.responses[0].of) == [name]
    assert all(other not in kept.responses[0].of for other in others)
    assert kept.at(name) == "rotor_1"
    of_sensor = localiser()._about
    sensor = "rotor_1.sensors"
    read = of_sensor.transfer(sensor, 0)
    assert read is not None
    np.testing.assert_array_equal(of_sensor.narrowed(sensor).transfer(sensor, 0), read)
