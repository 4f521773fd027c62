"""Forces planted in the drive bench at known places, by the compiled model itself with another seed of noise."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np
import pytest

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.locate import Localiser, locate
from hdrive_mbs.diagnosis.locate.about import linearised
from hdrive_mbs.diagnosis.locate.motion import KnownForce, columns_of
from hdrive_mbs.diagnosis.locate.spectra import joined, windowed
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.result import NOWHERE, Place
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from models import drive_bench as bench

STEP, SAMPLES = 0.25e-3, 6000
"""Step of the integration [s], and samples of a record: 3 s at 2 kHz."""
FACTORS = tuple(
    Factor(path=paths[0], name=name, nominal=dict.fromkeys(paths, bench.NOMINAL[name]), sigma=bench.KNOWLEDGE[name])
    for name, paths in bench.PATHS.items()
)
NOMINAL = Hypothesis(factors=FACTORS)
ORIGIN = np.zeros(NOMINAL.size)
TIMES = bench.SAMPLE_TIME * np.arange(SAMPLES)
# along which coordinates a force at each place acts: a body's own, or the two ends of a connection by the ratio
PLACES: Mapping[str, Mapping[str, float]] = {
    "motor": {"motor": 1.0},
    "load": {"load": 1.0},
    "gear": {"wave_generator": -1.0 / bench.RATIO, "gear.flexspline": 1.0},
    "output_shaft": {"gear.flexspline": -1.0, "load": 1.0},
}


def measured() -> dict[str, Measured]:
    noise = bench.NOISE | {"output_torque": 0.28}  # 0.35 in all: 0.28 white and 0.21 coloured
    return {
        name: Measured(
            channel=bench.CHANNELS[name],
            noise=noise[name],
            resolution=bench.RESOLUTION[name],
            coloured=bench.COLOURED.get(name, (0.0, 0.0)),
            offset=bench.OFFSETS.get(name, 0.0),
        )
        for name in noise
    }


def trial() -> Trial:
    scene = bench.build(
        speed_reference=((0.0, 0.4, 1.2, 1.6, 2.4, 3.0), (0.0, 120.0, 120.0, 40.0, 40.0, 180.0)),
        load_torque=((0.0, 0.5, 0.7, 1.8, 2.0, 3.0), (0.0, 0.0, 60.0, 60.0, 120.0, 120.0)),
    )
    items = measured()
    empty = {name: np.zeros(SAMPLES) for name in items}
    return Trial(name="steps", scene=scene, every=bench.SAMPLE_TIME, columns=empty, measured=items, held_out=np.zeros(SAMPLES, dtype=bool))


def recorded(
    at: str | None = None, force: np.ndarray | None = None, z: np.ndarray = ORIGIN, error: tuple[str, np.ndarray] | None = None
) -> Simulator:
    """A record with a force along a place's coordinates, other parameters, or an error of a column; noise as the bench states."""
    bare = trial()
    forces = [] if at is None or force is None else [KnownForce("planted", PLACES[at], TIMES, force)]
    [simulated] = columns_of(Simulator([bare], STEP), 0, NOMINAL, [z], forces)
    assert simulated is not None
    rng = np.random.default_rng(7)
    columns = {}
    for name, values in simulated.items():
        item = bare.measured[name]
        sigma, kept = item.coloured
        drift = np.zeros(SAMPLES)
        for k, step in enumerate(rng.normal(0.0, sigma * np.sqrt(1.0 - kept**2), SAMPLES - 1) if sigma else ()):
            drift[k + 1] = kept * drift[k] + step
        read = values + drift + item.offset * rng.standard_normal() + item.noise * rng.standard_normal(SAMPLES)
        if error is not None and error[0] == name:
            read = read + error[1]
        columns[name] = item.resolution * np.round(read / item.resolution)
    return Simulator([dataclasses.replace(bare, columns=columns)], STEP)


def fitted(simulator: Simulator, z: np.ndarray = ORIGIN) -> Fitted:
    """The model at given parameters: localisation adapts them by itself."""
    residuals = simulator.residuals(NOMINAL, [z])[0]
    assert residuals is not None
    return Fitted(
        hypothesis=NOMINAL,
        z=z,
        residuals=residuals,
        cost=0.0,
        curvature=np.eye(NOMINAL.size),
        converged=True,
        steps=0,
        chi_fit=1.0,
        chi_held=1.0,
        typical=1.0,
        misfit_held=0.0,
    )


def burst(size: float, rate: float = 60.0) -> np.ndarray:
    """A force that no law of the library has: swelling beats at ``rate`` and 2.7 times it [rad/s]."""
    return size * np.sin(1.1 * TIMES) ** 2 * (np.sin(rate * TIMES) + 0.5 * np.cos(2.7 * rate * TIMES))


# 1 to 5 % of the torque at hand: 9 N m at the motor, some 100 N m at the output
@pytest.mark.parametrize(
    ("at", "size", "rate"), [("motor", 0.1, 60.0), ("load", 2.0, 60.0), ("gear", 5.0, 60.0), ("output_shaft", 5.0, 60.0)]
)
def test_an_unknown_force_is_found_where_it_acts(at: str, size: float, rate: float) -> None:
    simulator = recorded(at, burst(size, rate))
    best = locate(simulator, fitted(simulator))[0]
    assert best.at == at or at in best.tied
    assert best.probability > 0.5
    assert best.share > 0.5


