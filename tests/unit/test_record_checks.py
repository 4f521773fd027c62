"""What is wrong with a record is found, said and repaired only on request; what is right is left alone."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.records.finding import KINDS
from hdrive_mbs.records.repair import WAYS

STEP = 1e-3
TIMES = np.arange(4000) * STEP
SPEED = 120.0 + 60.0 * np.sin(2.0 * TIMES) + 10.0 * np.sin(31.0 * TIMES)
ANGLE = 120.0 * TIMES + 30.0 * (1.0 - np.cos(2.0 * TIMES)) + 10.0 / 31.0 * (1.0 - np.cos(31.0 * TIMES))


def record(times: np.ndarray = TIMES, **channels: tuple[str, np.ndarray]) -> hm.Record:
    made = {key: hm.Measurement(name=key, unit=unit, values=values) for key, (unit, values) in channels.items()}
    return hm.Record(name="run", times=times, channels=made)


def drive(seed: int = 0) -> dict[str, tuple[str, np.ndarray]]:
    """A healthy bench: encoder with rounding, noisy torque, a command of straight pieces, a speed with noise."""
    rng = np.random.default_rng(seed)
    step = 2.0 * np.pi / 16384.0
    return {
        "motor_angle": ("rad", step * np.round(ANGLE / step)),
        "motor_speed": ("rad/s", SPEED + rng.normal(0.0, 0.5, len(TIMES))),
        "torque": ("N m", 5.0 * np.cos(2.0 * TIMES) + rng.normal(0.0, 0.1, len(TIMES))),
        "command": ("rad/s", np.interp(TIMES, [0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 150.0, 150.0, 0.0, 0.0])),
    }


def only(found: tuple[hm.Finding, ...], kind: str) -> hm.Finding:
    matching = [finding for finding in found if finding.kind == kind]
    assert len(matching) == 1, found
    return matching[0]


def test_a_healthy_record_has_no_findings() -> None:
    for seed in range(5):
        assert record(**drive(seed)).findings == ()


def test_every_kind_that_can_be_repaired_is_a_kind_of_finding() -> None:
    assert set(WAYS) <= set(KINDS)


# ---- time


@pytest.mark.parametrize(("late", "missing"), [(1e306, "inf"), (1e250, r"1e\+253"), (float(TIMES[-1]) + 1.0, "1000")])
def test_a_damaged_time_of_any_size_is_a_gap(late: float, missing: str) -> None:
    times = TIMES.copy()
    times[-1] = late
    finding = only(record(times, x=("m", np.sin(TIMES))).findings, "gaps")
    # 1 s late at a step of 1 ms; 1e250 s / 1 ms; 1e306 s / 1 ms is more than the largest number
    assert re.search(rf"1 gaps, {missing} samples missing", finding.text)


def test_missing_samples_are_counted_and_filled_only_when_asked() -> None:
    keep = np.ones(len(TIMES), dtype=bool)
    keep[[100, 101, 102, 2000]] = False
    gappy = record(TIMES[keep], x=("m", np.sin(TIMES[keep])))
    finding = only(gappy.findings, "gaps")
    assert "2 gaps, 4 samples missing, the longest 0.004 s from t = 0.099 s" in finding.text
    assert finding.blocks
    with pytest.raises(hm.RecordError, match=r"cannot be used as it is:\n  gaps: 2 gaps"):
        gappy.checked()
    filled = hm.repaired(gappy, gaps="interpolate").checked()
    assert np.allclose(filled.times, TIMES, rtol=0.0, atol=1e-12)
    # a straight line over 4 ms misses sin(t) by at most h^2/8
    assert np.max(np.abs(filled["x"].values - np.sin(TIMES))) < 4e-3**2 / 8.0
    assert "4 missing samples in 2 gaps put on straight lines" in only(filled.findings, "gaps").text
    kept = hm.repaired(gappy, gaps="keep").checked()
    assert len(kept) == len(gappy)
    assert "(kept as it is, as asked)" in only(kept.findings, "gaps").text


def test_a_long_gap_is_not_bridged() -> None:
    keep = (TIMES < 1.0) | (TIMES > 1.5)
    gappy = record(TIMES[keep], x=("m", np.sin(TIMES[keep])))
    with pytest.raises(hm.RecordError, match=r"lacks 501 samples, more than longest = 10; a straight line there is no measurement"):
        hm.repaired(gappy, gaps="interpolate")
    assert gappy.between(0.0, 0.9).checked() is not None


def test_time_that_runs_backward_is_sorted_only_when_asked() -> None:
    order = np.arange(len(TIMES))
    order[[500, 501]] = [501, 500]
    shuffled = record(TIMES[order], x=("m", np.sin(TIMES[order])))
    assert "time runs backward 1 times, first from 0.501 s to 0.5 s" in only(shuffled.findings, "order").text
    for use in (lambda: shuffled.checked(), lambda: shuffled.resampled(2e-3), lambda: shuffled.history("x"), lambda: shuffled.split()):
        with pytest.raises(hm.RecordError):
            use()
    mended = hm.repaired(shuffled, order="sort").checked()
    assert np.array_equal(mended["x"].values, np.sin(TIMES))
    assert only(mended.findings, "order").repaired


def test_samples_at_one_time_are_joined_only_when_asked() -> None:
    times = np.insert(TIMES, 1000, TIMES[1000])
    values = np.insert(np.sin(TIMES), 1000, 7.0)
    double = record(times, x=("m", values))
    assert "1 samples have the time of the one before, first at 1 s" in only(double.findings, "duplicates").text
    first = hm.repaired(double, duplicates="first").checked()
    assert first["x"].values[1000] == 7.0
    mean = hm.repaired(double, duplicates="mean").checked()
    assert mean["x"].values[1000] == pytest.approx(0.5 * (7.0 + math.sin(1.0)))
    assert "the mean was taken (1 channels had different values there)" in only(mean.findings, "duplicates").text


def test_a_time_written_with_too_few_digits_is_recognised() -> None:
    coarse = record(np.floor(np.arange(4000) * 2.5e-4 * 1000.0) / 1000.0, x=("m", SPEED))
    assert "written with too few digits; if the sampling is even, read with time=0.00024" in only(coarse.findings, "duplicates").text


def test_jitter_is_reported_but_does_not_block() -> None:
    rng = np.random.default_rng(2)
    uneven = record(TIMES + rng.uniform(-1e-4, 1e-4, len(TIMES)), x=("m", SPEED))
    finding = only(uneven.findings, "uneven")
    # the difference of two even errors of +-0.1 steps has a standard deviation of 0.1 sqrt(2/3) = 8.2 %
    assert "steps vary by 8." in finding.text
    assert uneven.checked() is uneven
    assert [item.kind for item in hm.repaired(uneven, uneven="resample").findings if not item.repaired] == []


def test_uneven_sampling_by_nature_is_no_row_of_gaps() -> None:
    rng = np.random.default_rng(3)
    natural = record(np.sort(rng.uniform(0.0, 4.0, 4000)), x=("m", SPEED))
    assert [finding.kind for finding in natural.findings] == ["uneven"]


def test_a_record_of_a_few_samples_is_reported_and_of_one_refused() -> None:
    assert not only(record(TIMES[:10], x=("m", SPEED[:10])).findings, "short").blocks
    with pytest.raises(hm.RecordError, match="1 samples are too few"):
        record(TIMES[:1], x=("m", SPEED[:1])).checked()


def test_a_time_that_is_no_number_is_dropped_only_when_asked() -> None:
    times = TIMES.copy()
    times[7] = np.nan
    bad = record(times, x=("m", SPEED))
    assert bad.blocking[0].where == "sample 8"
    assert len(hm.repaired(bad, not_finite="drop", gaps="interpolate").checked()) == len(TIMES)


def test_a_second_clock_that_drifts_is_reported() -> None:
    rng = np.random.default_rng(1)
    other = 0.2 + TIMES * (1.0 + 35e-6) + rng.normal(0.0, 1e-6, len(TIMES))
    finding = only(record(plc_time=("s", np.sort(other)), x=("m", SPEED)).findings, "clock")
    # error of the slope: 1e-6 / (std(t) sqrt(n)) = 1e-6 / (1.15 * 63) = 1.4e-8, so 35 us/s is 34.9 to 35.1
    assert finding.text.startswith("this clock gains 3")
    assert float(finding.text.split()[3]) == pytest.approx(35.0, abs=0.1)
    assert record(plc_time=("s", 0.2 + TIMES), x=("m", SPEED)).findings == ()


# ---- values


def test_values_that_are_not_finite_are_told_by_channel() -> None:
    values = SPEED.copy()
    values[[10, 11, 12, 300]] = [np.nan, np.inf, np.nan, np.nan]
    bad = record(x=("m", values), y=("m", SPEED))
    finding = only(bad.findings, "not_finite")
    assert (finding.channel, finding.where) == ("x", "t = 0.01 s")
    assert "4 of 4000 values are missing or no numbers (1 infinite), the longest run 3 samples" in finding.text
    mended = hm.repaired(bad, not_finite="interpolate").checked()
    assert mended["x"].values[11] == pytest.approx(0.5 * (SPEED[9] + SPEED[13]))
    dropped = hm.repaired(bad, not_finite="drop", gaps="keep").checked()
    assert len(dropped) == len(TIMES) - 4
    with pytest.raises(hm.RecordError, match="a run of 3 samples"):
        hm.repaired(bad, not_finite="interpolate", longest=2)


@pytest.mark.parametrize(("true_unit", "factor"), [("rpm", 30.0 / math.pi), ("deg/s", 180.0 / math.pi), ("revolution/s", 0.5 / math.pi)])
def test_a_speed_in_the_wrong_unit_is_found_by_the_angle_and_repaired_by_name(true_unit: str, factor: float) -> None:
    channels = drive()
    wrong = record(**(channels | {"motor_speed": ("rad/s", channels["motor_speed"][1] * factor)}))
    finding = only(wrong.findings, "units")
    assert f"motor_speed is in {true_unit} (units={{'motor_speed': '{true_unit}'}})" in finding.text
    with pytest.raises(hm.RecordError, match="units in 'motor_speed'"):
        wrong.checked()
    mended = hm.repaired(wrong, units={"motor_speed": true_unit}).checked()
    assert np.allclose(mended["motor_speed"].values, channels["motor_speed"][1], rtol=1e-12)
    assert only(mended.findings, "units").repaired
    assert hm.repaired(wrong, units="keep").checked()["motor_speed"].values is not None
    with pytest.raises(hm.UnitError, match="its numbers cannot be in 'mm'"):
        hm.repaired(wrong, units={"motor_speed": "mm"})


def test_an_angle_in_degrees_is_found_by_the_speed() -> None:
    channels = drive()
    wrong = record(**(channels | {"motor_angle": ("rad", np.degrees(channels["motor_angle"][1]))}))
    assert "motor_angle is in deg (units={'motor_angle': 'deg'})" in only(wrong.findings, "units").text


def test_an_angle_that_is_no_degrees_is_named_beside_a_speed_that_may_be() -> None:
    """Radians under a header that says degrees: the speed is right, and must not be the only one to blame."""
    channels = drive()
    wrong = record(**(channels | {"motor_angle": ("rad", np.radians(channels["motor_angle"][1]))}))
    finding = only(wrong.findings, "units")
    assert "motor_angle is in rad and was read as deg" in finding.text
    assert finding.blocks
    slow = record(**(channels | {"motor_speed": ("rad/s", channels["motor_speed"][1] * math.pi / 30.0)}))
    assert "motor_speed is in rad/s and was read as rpm" in only(slow.findings, "units").text


def test_an_accelerometer_in_multiples_of_gravity_with_an_offset_is_found() -> None:
    speed = 0.3 * np.sin(12.0 * TIMES)
    measured = 0.3 * 12.0 * np.cos(12.0 * TIMES) / 9.80665 + 0.05
    wrong = record(arm_speed=("m/s", speed), arm_acceleration=("m/s^2", measured))
    assert "arm_acceleration is in g_0" in only(wrong.findings, "units").text


def test_opposite_senses_are_reported_and_a_gear_between_two_places_is_not() -> None:
    channels = drive()
    turned = record(**(channels | {"motor_speed": ("rad/s", -channels["motor_speed"][1])}))
    finding = only(turned.findings, "units")
    assert "positive senses are opposite" in finding.text
    assert not finding.blocks
    geared = record(motor_angle=("rad", ANGLE), load_speed=("rad/s", SPEED / 50.0))
    assert geared.findings == ()


def test_two_measurements_that_do_not_follow_each_other_say_nothing_about_units() -> None:
    rng = np.random.default_rng(6)
    assert record(motor_angle=("rad", ANGLE), motor_speed=("rad/s", rng.normal(0.0, 50.0, len(TIMES)))).findings == ()


# ---- sensors


@pytest.mark.parametrize("limit", [80.0, 150.0])
def test_a_saturated_sensor_is_refused(limit: float) -> None:
    clipped = record(speed=("rad/s", np.minimum(SPEED, limit)))
    finding = only(clipped.findings, "saturated")
    assert f"cut off at its largest value {limit:g} rad/s" in finding.text
    assert finding.blocks
    assert (
        "speed"
        not in hm.repaired(clipped.with_channels([*clipped, hm.Measurement(name="x", unit="m", values=SPEED)]), saturated="drop").checked()
    )
    assert hm.repaired(clipped, saturated="keep").checked()["speed"].values.max() == limit


def test_a_noisy_saturated_sensor_is_refused_too() -> None:
    rng = np.random.default_rng(8)
    torque = np.clip(6.0 * np.sin(9.0 * TIMES) + rng.normal(0.0, 0.05, len(TIMES)), -5.0, 5.0)
    found = record(torque=("N m", torque)).findings
    assert [finding.kind for finding in found] == ["saturated", "saturated"]


def test_healthy_signals_of_many_kinds_are_not_refused() -> None:
    rng = np.random.default_rng(7)
    for _ in range(60):
        times = np.arange(int(rng.integers(500, 6000))) * STEP
        corners = np.interp(times, np.sort(rng.uniform(0.0, times[-1], 8)), rng.normal(size=8))
        move = np.clip((times - 0.3) / rng.uniform(0.1, 1.0), 0.0, 1.0)
        shapes = [np.sin(times * rng.uniform(1.0, 150.0)), corners, move**2 * (3.0 - 2.0 * move), np.cumsum(rng.normal(size=len(times)))]
        shape = shapes[rng.integers(len(shapes))]
        noisy = shape + np.ptp(shape) * rng.choice([0.0, 1e-4, 1e-2]) * rng.normal(size=len(times))
        rounding = np.ptp(shape) * rng.choice([1e-6, 1e-4, 1e-3])
        assert record(times, x=("m", rounding * np.round(noisy / rounding))).blocking == ()


def test_rest_at_an_extreme_is_no_saturation() -> None:
    # an arm that swings out and stops: the encoder shows its largest value from then on
    angle = np.where(TIMES < 2.0, 0.5 * (1.0 - np.cos(0.5 * math.pi * TIMES)), 1.0)
    rounded = 1e-4 * np.round(angle / 1e-4)
    assert record(arm=("rad", rounded)).findings == ()


def test_a_sensor_whose_noise_stops_is_stuck() -> None:
    channels = drive()
    values = channels["torque"][1].copy()
    values[1500:2500] = values[1500]
    stuck = record(**(channels | {"torque": ("N m", values)}))
    finding = only(stuck.findings, "stuck")
    assert (finding.channel, finding.where) == ("torque", "t = 1.5 s to 2.499 s")
    assert "for 1000 samples" in finding.text
    with pytest.raises(hm.RecordError, match="stuck in 'torque'"):
        stuck.checked()
    assert stuck.between(0.0, 1.4).checked() is not None
    assert "torque" not in hm.repaired(stuck, stuck="drop").checked()


def test_an_encoder_that_stops_while_the_speed_goes_on_is_stuck() -> None:
    channels = drive()
    values = channels["motor_angle"][1].copy()
    values[3000:] = values[3000]
    stuck = record(motor_angle=("rad", values), load_angle=("rad", ANGLE / 100.0))
    finding = only(stuck.findings, "stuck")
    assert "while load_angle, which it follows elsewhere, moves on" in finding.text


def test_a_drive_at_rest_is_not_stuck() -> None:
    angle = np.where(TIMES < 2.0, 10.0 * (1.0 - np.cos(0.5 * math.pi * TIMES)), 20.0)
    step = 2.0 * np.pi / 16384.0
    at_rest = record(motor=("rad", step * np.round(angle / step)), load=("rad", 1e-6 * np.round(angle / 100.0 / 1e-6)))
    assert at_rest.findings == ()


@pytest.mark.parametrize("before", range(2, 40))
def test_an_encoder_that_stands_still_but_for_a_tick_is_read(before: int) -> None:
    # the shaft held at rest: too few samples beside the flat stretch to tell a straight line from
    step = 2.0 * np.pi / 8192.0
    ticked = np.where(np.arange(len(TIMES)) < before, step, 0.0)
    assert record(spin=("rad", ticked), load=("rad", ANGLE / 100.0)).checked().findings == ()
    several = np.where(np.arange(len(TIMES)) < before, step * (np.arange(len(TIMES)) % 2), 0.0)
    assert record(spin=("rad", several), load=("rad", ANGLE / 100.0)).checked().findings == ()


def test_a_constant_input_is_reported() -> None:
    finding = only(record(load_torque=("N m", np.full(len(TIMES), 20.0)), x=("m", SPEED)).findings, "constant")
    assert finding.text == "constant at 20 N m over the whole record: it excites nothing and shows nothing"
    assert not finding.blocks


def test_an_unknown_repair_is_refused() -> None:
    with pytest.raises(hm.PlaceError, match=r"No repair of gaps 'guess'. repaired\(\) has: interpolate, keep."):
        hm.repaired(record(**drive()), gaps="guess")


def test_repairing_a_healthy_record_changes_nothing() -> None:
    healthy = record(**drive())
    ways = {"not_finite": "drop", "order": "sort", "duplicates": "first", "gaps": "interpolate", "uneven": "resample"}
    again = hm.repaired(healthy, **ways)
    assert again.repairs == ()
    assert again.times is healthy.times or np.array_equal(again.times, healthy.times)
    for channel in healthy:
        assert np.array_equal(again[channel.name].values, channel.values)
