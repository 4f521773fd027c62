"""Load torques."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import gradient
from hdrive_mbs.loads.constant import ConstantTorque
from hdrive_mbs.loads.law import LoadFunction, LoadLaw
from hdrive_mbs.loads.quadratic import QuadraticLoad
from hdrive_mbs.loads.ramp import RampTorque
from hdrive_mbs.loads.sine import SineTorque
from hdrive_mbs.loads.table import TableTorque
from hdrive_mbs.loads.torque_speed import TorqueSpeedLoad
from tests.unit.law_checks import assert_records_itself, run_on_engine
from tests.verification.scenes import train

LOADS: dict[str, LoadLaw] = {
    "constant": ConstantTorque(value=12.0),
    "sine": SineTorque(mean=4.0, amplitude=3.0, frequency=1.0, phase=0.3),
    "ramp": RampTorque(start=0.0, end=10.0, duration=0.5),
    "late ramp": RampTorque(start=2.0, end=-10.0, duration=0.5, begin=0.2),
    "table": TableTorque(times=(0.0, 0.1, 0.4, 0.5), torques=(1.0, 5.0, 5.0, -2.0)),
    "periodic table": TableTorque(times=(0.05, 0.1, 0.4, 0.5), torques=(1.0, 5.0, -5.0, 1.0), periodic=True),
    "speed table": TorqueSpeedLoad(speeds=(-1.0, 0.0, 2.0), torques=(-3.0, 1.0, 6.0), symmetry="none"),
    "odd speed table": TorqueSpeedLoad(speeds=(0.0, 1.0, 2.0), torques=(2.0, 1.0, 6.0), symmetry="odd"),
    "even speed table": TorqueSpeedLoad(speeds=(0.0, 1.0, 2.0), torques=(2.0, 1.0, 6.0), symmetry="even"),
    "fan": QuadraticLoad(coefficient=3.0),
    "function of time": LoadFunction(function=lambda t: 3.0 + np.cos(t)),
    "function of all": LoadFunction(function=lambda t, angle, speed: 3.0 * np.sin(angle) + 0.1 * speed + t),
}


@pytest.mark.parametrize("name", list(LOADS))
def test_every_load_records_itself(name: str) -> None:
    rng = np.random.default_rng(6)
    assert_records_itself(LOADS[name].torque, rng.uniform(0.0, 2.0, 300), rng.uniform(-9.0, 9.0, 300), rng.uniform(-3.0, 3.0, 300))


@pytest.mark.parametrize("name", list(LOADS))
def test_every_load_runs_on_the_engine_without_a_python_callback(name: str) -> None:
    result, how = run_on_engine(train(load=LOADS[name]), 0.02)
    assert how["load.torque"] in ("native", "symbolic")
    assert np.isfinite(result.speeds["load"][-1])


def test_a_table_has_straight_lines_between_its_points_and_constant_ends() -> None:
    times = np.array([-1.0, 0.0, 0.05, 0.1, 0.25, 0.45, 0.5, 9.0])
    np.testing.assert_allclose(LOADS["table"].torque(times, 0.0, 0.0), [1.0, 1.0, 3.0, 5.0, 5.0, 1.5, -2.0, -2.0], atol=1e-13)


def test_a_periodic_table_repeats_with_the_length_of_the_table() -> None:
    law, period = LOADS["periodic table"], 0.45
    times = np.linspace(0.05, 0.4999, 50)
    for cycles in (-1.0, 1.0, 7.0):
        # slopes up to 80 N m/s times the rounding of the time, 1e-15 s
        np.testing.assert_allclose(law.torque(times + cycles * period, 0.0, 0.0), law.torque(times, 0.0, 0.0), atol=1e-11)
    np.testing.assert_allclose(law.torque(times, 0.0, 0.0), np.interp(times, [0.05, 0.1, 0.4, 0.5], [1.0, 5.0, -5.0, 1.0]), atol=1e-12)


def test_the_ramp_of_the_start_up_case_reaches_10_newton_metres_after_half_a_second() -> None:
    times = np.array([-0.1, 0.0, 0.1, 0.25, 0.5, 3.0])
    np.testing.assert_allclose(LOADS["ramp"].torque(times, 0.0, 0.0), [0.0, 0.0, 2.0, 5.0, 10.0, 10.0], atol=1e-14)
    np.testing.assert_allclose(LOADS["late ramp"].torque(np.array([0.0, 0.2, 0.45, 0.7]), 0.0, 0.0), [2.0, 2.0, -4.0, -10.0], atol=1e-14)


def test_the_symmetry_of_a_speed_table_is_what_it_says() -> None:
    speeds = np.array([0.3, 0.5, 1.7, 5.0])
    for name, sign in (("odd speed table", -1.0), ("even speed table", 1.0)):
        law = LOADS[name]
        np.testing.assert_array_equal(law.torque(0.0, 0.0, -speeds), sign * law.torque(0.0, 0.0, speeds))
        np.testing.assert_allclose(law.torque(0.0, 0.0, speeds), [1.7, 1.5, 4.5, 6.0], atol=1e-14)
    np.testing.assert_allclose(LOADS["speed table"].torque(0.0, 0.0, np.array([-9.0, -0.5, 1.0])), [-3.0, -1.0, 3.5], atol=1e-14)


def test_a_fan_takes_four_times_the_torque_at_twice_the_speed_and_always_resists() -> None:
    fan = LOADS["fan"]
    assert float(fan.torque(0.0, 0.0, 4.0)) == 4.0 * float(fan.torque(0.0, 0.0, 2.0)) == 48.0
    assert float(fan.torque(0.0, 0.0, -2.0)) == -12.0
    assert float(gradient(lambda w: fan.torque(0.0, 0.0, w))(2.0)) == 12.0  # 2 k w


@pytest.mark.parametrize(
    ("times", "torques", "periodic", "message"),
    [
        ((0.0, 1.0, 2.0), (1.0, math.nan, 3.0), False, r"TableTorque\.torques\[1\] = nan N m: must be a finite number"),
        ((0.0, math.inf), (1.0, 2.0), False, r"TableTorque\.times\[1\] = inf s: must be a finite number"),
        ((0.0, 2.0, 1.0), (1.0, 2.0, 3.0), False, r"TableTorque\.times\[2\] = 1 s does not rise above times\[1\] = 2 s; sort the table"),
        ((0.0, 1.0, 1.0), (1.0, 2.0, 3.0), False, r"times\[2\] = 1 s does not rise"),
        ((0.0, 1.0), (1.0, 2.0, 3.0), False, "2 times and 3 torques"),
        ((0.0,), (1.0,), False, "at least 2"),
        ((0.0, 1.0), (1.0, 2.0), True, "ends with 2 N m and starts with 1 N m"),
        ((0.0, "x"), (1.0, 2.0), False, r"times\[1\] = 'x': must be a number"),
    ],
)
def test_a_bad_load_table_is_refused_naming_the_entry(times: Any, torques: Any, periodic: bool, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        TableTorque(times=times, torques=torques, periodic=periodic)


@pytest.mark.parametrize(
    ("speeds", "torques", "symmetry", "message"),
    [
        ((0.0, 1.0), (1.0, 2.0), "both", "must be 'none', 'odd' or 'even'"),
        ((-1.0, 1.0), (1.0, 2.0), "odd", r"speeds\[0\] = -1 rad/s.*symmetry='none'"),
        ((0.0, 1.0, 0.5), (1.0, 2.0, 3.0), "none", r"speeds\[2\] = 0\.5 rad/s does not rise"),
        ((0.0, 1.0), (math.nan, 2.0), "none", r"TorqueSpeedLoad\.torques\[0\] = nan N m"),
    ],
)
def test_a_bad_speed_table_is_refused(speeds: tuple[float, ...], torques: tuple[float, ...], symmetry: str, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        TorqueSpeedLoad(speeds=speeds, torques=torques, symmetry=symmetry)


def test_an_unknown_keyword_of_a_load_is_refused_by_name() -> None:
    keywords: dict[str, Any] = {"value": 1.0, "frequncy": 2.0}
    with pytest.raises(TypeError, match="frequncy"):
        ConstantTorque(**keywords)