def test_without_a_gap_nowhere_is_most_probable() -> None:
    simulator = recorded()
    places = locate(simulator, fitted(simulator))
    assert places[0].at == NOWHERE
    assert places[0].probability > 0.5
    assert sum(place.probability for place in places) == pytest.approx(1.0)


def test_parameters_within_their_tolerance_are_no_place() -> None:
    z = np.random.default_rng(3).standard_normal(NOMINAL.size)
    simulator = recorded(z=z)
    assert locate(simulator, fitted(simulator, 0.9 * z))[0].at == NOWHERE


def test_a_parameter_far_beyond_its_tolerance_points_at_its_part() -> None:
    z = ORIGIN.copy()
    z[[factor.name for factor in FACTORS].index("load_inertia")] = -9.0
    simulator = recorded(z=z)
    best = locate(simulator, fitted(simulator, z))[0]
    assert best.at == "load"
    assert best.probability > 0.9
    assert best.parameter == "load_inertia"


def test_an_error_of_a_sensor_is_found_at_the_sensor() -> None:
    # 2e-5 rad is 13 standard deviations of the encoder's noise; no force moves the load without the torque sensor seeing it
    simulator = recorded(error=("load_angle", 2e-5 * np.sin(45.0 * TIMES)))
    places = locate(simulator, fitted(simulator))
    best = places[0]
    assert best.at == "load_encoder"
    assert best.probability > 0.9
    assert {place.at for place in places if place.sensor} == {"load_encoder", "motor_encoder", "torque_sensor"}


def test_motor_and_wave_generator_are_tied_where_the_shaft_between_them_is_stiff() -> None:
    # 4e-3 N m twist the shaft of 400 N m/rad by 1e-5 rad, a fortieth of a step of the motor's encoder
    simulator = recorded("motor", burst(0.004, 4.0))
    places = locate(simulator, fitted(simulator))
    pair = {"motor", "wave_generator"}
    assert places[0].at in pair
    assert pair - {places[0].at} <= set(places[0].tied)


def test_a_steady_torque_too_slow_to_be_placed_leaves_a_doubt() -> None:
    simulator = recorded("load", np.full(SAMPLES, 100.0))
    located = Localiser(simulator, fitted(simulator))
    assert located.doubt.startswith("Not reliable here: the best single place gains ")
    assert located.places()[0].probability < 0.5
    clear = recorded("load", burst(3.0))
    assert Localiser(clear, fitted(clear)).doubt == ""


def test_the_course_of_the_force_comes_out() -> None:
    force = burst(2.0)
    simulator = recorded("load", force)
    [found] = Localiser(simulator, fitted(simulator)).force("load")
    inner = slice(1000, 5000)
    left = found.force[inner] - force[inner]
    # the force is far above what the noise hides at these frequencies: a tenth of it is left at most
    assert np.sqrt(np.mean(left**2)) < 0.1 * np.sqrt(np.mean(force[inner] ** 2))
    assert found.unit == "N m"
    assert found.record == "steps"
    # the motor turns at 180 rad/s in the end, the load a hundredth of that
    assert found.speed[-1] == pytest.approx(1.8, abs=0.05)


def test_windows_keep_energy_and_come_together_again() -> None:
    values = np.random.default_rng(1).standard_normal(2500)
    parts = windowed(values, 512, 257)
    doubled = np.abs(parts) ** 2
    # the first and last bin stand for one coefficient, the others for two
    energy = doubled[:, 1:-1].sum() + 0.5 * (doubled[:, 0].sum() + doubled[:, -1].sum())
    assert energy == pytest.approx(values @ values, rel=1e-12)
    assert joined(parts, 512, 2500) == pytest.approx(values, abs=1e-12)


def test_an_offset_of_one_record_changes_what_its_slope_says_and_nothing_in_another_record() -> None:
    """Against records with another offset, in place of the slope's own reckoning."""
    [first] = recorded().trials
    other = dataclasses.replace(first, name="again")
    about = linearised(Simulator([first, other], STEP), NOMINAL, ORIGIN)
    assert about is not None
    offsets = [(record, name) for record in (0, 1) for name, item in first.measured.items() if item.offset > 0.0]
    assert len(offsets) > 1
    for k, (record, name) in enumerate(offsets, start=1 + NOMINAL.size):
        size = first.measured[name].offset
        shifted = dataclasses.replace(first, columns=dict(first.columns) | {name: first.columns[name] + size})
        there = linearised(Simulator([shifted, other] if record == 0 else [other, shifted], STEP), NOMINAL, ORIGIN)
        assert there is not None
        own, moved = about.spectra[record].values, there.spectra[record].values
        digits = 4.0 * float(np.finfo(np.float32).eps * np.max(np.abs(moved[..., 0])))  # complex64 is what is kept
        assert np.max(np.abs(own[..., k])) > 100.0 * digits
        assert moved[..., 0] - own[..., 0] == pytest.approx(-own[..., k], abs=digits)
        assert not about.spectra[1 - record].values[..., k].any()


def test_an_unknown_place_is_named_with_the_known_ones() -> None:
    simulator = recorded()
    with pytest.raises(Exception, match="load_encoder"):
        Localiser(simulator, fitted(simulator)).force("lode")


def test_places_are_those_of_the_scene() -> None:
    simulator = recorded()
    places: tuple[Place, ...] = locate(simulator, fitted(simulator))
    bodies, connections = {"motor", "wave_generator", "gear.flexspline", "load"}, {"input_shaft", "gear", "output_shaft"}
    assert {place.at for place in places} == bodies | connections | {"motor_encoder", "load_encoder", "torque_sensor", NOWHERE}
