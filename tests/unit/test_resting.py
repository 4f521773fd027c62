"""Readings of a column at rest count once."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.resting import LONG, repeated

STEP = 1e-3
ENCODER = Measured(channel="motor.angle", resolution=STEP)


def rounded(values: np.ndarray) -> np.ndarray:
    return np.asarray(STEP * np.round(values / STEP))


def test_a_rest_counts_once_and_motion_in_full() -> None:
    moving = 0.7 * np.linspace(0.0, 1.0, 500)
    values = rounded(np.concatenate([moving, np.full(1000, 0.7312), 0.7312 - moving]))
    again = repeated(ENCODER, values)
    assert not again[:499].any()
    assert np.count_nonzero(again) >= 999
    rest = values == values[700]
    assert np.count_nonzero(~again & rest) == 1
    assert not again[~rest].any()


def test_of_every_few_samples_one_of_a_rest_is_kept() -> None:
    values = np.concatenate([STEP * np.arange(7), np.full(200, 7 * STEP), STEP * np.arange(8, 20)])
    for every in (1, 2, 3, 4, 5):
        used = ~repeated(ENCODER, values, every)[::every]
        assert np.count_nonzero(used & (values[::every] == 7 * STEP)) == 1


def test_slow_motion_and_noisy_columns_count_in_full() -> None:
    slow = rounded(np.linspace(0.0, 1.0, (LONG - 10) * 1000))  # so many equal readings in a row
    assert not repeated(ENCODER, slow).any()
    still = np.zeros(1000)
    for measured in (Measured(channel="a", resolution=STEP, noise=STEP), Measured(channel="a", noise=STEP)):
        assert not repeated(measured, still).any()


def test_a_shift_of_the_resting_place_is_no_evidence() -> None:
    """An exact model of a joint that rests for a second: before, a constant at rest gained hundreds in log-likelihood."""
    rng = np.random.default_rng(1)
    gains = []
    for _ in range(40):
        place = rng.uniform(0.0, 1.0)
        error = (rounded(np.full(2000, place)) - place) / (STEP / np.sqrt(12.0))
        used = ~repeated(ENCODER, rounded(np.full(2000, place)))
        gains.append(0.5 * np.sum(error[used]) ** 2 / np.count_nonzero(used))
    assert max(gains) <= 1.5  # (q/2)^2/(q^2/12)/2
    assert 0.3 < np.mean(gains) < 0.7
