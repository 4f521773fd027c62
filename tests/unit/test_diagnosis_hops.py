"""Hops out of small hollows, on a misfit that is known in closed form."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pytest

from hdrive_mbs.diagnosis import fit as fitting
from hdrive_mbs.diagnosis import hops
from hdrive_mbs.diagnosis.curved import Valley
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hops import WORTH, settled
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.robust import Blocks
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.diagnosis.verdict import PARAMETER_ODDS, TIED

FloatArray = npt.NDArray[np.float64]

SAMPLES = 4000
SLOPE, CENTRE = 0.5, 0.4
"""Of the bowl: 4000 samples that change by 0.5 a standard deviation each give it a width of 1/sqrt(4000 * 0.5^2) = 0.03."""


class Waved:
    """Residuals s (z - c) + w sin(k z) in every sample, and noise: hollows wherever k w is larger than s."""

    def __init__(self, wave: float, number: float) -> None:
        self.wave, self.number = wave, number
        self.fit = np.ones(SAMPLES, bool)
        self.fit[::4] = False
        self.held_out = ~self.fit
        self.blocks = Blocks(np.zeros(int(self.fit.sum()), int))
        self.held_blocks = Blocks(np.zeros(int(self.held_out.sum()), int))
        noise = np.random.default_rng(3).normal(size=SAMPLES)
        self.noise = noise - noise[self.fit].mean()  # so that the bottom of the bowl is where it is said to be
        self.spans = (slice(0, int(self.fit.sum())),)
        self.unseen: dict[str, frozenset[int]] = {}
        self.runs = 0

    def residuals(self, hypothesis: Hypothesis, points: Sequence[FloatArray], *left_out: object) -> list[FloatArray | None]:
        self.runs += len(points)
        return [self.noise + SLOPE * (z[0] - CENTRE) + self.wave * np.sin(self.number * z[0]) for z in points]


def begun(waved: Waved, at: float, share: float = 1e-7) -> Fitted:
    hypothesis = Hypothesis((Factor(path="shaft.stiffness", name="stiffness", nominal={"shaft.stiffness": 1.0}, sigma=0.01),))
    return fit(waved, hypothesis, np.array([at]), share=share)  # type: ignore[arg-type]


def test_a_hop_leads_out_of_a_hollow_and_down_the_bowl() -> None:
    """Hollows 2 pi/150 = 0.04 apart, little more than a width of the bowl: a fit from 1.0 stops beside where it begins."""
    waved = Waved(0.2, 150.0)
    stuck = begun(waved, 1.0)
    out = settled(waved, stuck)  # type: ignore[arg-type]
    assert 0.0 < abs(stuck.z[0] - 1.0) < 2.0 * np.pi / 150.0
    assert abs(out.z[0] - CENTRE) < 0.5 * abs(stuck.z[0] - CENTRE)
    assert out.cost < stuck.cost - WORTH


def test_in_a_hollow_a_curve_is_followed_once_for_each_set_of_differences(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """However often the damping is raised there, which changes neither the step nor how it bends."""
    valleys: list[Valley] = []
    steps: list[int] = []
    monkeypatch.setattr(Valley, "followed", lambda self, *_: valleys.append(self) or [])
    proposals = fitting._proposals
    monkeypatch.setattr(fitting, "_proposals", lambda *given: steps.append(1) or proposals(*given))
    waved = Waved(0.15, 300.0)
    hypothesis = begun(Waved(0.0, 1.0), CENTRE).hypothesis
    steps.clear()
    valleys.clear()
    fit(waved, hypothesis, np.array([1.0]))  # type: ignore[arg-type]
    assert valleys
    assert len({id(valley.columns) for valley in valleys}) == len(valleys) < len(steps)


def test_no_curve_is_followed_for_a_gain_that_ends_a_fit_anyway(monkeypatch: pytest.MonkeyPatch) -> None:
    """At the bottom of a small hollow beside that of the bowl: 0.07 is left to gain, and 0.2 is what ends a fit."""
    monkeypatch.setattr(Valley, "followed", lambda *_: pytest.fail("0.07 was promised"))
    assert begun(Waved(0.03, 400.0), CENTRE, 1e-4).converged


def test_a_fit_at_the_bottom_is_left_there_and_no_fit_starts_from_it(monkeypatch: pytest.MonkeyPatch) -> None:
    waved = Waved(0.0, 1.0)
    there = begun(waved, 0.8)
    before = waved.runs
    monkeypatch.setattr(hops, "fit", lambda *_, **__: pytest.fail("nothing was promised"))
    assert settled(waved, there) is there  # type: ignore[arg-type]
    assert waved.runs == before + 1  # the differences of the bowl, once


def test_what_a_straight_bowl_promises_is_what_a_hop_gains() -> None:
    """Along a quadratic misfit from one width s beside its bottom: half of (z/s)^2 = 1/2."""
    waved = Waved(0.0, 1.0)
    there = begun(waved, 0.8)
    width = float(np.sqrt(there.covariance[0, 0]))
    moved = there.z + 3.0 * width
    aside = Fitted(**{**vars(there), "z": moved, "residuals": waved.residuals(there.hypothesis, [moved])[0]})
    _, promised = hops._bowl(waved, aside)  # type: ignore[arg-type]
    assert promised == pytest.approx(0.5 * 3.0**2, rel=0.02)


@pytest.mark.parametrize(("kept", "parts"), [(0.9, [1.0]), (0.2, [1.0, 0.4])])
def test_a_part_of_a_hop_is_tried_where_the_whole_keeps_little_of_its_promise(
    monkeypatch: pytest.MonkeyPatch, kept: float, parts: list[float]
) -> None:
    waved = Waved(0.0, 1.0)
    there = begun(waved, 0.8)
    begun_at: list[float] = []

    def ended(simulator: Waved, hypothesis: Hypothesis, start: FloatArray, **_: object) -> Fitted:
        begun_at.append(float(start[0] - there.z[0]))
        return Fitted(**{**vars(there), "cost": there.cost - kept * 10.0})

    monkeypatch.setattr(hops, "_bowl", lambda *_: (np.array([0.1]), 10.0))
    monkeypatch.setattr(hops, "fit", ended)
    settled(waved, there, 1)  # type: ignore[arg-type]
    np.testing.assert_allclose(begun_at, [0.1 * part for part in parts], rtol=1e-9)


@pytest.mark.parametrize(("loose", "promised", "hopped"), [({}, 1.0, 1), ({"stiffness": 10.0}, 1.0, 0), ({"stiffness": 10.0}, 4.0, 1)])
def test_with_a_cause_in_the_model_a_hop_is_worth_what_log_odds_count(
    monkeypatch: pytest.MonkeyPatch, loose: dict[str, float], promised: float, hopped: int
) -> None:
    waved = Waved(0.0, 1.0)
    there = begun(waved, 0.8)
    model = Fitted(**{**vars(there), "hypothesis": Hypothesis(there.hypothesis.factors, loose=loose)})
    begun_with: list[float | None] = []

    def ended(*_: object, beat: float | None = None, **__: object) -> Fitted:
        begun_with.append(beat)
        return Fitted(**{**vars(model), "cost": model.cost - 0.9 * promised})

    monkeypatch.setattr(hops, "_bowl", lambda *_: (np.array([0.1]), promised))
    monkeypatch.setattr(hops, "fit", ended)
    settled(waved, model, 1)  # type: ignore[arg-type]
    assert min(PARAMETER_ODDS, TIED) > hops.CAUSES
    assert begun_with == [model.cost] * hopped  # given up where it does not come down to where it began
