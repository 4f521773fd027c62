"""A run written at even times is a record that the package reads again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from models.harmonic_drive_train import build

CHANNELS = ("motor.speed", "load.angle", "gear.torque")


@pytest.fixture(scope="module")
def run() -> hm.Response:
    return hm.simulate(build(), 0.3)


def test_what_is_written_at_even_times_is_read_as_a_record(run: hm.Response, tmp_path: Path) -> None:
    record = hm.read_record(run.to_csv(tmp_path / "run.csv", CHANNELS, step=1e-3))
    np.testing.assert_allclose(record.times, 1e-3 * np.arange(301), rtol=0.0, atol=1e-15)
    for name in CHANNELS:
        assert record[name].unit == run[name].unit
        np.testing.assert_allclose(record[name].values, run.at(name, record.times), rtol=1e-11, atol=1e-15)  # twelve digits are written


def test_all_channels_and_the_solver_s_own_times_stay_what_they_were(run: hm.Response, tmp_path: Path) -> None:
    whole = hm.read_columns(run.to_csv(tmp_path / "whole.csv"))
    assert len(next(iter(whole.values()))) == len(run.times)
    even = run.to_csv(tmp_path / "even.csv", step=0.1).read_text().splitlines()
    assert len(even) == 1 + 4
    assert even[0].count("[") == 1 + len(run.channels)


@pytest.mark.parametrize("step", [0.0, -1e-3, 0.31, float("nan")])
def test_a_step_that_gives_no_samples_is_refused(run: hm.Response, tmp_path: Path, step: float) -> None:
    with pytest.raises(hm.ParameterError, match=r"step = .* s: must be greater than 0 s and at most the duration of the run, 0\.3 s"):
        run.to_csv(tmp_path / "run.csv", step=step)
    assert not list(tmp_path.iterdir())
