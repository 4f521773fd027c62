"""Records: channels by name and quantity, parts, even times without aliases, two clocks brought together."""

from __future__ import annotations

import math

import numpy as np
import pytest

import hdrive_mbs as hm
from models.harmonic_drive_train import build


def record(times: np.ndarray, name: str = "run", run: str = "", **channels: tuple[str, np.ndarray]) -> hm.Record:
    made = {key: hm.Measurement(name=key, unit=unit, values=values) for key, (unit, values) in channels.items()}
    return hm.Record(name=name, times=times, channels=made, run=run)


def swinging(step: float = 1e-3, duration: float = 2.0) -> hm.Record:
    times = np.arange(round(duration / step)) * step
    return record(times, angle=("rad", np.sin(7.0 * times)), torque=("N m", 3.0 * np.cos(5.0 * times) + times))


# ---- one record


def test_a_channel_is_found_by_its_name_and_by_its_quantity() -> None:
    mapped = swinging().mapped({"angle": "motor.angle"})
    assert mapped["angle"] is mapped["motor.angle"]
    assert "motor.angle" in mapped
    assert mapped.history("motor.angle").unit == "rad"
    with pytest.raises(hm.PlaceError, match=r"No channel 'speed'. Record 'run' has: angle \(motor.angle\), torque."):
        _ = mapped["speed"]


def test_values_cannot_be_changed_and_changing_the_source_changes_nothing() -> None:
    times, values = np.arange(20.0), np.arange(20.0)
    made = record(times, x=("m", values))
    values[3] = 99.0
    assert made["x"].values[3] == 3.0
    with pytest.raises(ValueError, match="read-only"):
        made["x"].values[3] = 1.0


def test_a_record_of_unequal_lengths_or_with_one_quantity_twice_is_refused() -> None:
    with pytest.raises(hm.ParameterError, match="'x' has 5 values at 6 times"):
        record(np.arange(6.0), x=("m", np.arange(5.0)))
    with pytest.raises(hm.ParameterError, match=r"two channels measure 'motor.angle'"):
        swinging().mapped({"angle": "motor.angle", "torque": "motor.angle"})
    with pytest.raises(hm.ParameterError, match="two channels one name"):
        swinging().renamed({"angle": "torque"})


def test_noise_and_rounding_make_the_floor() -> None:
    noisy = swinging().annotated(noise={"torque": 0.03}, resolution={"torque": 0.1, "angle": 0.01})
    # variance of an error that is even over one step: resolution^2 / 12
    assert noisy["torque"].floor == pytest.approx(math.sqrt(0.03**2 + 0.1**2 / 12.0))
    assert noisy["angle"].floor == pytest.approx(0.01 / math.sqrt(12.0))
    assert swinging()["angle"].floor is None
    with pytest.raises(hm.ParameterError, match="noise = -1 N m"):
        swinging().annotated(noise={"torque": -1.0})


def test_a_record_shorter_than_needed_or_without_a_channel_is_refused() -> None:
    assert swinging().require("angle", duration=1.9, samples=2000) is not None
    with pytest.raises(hm.RecordError, match=r"has 2000 samples over 1.999 s; needed are 0 samples over 3 s"):
        swinging().require("angle", duration=3.0)
    with pytest.raises(hm.PlaceError, match="No channel 'speed'"):
        swinging().require("speed")


def test_a_quantity_that_the_scene_lacks_or_measures_otherwise_is_refused() -> None:
    known = {channel.name: channel.unit for channel in build().network().channels}
    swinging().mapped({"angle": "motor.angle", "torque": "gear.torque"}).fits(known)
    with pytest.raises(hm.PlaceError, match=r"maps 'angle' to 'gaer.angle', which is no channel of it. The scene has: .*motor"):
        swinging().mapped({"angle": "gaer.angle"}).fits(known)
    with pytest.raises(hm.UnitError, match=r"'angle' is in rad, but motor.speed is in rad/s"):
        swinging().mapped({"angle": "motor.speed"}).fits(known)


