"""What a fit leaves, for the question whether something else is to be looked for."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pytest

from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.robust import Blocks
from hdrive_mbs.diagnosis.unknowns import Factor

FloatArray = npt.NDArray[np.float64]
SAMPLES, PARTS = 1200, 12


class Struck:
    """Residuals of one deviation everywhere, and of some more in one of twelve stretches: what no parameter changes."""

    def __init__(self, blow: float) -> None:
        self.fit = np.ones(SAMPLES, bool)
        self.fit[::4] = False
        self.held_out = ~self.fit
        number = np.arange(SAMPLES) * PARTS // SAMPLES
        self.blocks, self.held_blocks = Blocks(number[self.fit]), Blocks(number[self.held_out])
        self.left = np.where(number == 5, blow, 1.0) * np.where(np.arange(SAMPLES) % 2, 1.0, -1.0)
        self.spans = (slice(0, int(self.fit.sum())),)
        self.unseen: dict[str, frozenset[int]] = {}

    def residuals(self, hypothesis: Hypothesis, points: Sequence[FloatArray], *left_out: object) -> list[FloatArray | None]:
        return [self.left + 1e-9 * z[0] for z in points]


def fitted(blow: float) -> Fitted:
    hypothesis = Hypothesis((Factor(path="shaft.stiffness", name="stiffness", nominal={"shaft.stiffness": 1.0}, sigma=0.01),))
    return fit(Struck(blow), hypothesis, np.zeros(1))  # type: ignore[arg-type]


@pytest.mark.parametrize("blow", [0.5, 1.0, 3.0, 30.0])
def test_a_stretch_that_fits_badly_counts_by_its_logarithm(blow: float) -> None:
    """11 of 12 stretches with the mean square 1, one with b^2: (11 + b^2)/12, and with 1 + log b^2 in its place where b > 1."""
    found = fitted(blow)
    assert found.chi_fit == pytest.approx((PARTS - 1 + blow**2) / PARTS, rel=1e-6)
    counted = blow**2 if blow <= 1.0 else 1.0 + math.log(blow**2)
    assert found.typical == pytest.approx((PARTS - 1 + counted) / PARTS, rel=1e-6)
    assert found.typical <= found.chi_fit * (1.0 + 1e-9)


def test_a_misfit_that_is_everywhere_still_calls_for_a_search() -> None:
    """A blow 30 times the noise in a twelfth of the samples leaves a mean square of 76, and 1.6 so: above what ends a search."""
    assert fitted(30.0).chi_fit > 75.0
    assert 1.5 < fitted(30.0).typical < 1.6
