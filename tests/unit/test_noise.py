"""Residuals made white, from the first sample on."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.noise import Whitener

COUNT = 60


def covariance(measured: Measured) -> np.ndarray:
    """Of the noise of a column, offset included."""
    sigma, kept = measured.coloured
    apart = np.abs(np.subtract.outer(np.arange(COUNT), np.arange(COUNT)))
    return np.asarray(measured.white**2 * np.eye(COUNT) + sigma**2 * kept**apart + measured.offset**2)


@pytest.mark.parametrize("offset", [0.0, 0.7])
@pytest.mark.parametrize(
    ("white", "sigma", "kept"), [(1.0, 0.0, 0.0), (0.1, 1.0, 0.95), (0.02, 1.0, 0.999), (1.0, 0.3, 0.5), (0.3, 2.0, 0.0)]
)
def test_whitened_noise_has_the_identity_for_covariance_from_the_first_sample_on(
    white: float, sigma: float, kept: float, offset: float
) -> None:
    measured = Measured(channel="a", noise=white, coloured=(sigma, kept), offset=offset)
    whiten = Whitener(measured, np.ones(COUNT, dtype=bool))
    matrix = np.array([whiten(row) for row in np.eye(COUNT)]).T
    np.testing.assert_allclose(matrix @ covariance(measured) @ matrix.T, np.eye(COUNT), atol=1e-9)


def test_an_offset_that_is_not_there_is_no_evidence() -> None:
    """Before, the first samples of strongly coloured noise alone gained 160 in log-likelihood on average for a constant."""
    rng = np.random.default_rng(4)
    measured = Measured(channel="a", noise=0.02, coloured=(1.0, 0.999))
    whiten = Whitener(measured, np.ones(2000, dtype=bool))
    constant = whiten(np.ones(2000))
    gains = []
    for _ in range(60):
        noise = np.empty(2000)
        noise[0] = rng.normal()
        for k in range(1, 2000):
            noise[k] = 0.999 * noise[k - 1] + math.sqrt(1.0 - 0.999**2) * rng.normal()
        white = whiten(noise + 0.02 * rng.normal(size=2000))
        gains.append(0.5 * (white @ constant) ** 2 / (constant @ constant))
    assert 0.2 < np.mean(gains) < 1.0  # 1/2 for one number that is not there