def test_simulated_histories_become_a_record() -> None:
    response = hm.simulate(build(), 0.05, sample_step=1e-3)
    made = hm.Record.of("simulated", [response["motor.speed"], response["motor.angle"]])
    assert np.array_equal(made["motor.speed"].values, response["motor.speed"].values)
    assert made.checked() is made


def test_what_is_printed_fits_on_a_screen_and_names_everything() -> None:
    text = repr(swinging().mapped({"angle": "motor.angle"}).resampled(2e-3))
    assert "Record 'run': 1000 samples, 0.002 s apart, over 1.998 s" in text
    assert "angle [rad] -> motor.angle: 1000 values" in text
    assert "note: resampled from 0.001 s to 0.002 s after a zero-phase low-pass" in text


# ---- parts


def test_parts_share_no_sample_and_leave_none_out() -> None:
    whole = swinging()
    for by in ("blocks", "end"):
        split = whole.split(0.7, by)
        fit, held = split.fit_samples["run"], split.held_out_samples["run"]
        assert not np.any(fit & held)
        assert np.all(fit | held)
        assert np.mean(fit) == pytest.approx(0.7, abs=0.01)
        assert np.array_equal(np.concatenate([piece.times for piece in split.held_out]), whole.times[held])
        assert {piece.run for piece in (*split.fit, *split.held_out)} == {"run"}
    assert split.held_out.records[0].times[0] == pytest.approx(1.4)  # the last 30 % of 2 s


def test_held_out_blocks_are_spread_over_the_record() -> None:
    held = swinging().split(0.7).held_out
    # 3 of 10 blocks of 0.2 s
    assert [round(float(piece.times[0]), 3) for piece in held] == [0.2, 1.0, 1.6]


def test_a_guard_keeps_the_parts_apart() -> None:
    split = swinging().split(0.7, guard=0.05)
    distances = np.abs(np.subtract.outer(swinging().times[split.fit_samples["run"]], swinging().times[split.held_out_samples["run"]]))
    assert distances.min() >= 0.1 - 1e-9


def test_a_split_that_leaves_a_part_empty_is_refused() -> None:
    with pytest.raises(hm.ParameterError, match="fit = 1 must lie between 0 and 1"):
        swinging().split(1.0)
    with pytest.raises(hm.RecordError, match="too short: 0 samples are left"):
        swinging().split(0.7, guard=0.3)
    with pytest.raises(hm.PlaceError, match="No way to split 'half'"):
        swinging().split(0.5, "half")
    with pytest.raises(hm.RecordError, match=r"no sample between 5 s and 6 s; it goes from 0 s to 1.999 s"):
        swinging().between(5.0, 6.0)


def test_whole_runs_are_held_out_with_all_their_sensor_sets() -> None:
    sets = [swinging().replacing(name=f"{run}:{kind}", run=run) for run in ("a", "b", "c") for kind in ("motor", "load")]
    split = hm.Records.of(*sets).split(0.7, by="runs")
    assert split.fit.names == ("a:motor", "a:load", "b:motor", "b:load")
    assert split.held_out.names == ("c:motor", "c:load")
    assert not split.fit_samples["c:load"].any()


# ---- even times


def test_resampling_to_a_finer_step_is_exact_at_the_samples_and_close_between() -> None:
    fine = swinging().resampled(5e-4)
    assert np.allclose(fine["angle"].values[::2], swinging()["angle"].values, rtol=0.0, atol=1e-12)
    # PCHIP takes slopes from differences, so its error is of order h^2 where the slope changes its sign and h^3 else:
    # at most 49 h^2 / 8 = 6e-6 for sin(7 t) at h = 1 ms
    assert np.max(np.abs(fine["angle"].values - np.sin(7.0 * fine.times))) < 49.0 * 1e-6 / 8.0


