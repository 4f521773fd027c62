"""Where in the operating range a gap lies, on records of the drive bench with planted forces."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.domain import domain_map
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.result import DomainBin
from hdrive_mbs.diagnosis.sentences import domain_sentences
from hdrive_mbs.diagnosis.simulator import Simulator
from tests.unit.test_locate import STEP, TIMES, fitted, recorded


def bins_over(bins: tuple[DomainBin, ...], over: str) -> list[DomainBin]:
    return [item for item in bins if item.over == over]


def test_noise_alone_is_nowhere_in_particular() -> None:
    simulator = recorded()
    bins = domain_map(simulator, fitted(simulator))
    assert {item.over for item in bins} == {"speed", "torque", "direction", "order", "frequency", "time"}
    for over in ("speed", "torque", "direction", "time"):
        assert sum(item.samples for item in bins_over(bins, over)) == simulator.used.sum()
    # a mean square of n normal numbers is 1 +- sqrt(2/n); quantised angles are a little quieter or louder
    for item in bins_over(bins, "torque"):
        assert abs(item.excess) < 6.0 * math.sqrt(2.0 / item.samples) + 0.1
    assert all(math.isnan(item.after) for item in bins)


def test_a_ripple_shows_at_its_order_and_frequency() -> None:
    simulator = recorded()
    null = fitted(simulator)
    turned = simulator.columns(null.hypothesis, null.z)[0]["motor_angle"]
    rippled = recorded("motor", 0.2 * np.sin(5.0 * turned))
    bins = domain_map(rippled, fitted(rippled))
    excess = {round(item.low + 0.5): item.excess for item in bins_over(bins, "order")}
    assert excess[5] > 10.0 * max(excess[4], excess[6])


def test_a_gap_at_one_time_is_found_then_and_at_its_torque() -> None:
    # from 2.0 s on the brake holds 120 N m: the force between 2.1 and 2.4 s is there alone
    force = np.where((TIMES > 2.1) & (TIMES < 2.4), 4.0 * np.sin(60.0 * TIMES), 0.0)
    simulator = recorded("load", force)
    bins = domain_map(simulator, fitted(simulator))
    worst = max(bins_over(bins, "time"), key=lambda item: item.excess)
    assert worst.low < 2.4
    assert worst.high > 2.1
    quiet = [item.excess for item in bins_over(bins, "time") if item.high < 2.0 or item.low > 2.5]
    assert worst.excess > 10.0 * max(quiet)  # it rings on for a while
    loaded = max(bins_over(bins, "torque"), key=lambda item: item.excess)
    assert loaded.low < 120.0 < loaded.high + 30.0


def test_a_force_of_one_frequency_shows_in_its_octave() -> None:
    simulator = recorded("load", 3.0 * np.sin(150.0 * TIMES))
    worst = max(bins_over(domain_map(simulator, fitted(simulator)), "frequency"), key=lambda item: item.excess)
    assert worst.low <= 150.0 <= worst.high


def test_a_claimed_cause_is_shown_beside_the_gap() -> None:
    simulator = recorded("load", 3.0 * np.sin(150.0 * TIMES))
    clean = recorded()
    bins = domain_map(simulator, fitted(simulator), fitted(clean))
    total = bins_over(bins, "speed")
    assert sum(item.excess * item.samples for item in total) > 10.0 * sum(abs(item.after) * item.samples for item in total)


def test_speeds_are_those_that_were_measured_and_named_with_their_place() -> None:
    """The model turns at up to 180 rad/s; a speed column that never leaves 90 rad/s sets the range, and its gaps are filled."""
    plain = recorded().trials[0]
    speed = 90.0 * np.sin(TIMES)
    speed[:5] = math.nan
    columns = {**plain.columns, "motor_speed": speed}
    items = {**plain.measured, "motor_speed": Measured(channel="motor.speed", noise=0.1)}
    simulator = Simulator([dataclasses.replace(plain, columns=columns, measured=items)], STEP)
    bins = domain_map(simulator, fitted(simulator))
    assert max(item.high for item in bins_over(bins, "speed")) == pytest.approx(np.nanmax(speed), rel=1e-12)
    said = domain_sentences(bins)
    assert said[0].startswith("Over motor speed: ")
    assert said[1].startswith("Over gear torque: ")
    assert {text.partition(":")[0] for text in said[2:]} == {
        "Over direction of motor", "Over order of motor", "Over frequency", "Over time",
    }  # fmt: skip


def test_speeds_and_torques_without_a_measured_one_are_those_of_the_run_with_the_cause() -> None:
    """Whatever the refitted model does without the cause."""
    simulator = recorded()
    null = fitted(simulator)
    weak = null.z.copy()
    weak[0] = 1.0
    bins, again = (domain_map(simulator, first, fitted(simulator)) for first in (null, fitted(simulator, weak)))
    for over in ("speed", "torque"):
        assert [item.high for item in bins_over(bins, over)] == [item.high for item in bins_over(again, over)]


def test_views_of_a_record_that_hold_different_parts_are_put_together() -> None:
    """A rotor bench lays each record beside a line of its own; a part that one of them has not carries nothing there."""
    simulator = recorded()
    plain = simulator.trials[0]
    lone = hm.Scene(name="motor alone", parts={"motor": plain.scene.parts["motor"]}, connections=[])
    columns = {"motor_torque": plain.columns["motor_torque"]}
    alone = dataclasses.replace(plain, name="motor", scene=lone, columns=columns, measured={"motor_torque": plain.measured["motor_torque"]})
    both = Simulator([alone, plain], STEP)
    bins = domain_map(both, dataclasses.replace(fitted(simulator), hypothesis=Hypothesis(()), z=np.zeros(0), residuals=_residuals(both)))
    assert {item.of for item in bins_over(bins, "torque")} == {"gear"}


def _residuals(simulator: Simulator) -> np.ndarray:
    [found] = simulator.residuals(Hypothesis(()), [np.zeros(0)])
    assert found is not None
    return found
