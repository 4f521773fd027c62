"""Shafts that are held to a measured motion: smoothing, starts, run-ins, and a record that a line then reproduces."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.bench import Bench, Input
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.locate.sources import lateral_sources
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.starting import angles_with_the_rest, speeds_with_the_rest
from models import drive_bench

SPEED, STEP, EVERY = 200.0, 5e-5, 5e-4


def line() -> hm.Scene:
    """A disc between two bearings in housings; the drive comes first, so that it names the station of the first bearing."""
    steel = {"diameter": hm.mm(30), "youngs_modulus": 2.06e11, "shear_modulus": 7.9e10, "density": 7850.0, "damping": 2e-5}
    law = hm.LinearBearing.isotropic(radial=2e7, damping=5e3, axial=1e7, axial_damping=100.0, tilt=500.0, tilt_damping=5.0)
    housing = hm.Housing.isotropic(mass=15.0, stiffness=1e7, damping=2e4)
    bearing = hm.Bearing(law=law, mass=1.0, polar_inertia=1e-3, transverse_inertia=8e-4, housing=housing)
    parts: dict[str, hm.Component] = {
        "drive": hm.DriveTorque(characteristic=hm.TorqueSpeedTable(speeds=(SPEED, SPEED + 100.0), torques=(1.0, -1.0), extrapolate=True)),
        "de": bearing,
        "s1": hm.ShaftSection(length=0.2, **steel),
        "disc": hm.Rotor(mass=12.0, polar_inertia=0.08, transverse_inertia=0.045, eccentricity=3e-5),
        "s2": hm.ShaftSection(length=0.25, **steel),
        "nde": bearing,
        "gravity": hm.Gravity(),
        "right": hm.Probe(at="disc", angle=hm.degrees(45)),
        "left": hm.Probe(at="disc", angle=hm.degrees(135)),
    }
    return hm.Scene(name="fan", parts=parts, connections=[("drive", "de", "s1", "disc", "s2", "nde")])


def held(times: np.ndarray, values: np.ndarray) -> hm.IdealSpeedMotor:
    return hm.IdealSpeedMotor(motion=hm.smoothed_motion(times, values))


def bench(**changes: float) -> Bench:
    names = ("right", "left")
    return Bench(
        scene=line(),
        knowledge={},
        measured={name: Measured(channel=name, noise=2e-7) for name in names},
        inputs={"angle": Input(path="drive.characteristic", law=held)},
        **changes,
    )


# -- smoothing -----------------------------------------------------------------------------------------


def truth(times: np.ndarray) -> np.ndarray:
    return np.asarray(3.0 + 150.0 * times + 8.0 * times**2 + 0.3 * np.sin(5.0 * times), float)


def test_the_steps_of_an_encoder_are_smoothed_away() -> None:
    times, step = np.arange(0.0, 2.0, 5e-4), 2.0 * math.pi / 1024.0
    motion = hm.smoothed_motion(times, step * np.round(truth(times) / step))
    inner = times[200:-200]
    # steps are an error of step/sqrt(12) each; up to 40 coefficients of 4000 samples leave a tenth of that
    assert np.std(motion.angle(inner) - truth(inner)) < 0.1 * step / math.sqrt(12.0)
    speed = 150.0 + 16.0 * inner + 1.5 * np.cos(5.0 * inner)
    # the same within a twentieth of a second, as far apart as 40 knots are: 2e-4/0.05 rad/s
    assert np.max(np.abs(motion.speed(inner) - speed)) < 2.0 * 0.1 * step / math.sqrt(12.0) / 0.05
    assert motion.angle(0.0) == pytest.approx(3.0, abs=step)


def test_a_faster_motion_gets_closer_knots() -> None:
    times = np.arange(0.0, 1.0, 5e-4)
    noise = 1e-3 * np.random.default_rng(5).standard_normal(len(times))
    slow, fast = (hm.smoothed_motion(times, 100.0 * times + 0.1 * np.sin(rate * times) + noise) for rate in (3.0, 120.0))
    assert len(fast.times) >= len(slow.times)
    inner = times[50:-50]
    # pieces of 1/140 s, a seventh of a period: sqrt(140/2000) of the noise
    assert np.std(fast.angle(inner) - 100.0 * inner - 0.1 * np.sin(120.0 * inner)) < 1.2 * math.sqrt(140.0 / 2000.0) * 1e-3


def test_a_speed_is_integrated_from_the_first_sample_on() -> None:
    times = 0.25 + np.arange(0.0, 2.0, 1e-3)
    noise = 0.5 * np.random.default_rng(2).standard_normal(len(times))
    motion = hm.smoothed_motion(times, 150.0 + 16.0 * times + noise, of="speed")
    turned = motion.angle(times) - motion.angle(0.25)
    # white noise of 0.5 rad/s over 1 ms samples: an angle of 0.5 sqrt(1e-3 t) rad, 0.022 rad after 2 s; three times that
    assert np.max(np.abs(turned - (150.0 * (times - 0.25) + 8.0 * (times**2 - 0.25**2)))) < 0.067
    assert motion.angle(0.25) == pytest.approx(0.0, abs=1e-12)
    # before the samples the speed stays as it is there
    assert motion.speed(0.0) == pytest.approx(motion.speed(0.25), rel=1e-9)
    assert motion.angle(0.0) == pytest.approx(-0.25 * float(motion.speed(0.0)), rel=1e-9)


def test_a_gap_is_bridged_by_pieces_that_are_longer() -> None:
    times = np.arange(0.0, 2.0, 1e-3)
    seen = truth(times) + 1e-3 * np.random.default_rng(8).standard_normal(len(times))
    seen[(times > 0.8) & (times < 0.95)] = np.nan
    motion = hm.smoothed_motion(times, seen)
    inner = times[100:-100]
    assert np.max(np.abs(motion.angle(inner) - truth(inner))) < 2e-3
    with pytest.raises(ParameterError, match=r"knots = 0\.01 s: values are missing for longer than that"):
        hm.smoothed_motion(times, seen, knots=0.01)


def test_what_cannot_be_smoothed_is_refused() -> None:
    times = np.arange(0.0, 1.0, 1e-3)
    with pytest.raises(ParameterError, match=r"begins again after each turn: numpy\.unwrap"):
        hm.smoothed_motion(times, np.mod(150.0 * times, 2.0 * math.pi))
    with pytest.raises(ParameterError, match=r"at least 8 values at rising times; there are 3"):
        hm.smoothed_motion(times[:9], np.where(np.arange(9) < 3, 1.0, np.nan))
    with pytest.raises(ParameterError, match=r"of = 'rpm': must be 'angle' or 'speed'"):
        hm.smoothed_motion(times, times, of="rpm")
    with pytest.raises(ParameterError, match=r"shapes \(1000,\) and \(999,\)"):
        hm.smoothed_motion(times, times[1:])
    with pytest.raises(ParameterError, match=r"knots = 0\.001 s: must be at least 0\.004 s, four samples"):
        hm.smoothed_motion(times, times, knots=1e-3)


# -- starts --------------------------------------------------------------------------------------------


def test_bodies_that_are_not_named_turn_with_the_one_that_is() -> None:
    network = drive_bench.build().network()
    speeds = speeds_with_the_rest(network, {"motor": 100.0})
    ratios = {body.name: abs(body.ratio) for body in network.bodies}
    assert speeds == pytest.approx({name: 100.0 * ratio for name, ratio in ratios.items()})
    assert speeds_with_the_rest(network, {}) == angles_with_the_rest(network, {}) == {}
    given = dict.fromkeys(ratios, 1.0)
    assert speeds_with_the_rest(network, given) == given


def test_bodies_turn_with_a_place_whose_motion_is_given() -> None:
    times = np.arange(0.0, 1.0, 1e-3)
    scene = line().replacing({"drive.characteristic": held(times, 2.0 + 50.0 * times)})
    angles, speeds = angles_with_the_rest(scene.network(), {}), speeds_with_the_rest(scene.network(), {"disc": 49.0})
    assert speeds["nde"] == pytest.approx(50.0, rel=1e-9)
    assert speeds["disc"] == 49.0  # as it was said
    assert angles == pytest.approx({"disc": 2.0, "nde": 2.0}, rel=1e-9)


def test_a_run_starts_turned_to_where_its_motion_does() -> None:
    times = np.arange(0.0, 1.0, 1e-3)
    scene = line().replacing({"drive.characteristic": held(times, 2.0 + 50.0 * times)})
    run = hm.simulate(scene, 0.01, initial_speed=50.0)
    assert run["disc.angle"].values[0] == pytest.approx(2.0, rel=1e-9)
    assert np.max(np.abs(run["s1.twist"].values)) < 1e-5  # 2 rad where it starts at 0


def test_a_line_that_starts_at_an_angle_rests_as_one_that_starts_at_none() -> None:
    """A place that is held at an angle does not twist the others where the line is looked for at rest."""
    times = np.arange(0.0, 1.0, 1e-3)
    rest = hm.static_deflection(line(), speed=SPEED)
    at = list(rest.places).index("disc")
    record = hm.Record.of("run", [hm.TimeHistory("angle", "rad", times, 150.0 + SPEED * times), *(still(name, times) for name in PROBES)])
    [trial] = bench().trials(record)
    start = Simulator([trial], STEP).start_of(0, Hypothesis(factors=()), np.zeros(0))
    # internal damping of the section whose one end turns already: half of 2e-5 s times 200 rad/s
    assert start["disc.y"] == pytest.approx(rest.y[at], rel=0.5 * 2e-5 * SPEED * 1.5)
    assert start["disc"] == pytest.approx(150.0, abs=1e-6)


PROBES = ("right", "left")


def still(name: str, times: np.ndarray) -> hm.TimeHistory:
    return hm.TimeHistory(name, "m", times, np.zeros(len(times)))


# -- run-ins -------------------------------------------------------------------------------------------


def test_a_run_in_comes_before_the_samples_and_is_not_compared() -> None:
    times = np.arange(0.0, 1.0, 1e-3)
    record = hm.Record.of("run", [hm.TimeHistory("angle", "rad", times, 150.0 + SPEED * times), *(still(name, times) for name in PROBES)])
    [plain], [run_in] = bench().trials(record), bench(run_in=0.4).trials(record)
    assert run_in.samples == plain.samples + 400
    assert np.isnan(run_in.columns["right"][:400]).all()
    assert np.isfinite(run_in.columns["right"][400:]).all()
    np.testing.assert_array_equal(run_in.held_out[400:], plain.held_out)
    assert not run_in.held_out[:400].any()
    motion = run_in.scene.parts["drive"].characteristic.motion
    assert float(motion.angle(0.4)) == pytest.approx(150.0, abs=1e-6)
    assert run_in.angles["disc"] == pytest.approx(150.0 - 0.4 * SPEED, abs=1e-5)
    for bad in (-1.0, math.inf, math.nan):
        with pytest.raises(ParameterError, match="run_in = "):
            bench(run_in=bad)


def test_a_record_of_a_whirling_line_is_reproduced_by_one_that_follows_its_angle() -> None:
    run = hm.simulate(line(), 1.5, solver=hm.RungeKutta4(step=STEP), initial_speed=SPEED)
    first, fold = round(0.5 / STEP), round(EVERY / STEP)
    samples = slice(first, None, fold)
    times = run.times[samples] - run.times[first]
    np.testing.assert_allclose(np.diff(times), EVERY, rtol=1e-8)
    rng, step = np.random.default_rng(4), 2.0 * math.pi / 1024.0
    angle = step * np.round(run["drive.angle"].values[samples] / step)
    columns = [hm.TimeHistory(name, "m", times, run[name].values[samples] + 2e-7 * rng.standard_normal(len(times))) for name in PROBES]
    record = hm.Record.of("run", [hm.TimeHistory("angle", "rad", times, angle), *columns])

    def left(known: Bench) -> float:
        simulator = Simulator(known.trials(record), 1e-4)
        [found] = simulator.residuals(Hypothesis(factors=()), [np.zeros(0)])
        assert found is not None
        seen = simulator.fit | simulator.held_out
        return float(np.mean(found[seen] ** 2))

    whole = run["right"].values[samples]
    assert np.ptp(whole) > 50.0 * 2e-7
    # the rest of an encoder's steps, 1e-4 rad of a whirl of some 6 um, is far below the noise; 4000 samples scatter by sqrt(2/4000)
    assert left(bench(run_in=0.5)) == pytest.approx(1.0, abs=3.0 * math.sqrt(2.0 / 4000.0))
    assert left(bench()) > 2.0  # a line that only then begins to whirl


# -- where ---------------------------------------------------------------------------------------------


def test_forces_act_on_coordinates_that_the_line_has_whoever_named_its_stations() -> None:
    scene = line()
    network = scene.network()
    names = {body.name for body in network.bodies}
    assert "drive.x" in names
    assert "de.x" not in names
    found = lateral_sources(network, {})
    assert {"de.law", "nde.law", "de.housing", "nde.housing"} <= {source.at for source in found}
    for source in found:
        assert {name for factors in source.along.values() for name in factors} <= names, source.name
    across = next(source for source in found if source.at == "de.law")
    assert dict(across.along["x"]) == {"drive.x": 1.0, "de.housing.x": -1.0}


def test_a_line_can_be_given_in_any_order_of_its_parts() -> None:
    scene = line()
    parts = dict(sorted(scene.parts.items(), key=lambda item: item[0] == "drive"))
    other = dataclasses.replace(scene, parts=parts)
    mine, yours = ({(source.name, len(source.along)) for source in lateral_sources(item.network(), {})} for item in (scene, other))
    assert {name.replace("drive", "de") for name, _ in mine} == {name for name, _ in yours}