def test_a_coarser_step_keeps_what_is_slow_and_removes_what_would_come_back_as_an_alias() -> None:
    times = np.arange(8000) * 1e-3
    slow, fast = np.sin(2.0 * np.pi * 3.0 * times), np.sin(2.0 * np.pi * 97.0 * times)
    coarse = record(times, slow=("m", slow), fast=("m", fast)).resampled(0.02)  # Nyquist frequency 25 Hz
    middle = slice(50, -50)
    assert np.std(fast[::20][middle]) > 0.5  # without a filter 97 Hz comes back as 3 Hz
    assert np.max(np.abs(coarse["fast"].values[middle])) < 2e-4  # -80 dB is 1e-4
    assert np.max(np.abs(coarse["slow"].values - slow[::20])[middle]) < 2e-4


def test_a_growing_angle_keeps_its_growth_to_its_ends() -> None:
    times = np.arange(4000) * 1e-3
    coarse = record(times, angle=("rad", 150.0 * times + 2.0)).resampled(0.01)
    assert np.allclose(coarse["angle"].values, 150.0 * coarse.times + 2.0, rtol=0.0, atol=1e-9)


def test_white_noise_falls_as_the_record_says() -> None:
    rng = np.random.default_rng(3)
    times = np.arange(100_000) * 1e-3
    noisy = record(times, x=("m", rng.normal(0.0, 0.5, len(times)))).annotated(noise={"x": 0.5})
    coarse = noisy.resampled(0.008)
    assert coarse["x"].noise is not None
    # 12,500 values, of which about 90 % independent: the estimate of sigma has an error of 1/sqrt(2 * 11000) = 0.7 %
    assert np.std(coarse["x"].values) == pytest.approx(coarse["x"].noise, rel=0.03)


def test_uneven_samples_are_brought_to_even_times() -> None:
    rng = np.random.default_rng(1)
    times = np.sort(rng.uniform(0.0, 2.0, 4000))
    even = record(times, angle=("rad", np.sin(7.0 * times))).resampled(1e-3)
    assert np.allclose(np.diff(even.times), 1e-3)
    assert np.max(np.abs(even["angle"].values - np.sin(7.0 * even.times))) < 1e-3


def test_a_step_that_makes_no_sense_is_refused() -> None:
    with pytest.raises(hm.ParameterError, match="step = 0 s must be greater than 0 s"):
        swinging().resampled(0.0)
    with pytest.raises(hm.ParameterError, match="longer than the record"):
        swinging().resampled(5.0)
    nan = swinging()["angle"].values.copy()
    nan[5] = np.nan
    with pytest.raises(hm.RecordError, match="not finite; repair it"):
        record(swinging().times, angle=("rad", nan)).resampled(2e-3)


# ---- two clocks


def signal(times: np.ndarray) -> np.ndarray:
    """A sweep with a load jump: something that tells one time from another."""
    return np.sin(8.0 * times + 1.5 * times**2) + 0.5 * np.tanh(20.0 * (times - 3.0))


def two_loggers(offset: float, drift: float, noise: float = 1e-3, seed: int = 0) -> tuple[hm.Record, hm.Record]:
    """A reference at 1 kHz and a second logger at 400 Hz, whose clock is offset and drifts."""
    rng = np.random.default_rng(seed)
    first = np.arange(6000) * 1e-3
    second = np.arange(2400) * 2.5e-3
    true = second + offset + drift * second  # reference time at which the second logger took its samples
    one = record(
        first, "run:motor", "run", speed=("rad/s", signal(first) + rng.normal(0.0, noise, len(first))), torque=("N m", np.cos(first))
    )
    two = record(
        second, "run:load", "run", speed=("rad/s", signal(true) + rng.normal(0.0, noise, len(second))), angle=("rad", 2.0 * np.sin(true))
    )
    return one, two


