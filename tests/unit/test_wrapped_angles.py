"""Angles within one turn are found, unwrapped on request, and told from what only looks like them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import pytest

import hdrive_mbs as hm

FloatArray = npt.NDArray[np.float64]

TIMES = np.linspace(0.0, 4.0, 4001)
SEAM = 2e-5
"""Of the motion: a period that is no whole turn is read off a jump and the mean of the 20 steps of 1 ms to each side, which differs from
the step across it by less than (20 ms)^2 w^2/6 of a step: w = 3 rad/s, 6e-4 of a step of 0.02 of the period, once in each period."""
TURNING = {
    "up": 30.0 * TIMES,
    "down": -30.0 * TIMES,
    "to and fro": 12.0 * np.sin(3.0 * TIMES),
    "run-up": 20.0 * TIMES**2,
    "once": 1.2 * TIMES + 3.0,
}


def record(angle: FloatArray, **others: FloatArray) -> hm.Record:
    units = {"motor_speed": "rad/s"}
    channels = {"motor_angle": angle, **others}
    made = {name: hm.Measurement(name=name, unit=units.get(name, "rad"), values=values) for name, values in channels.items()}
    return hm.Record(name="run", times=TIMES, channels=made)


def kinds(given: hm.Record) -> list[str]:
    return [finding.kind for finding in given.blocking]


@pytest.mark.parametrize("name", TURNING)
@pytest.mark.parametrize(("period", "noise"), [(2.0 * np.pi, 0.0), (2.0 * np.pi, 2e-3), (1.7, 0.0)])
def test_an_angle_that_begins_again_is_refused_and_goes_on_when_unwrapped(name: str, period: float, noise: float) -> None:
    true = TURNING[name] + noise * np.random.default_rng(3).standard_normal(len(TIMES))
    given = record(np.mod(true, period))
    assert kinds(given) == ["wrapped"]
    with pytest.raises(hm.RecordError, match=r"begins again .* an angle within one turn\. Use wrapped='unwrap'"):
        given.checked()
    mended = hm.repaired(given, wrapped="unwrap").checked()
    off = mended["motor_angle"].values - true
    np.testing.assert_allclose(off - off[0], 0.0, atol=1e-9 if period == 2.0 * np.pi else SEAM * np.ptp(true))
    assert [finding.kind for finding in mended.findings if finding.repaired] == ["wrapped"]
    np.testing.assert_array_equal(hm.repaired(given, wrapped="keep").checked()["motor_angle"].values, given["motor_angle"].values)


def test_counts_from_minus_half_to_half_a_turn_and_missing_values() -> None:
    true = TURNING["up"]
    angle = np.mod(true + np.pi, 2.0 * np.pi) - np.pi
    angle[[700, 701, 2500]] = np.nan
    given = hm.repaired(record(angle), not_finite="drop", wrapped="unwrap")
    good = np.isfinite(angle)
    np.testing.assert_allclose(given["motor_angle"].values, true[good], atol=1e-9)


def seam_of(angle: FloatArray) -> int:
    return int(np.argmax(np.abs(np.diff(angle))))


@pytest.mark.parametrize("how", ["interpolate", "drop"])
def test_missing_values_at_the_only_seam_are_filled_after_it_is_mended(how: str) -> None:
    angle = np.mod(TURNING["once"], 2.0 * np.pi)
    seam = seam_of(angle)
    angle[[seam, seam + 1]] = np.nan
    given = record(angle)
    assert set(kinds(given)) == {"wrapped", "not_finite"}
    assert f"t = {TIMES[seam - 1]:.6g} s" in str(next(finding for finding in given.blocking if finding.kind == "wrapped"))
    mended = hm.repaired(given, not_finite=how, gaps="keep", wrapped="unwrap").checked()
    np.testing.assert_allclose(mended["motor_angle"].values, 1.2 * mended.times + 3.0, atol=1e-9)


def test_nothing_is_interpolated_from_the_end_of_a_turn_to_its_beginning() -> None:
    angle = np.mod(TURNING["once"], 2.0 * np.pi)
    lost = np.delete(np.arange(len(TIMES)), [seam_of(angle), seam_of(angle) + 1])
    gap = record(angle).taking(lost)
    holes = record(np.where(np.isin(np.arange(len(TIMES)), lost), angle, np.nan))
    for given, way in ((gap, {"gaps": "interpolate"}), (holes, {"not_finite": "interpolate"})):
        with pytest.raises(hm.RecordError, match="a line from the end of a turn to its beginning is no measurement; add wrapped='unwrap'"):
            hm.repaired(given, **way)
        filled = hm.repaired(given, **way, wrapped="unwrap").checked()
        np.testing.assert_allclose(filled["motor_angle"].values, TURNING["once"], atol=1e-9)
        hm.repaired(given, **way, wrapped="keep").checked()


@pytest.mark.parametrize(
    "angle",
    [
        TURNING["up"],
        TURNING["to and fro"],
        np.where(TIMES > 2.0, 6.28, 0.0),  # a reference that steps
        np.where(np.arange(4001) == 2000, 6.0, 0.001 * np.arange(4001) / 4001),  # one spike
        np.floor(TIMES) * 1.5,  # steps all one way
        np.sin(2000.0 * TIMES),  # too few samples in a period
        np.zeros(4001),
    ],
    ids=["turning", "swinging", "step", "spike", "stairs", "fast", "still"],
)
def test_what_does_not_begin_again_is_left_alone(angle: FloatArray) -> None:
    assert "wrapped" not in kinds(record(angle))


def test_the_speed_beside_it_is_held_against_the_angle_that_goes_on() -> None:
    """A speed in rev/min that was read as rad/s is found once the angle is unwrapped."""
    given = record(np.mod(TURNING["run-up"], 2.0 * np.pi), motor_speed=40.0 * TIMES * 30.0 / np.pi)
    assert kinds(given) == ["wrapped"]
    mended = hm.repaired(given, wrapped="unwrap")
    assert kinds(mended) == ["units"]


def test_another_word_is_refused() -> None:
    with pytest.raises(hm.PlaceError, match="repair of wrapped"):
        hm.repaired(record(TURNING["up"]), wrapped="drop")
