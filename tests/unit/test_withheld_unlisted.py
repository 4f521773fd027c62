"""Causes without a name on the drive bench that came later: each does to the records what its words say."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("numba", reason="the plants of the withheld cases are compiled with numba (extra: bench)")

from benchmarks.withheld.plant import drive
from benchmarks.withheld.plant.drive_causes import later_unlisted
from benchmarks.withheld.plant.drive_train import line, sensors
from benchmarks.withheld.plant.drive_train.banks import no_memory
from benchmarks.withheld.plant.drive_train.load import LETS_GO, cable
from benchmarks.withheld.plant.drive_train.motion import Motion, follow
from benchmarks.withheld.plant.drive_train.motor import Motor, shaft_side
from benchmarks.withheld.plant.drive_train.nominal import NOMINAL
from benchmarks.withheld.plant.drive_train.rates import rates
from benchmarks.withheld.plant.drive_train.specimen import Specimen, specimen

SAMPLE = 1e-3  # s


def driven(made: Specimen, brake: np.ndarray) -> Motion:
    time = SAMPLE * np.arange(brake.size)
    return follow(made.plant, made.tables, 60.0 * np.sin(12.0 * time), brake, SAMPLE, tolerance=1e-6)


def acceleration(made: Specimen, time: float, brake: float) -> float:
    """Of the load [rad/s^2], from one fixed state."""
    y = np.zeros(line.STATES)
    y[[line.FLEX, line.LOAD, line.LOAD_SPEED]] = 2e-3, 1e-3, 0.4
    slopes, report = np.zeros(line.STATES), np.zeros(line.REPORTS)
    rates(time, y, 0.0, brake, made.plant, made.tables, no_memory(), slopes, report)
    return float(slopes[line.LOAD_SPEED])


def test_a_saturating_motor_loses_a_share_of_its_torque_that_grows_with_the_square() -> None:
    motor = Motor(saturation=0.02)
    for torque in (0.1, -0.1, 0.3):
        lost = 1.0 - shaft_side(0.0, torque, 0.0, motor) / torque
        assert lost == pytest.approx(0.02 * torque**2, rel=4.0 * 0.02 * torque**2)
    assert shaft_side(0.0, 1e3, 0.0, motor) == pytest.approx(1.0 / np.sqrt(2.0 * 0.02), rel=1e-4)  # the most it can give


def test_a_payload_leaves_with_the_speed_that_it_has() -> None:
    """The torques stay, so the acceleration grows as the inertia falls, and no more happens."""
    made = specimen(NOMINAL).part("load", gone=0.3, gone_time=2.0)
    before, after = acceleration(made, 2.0 - 10.0 * LETS_GO, 30.0), acceleration(made, 2.0 + 10.0 * LETS_GO, 30.0)
    assert before == pytest.approx(acceleration(specimen(NOMINAL), 0.0, 30.0), rel=1e-7)
    assert after == pytest.approx(before / 0.7, rel=1e-7)


def test_a_cable_is_slack_up_to_its_angle_and_a_spring_beyond() -> None:
    load = specimen(NOMINAL).part("load", cable=2.0, cable_angle=1.0, cable_width=0.02).plant.load
    assert 0.0 < cable(0.0, load) < 2.0 * 0.02**2 / 4.0 * 1.01
    assert cable(5.0, load) == pytest.approx(2.0 * 4.0, rel=1e-4)


def test_an_uneven_brake_of_no_order_is_a_stronger_brake() -> None:
    brake = 30.0 * np.minimum(np.arange(200) / 50.0, 1.0)
    uneven = driven(specimen(NOMINAL).part("load", uneven=0.1, uneven_order=0.0, uneven_phase=np.pi / 2), brake)
    stronger = driven(specimen(NOMINAL), 1.1 * brake)
    np.testing.assert_allclose(uneven.states, stronger.states, atol=1e-9)
    assert np.abs(driven(specimen(NOMINAL), brake).states - stronger.states).max() > 1e-3


def test_the_loop_of_a_torque_sensor_has_the_area_of_its_stops() -> None:
    """A stop of unit stiffness and limit r loses 4 r (A - r) in a turn to and fro of amplitude A."""
    turn, limit = 80.0, 40.0
    torque = turn * np.sin(np.linspace(0.0, 4.0 * np.pi, 40001))
    read = sensors._loops(torque, limit)
    second = slice(20000, None)
    area = float(np.sum(0.5 * (read[second][1:] + read[second][:-1]) * np.diff(torque[second])))
    assert area == pytest.approx(sum(4.0 * r * (turn - r) for r in (10.0, 20.0, 40.0)) / 3.0, rel=1e-4)


def test_an_encoder_loses_a_count_at_each_passage_and_finds_it_on_the_way_back() -> None:
    """Three turns and back past 1 rad."""
    angle = np.concatenate([np.linspace(0.0, 14.0, 500), np.linspace(14.0, 0.0, 500)])
    states = np.zeros((1000, line.STATES))
    states[:, line.LOAD] = angle
    faulty = sensors.Sensors(lost_count=1e-5, lost_count_angle=1.0)
    read = sensors.clean(Motion(states, np.zeros(1000), np.zeros(1000), 0), faulty)["load_angle"]
    passed = sum((angle > place).astype(float) for place in (1.0, 1.0 + 2.0 * np.pi, 1.0 + 4.0 * np.pi))
    np.testing.assert_allclose(angle - read, 1e-5 * passed, atol=1e-12)


@pytest.mark.parametrize(("name", "place"), [(cause.name, place) for cause, _ in later_unlisted.CAUSES for place in cause.places])
def test_each_is_told_as_unknown_at_its_place_and_can_be_seen(name: str, place: str) -> None:
    """Drawn as a set draws it; its detectability is at least the least that a set lets pass."""
    case = drive.make_case([(name, place)], np.random.default_rng(5))
    assert [(cause["effect"], cause["at"]) for cause in case.truth] == [("unknown", place)]
    assert case.more["detectability"]["linear"] >= drive.BARELY
    assert any(case.put_in[kind] for kind in ("effect", "sensor"))