@pytest.mark.parametrize(("offset", "drift"), [(0.0, 0.0), (0.0314, 0.0), (-0.2107, 2e-4), (0.45, -3e-3), (2e-4, 5e-5)])
def test_offset_and_drift_of_a_clock_are_found_to_a_fraction_of_a_sample(offset: float, drift: float) -> None:
    match = hm.clock_match(*two_loggers(offset, drift), "speed")
    found = match.offset + match.drift * (np.array([0.0, 6.0]) - match.middle)
    # five standard deviations, which for noise of 0.001 on a signal that moves by 10 1/s are some microseconds
    assert match.drift == pytest.approx(drift, abs=5.0 * match.drift_error)
    assert found == pytest.approx([offset, offset + 6.0 * drift], abs=5.0 * (match.offset_error + 3.0 * match.drift_error))
    assert match.offset_error < 1e-5
    assert match.correlation > 0.999


def test_the_stated_error_of_a_clock_is_its_scatter_over_repetitions() -> None:
    matches = [hm.clock_match(*two_loggers(0.03, 1e-4, noise=0.02, seed=seed), "speed") for seed in range(30)]
    for name, error in (("offset", "offset_error"), ("drift", "drift_error")):
        scatter = np.std([getattr(match, name) - 1e-4 * (match.middle if name == "offset" else 0.0) for match in matches], ddof=1)
        # the standard deviation of 30 draws is itself uncertain by 1/sqrt(58) = 13 %: three of these
        assert scatter == pytest.approx(np.mean([getattr(match, error) for match in matches]), rel=0.4)


def test_an_aligned_record_lists_its_correction_and_can_be_joined_with_the_other() -> None:
    one, two = two_loggers(0.0314, 2e-4)
    records = hm.Records.of(one, two)
    with pytest.raises(hm.RecordError, match=r"run:load: its clock differs from that of 'run:motor' by 0.0314|by 0.03139"):
        records.checked()
    with pytest.raises(hm.RecordError, match="its clock differs"):
        records.together("run", 2e-3)
    mended = hm.Records.of(one, hm.aligned(two, hm.clock_match(one, two, "speed"))).checked()
    assert any(finding.repaired and finding.kind == "clock" for _, finding in mended.findings)
    joined = mended.together("run", 2.5e-3)
    assert list(joined.channels) == ["run:motor.speed", "torque", "run:load.speed", "angle"]
    assert np.max(np.abs(joined["angle"].values - 2.0 * np.sin(joined.times))) < 1e-3


def test_clocks_that_agree_are_not_touched() -> None:
    records = hm.Records.of(*two_loggers(0.0, 0.0))
    assert records.checked() is records


def test_clocks_are_not_matched_by_channels_that_are_not_alike() -> None:
    one, two = two_loggers(0.0, 0.0)
    rng = np.random.default_rng(4)
    other = record(two.times, "other", speed=("rad/s", np.cumsum(rng.normal(size=len(two)))), still=("m", np.zeros(len(two))))
    with pytest.raises(hm.AnalysisError, match="are not alike"):
        hm.clock_match(one, other, "speed")
    with pytest.raises(hm.AnalysisError, match="do not move together"):
        hm.clock_match(record(one.times, still=("m", np.zeros(len(one)))), other, "still")
    with pytest.raises(hm.ParameterError, match="clocks are compared by one quantity"):
        hm.clock_match(one, two, "speed", "angle")


# ---- several records


def test_records_of_different_sampling_live_side_by_side() -> None:
    records = hm.Records.of(swinging().replacing(name="fast", run=""), swinging(step=4e-3).replacing(name="slow", run=""))
    assert [item.step for item in records] == pytest.approx([1e-3, 4e-3])
    assert records["slow"].duration == pytest.approx(1.996)
    assert records.mapped({"angle": "motor.angle"})["slow"]["motor.angle"].name == "angle"
    with pytest.raises(hm.PlaceError, match=r"No channel 'speed'. None of the records has: angle, torque"):
        records.mapped({"speed": "motor.speed"})
    with pytest.raises(hm.PlaceError, match="No record 'middle'"):
        _ = records["middle"]
    with pytest.raises(hm.ParameterError, match="Two records are named 'run'"):
        hm.Records.of(swinging(), swinging())
