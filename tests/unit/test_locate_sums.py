"""Sums of a localisation that are kept, against what they stand for, written out."""

from __future__ import annotations

import numpy as np
import pytest

from hdrive_mbs.diagnosis.locate import Localiser
from hdrive_mbs.diagnosis.locate import spectra as spectra_of_rows
from hdrive_mbs.diagnosis.locate.line import of_windows
from hdrive_mbs.diagnosis.locate.observer import FINER, NEAR, averaged
from tests.unit.test_locate_rotors import along_x, localiser


@pytest.fixture(scope="module")
def place() -> Localiser:
    return localiser(along_x(rotor_1=1.0))


def test_the_curvature_is_that_of_the_covariance_with_a_force(place: Localiser) -> None:
    """J^H (rho (I + s^2 H H^H))^-1 J, window by window and bin by bin."""
    about = place._about
    likelihood, name = about.likelihood, place._tried[0].name
    directions = about.place(name)
    found = likelihood.of(directions, np.zeros(len(likelihood.at)), rounds=1)
    curvature, slope = np.zeros_like(found.curvature), np.zeros_like(found.slope)
    for item, part, fit in zip(about.spectra, directions, found.fits, strict=True):
        assert part is not None
        values, scale = item.values.astype(complex), np.repeat(fit.scale, item.widths, axis=1)
        pushed = np.einsum("wbcd,wbd,wbed->wbce", part.along, part.power, part.along.conj())
        covariance = scale[..., None, None] * (np.eye(values.shape[2]) + fit.strength[..., None, None] * pushed)
        weighted = np.linalg.solve(covariance, values)
        total = np.einsum("wbcp,wbcq->pq", values.conj(), weighted).real
        curvature, slope = curvature + total[1:, 1:], slope + total[1:, 0]
    assert any(np.any(fit.strength > 0.0) for fit in found.fits)
    size = np.sqrt(np.outer(np.diag(curvature), np.diag(curvature)))
    assert np.max(np.abs(found.curvature - curvature) / size) < 1e-11  # rounding of a sum of 1e5 terms: 1e-13
    assert np.max(np.abs(found.slope - slope)) < 1e-11 * np.max(np.abs(slope))


def test_what_is_let_go_is_worked_out_again(place: Localiser) -> None:
    about, name = place._about, place._tried[0].name
    start = np.zeros(len(about.likelihood.at))
    before = about.likelihood.of(about.place(name), start)
    assert about.likelihood._grams
    assert about.responses[0].of._kept
    about.forget()
    assert not about.likelihood._grams
    assert not about.responses[0].of._kept
    after = about.likelihood.of(about.place(name), start)
    assert after.log_likelihood == before.log_likelihood
    np.testing.assert_array_equal(after.z, before.z)


@pytest.mark.parametrize("rounded", [(), (0, 3), tuple(range(8))], ids=["none", "some", "all"])
def test_noise_of_columns_counts_by_itself_where_one_of_them_is_rounded(place: Localiser, rounded: tuple[int, ...]) -> None:
    """The whitening makes the sum over the noise of each column the unit matrix."""
    observer = place._about.lines[0].observer
    assert observer is not None
    every, columns = observer.every, observer.read.shape[1]
    assert columns == 8
    rng = np.random.default_rng(5)
    windows, bins = len(observer.kept) - 1, 12
    quiet = np.ones((windows, bins, columns))
    quiet[:, :, list(rounded)] = rng.uniform(0.2, 0.9, (windows, bins, len(rounded)))
    whitener = rng.uniform(0.5, 2.0, (200, columns)).astype(complex)
    found = spectra_of_rows._against(observer, whitener, quiet, every)
    points = np.arange(-NEAR, FINER * (bins - 1) + NEAR + 1)
    transfer = observer.noise_transfer(2.0 * np.pi * points / (every * 2 * 199))
    noise = np.zeros((windows, bins, columns, columns), complex)
    for k in range(columns):
        one = transfer[..., k] / np.abs(whitener[np.abs(points)][None, :, None, k])
        noise += of_windows(averaged(np.einsum("spi,spj->spij", one, one.conj()), bins), windows) / quiet[:, :, k, None, None] ** 2
    white = found @ noise @ np.swapaxes(found.conj(), 2, 3)
    assert np.max(np.abs(white - np.eye(columns))) < 1e-10
