"""Parameters tried all along their range, on a misfit that is known in closed form: flat, with a narrow dip."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import pytest

from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.robust import Blocks
from hdrive_mbs.diagnosis.scans import FITTED, POINTS, WIDE, fits_from, scan, worth_a_scan
from hdrive_mbs.diagnosis.search import search
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect, suspects
from hdrive_mbs.diagnosis.tasks import NEAR, Task, run_task
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.unknowns import Factor
from tests.unit.diagnosis_cases import bench as bench_of_a_drive
from tests.unit.diagnosis_cases import quiet

FloatArray = npt.NDArray[np.float64]

SAMPLES = 2000
CENTRE, WIDTH, DEEP = 1.13, 0.15, 30.0
"""Of the dip over the second of two masses, in its suspected deviations, and what is left outside, in standard deviations of noise."""
GROUPS = {"first": ("mass_1",), "second": ("mass_2", "inertia_2")}


class Flat:
    """Residuals DEEP (1 - exp(-(z - c)^2/w^2)/2) in each sample, and noise; z of the second mass in its suspected deviations."""

    def __init__(self) -> None:
        self.fit = np.arange(SAMPLES) % 4 != 0
        self.held_out = ~self.fit
        number = int(self.fit.sum())
        self.blocks = Blocks(np.zeros(number, int))
        self.held_blocks = Blocks(np.zeros(SAMPLES - number, int))
        self.spans = (slice(0, number),)
        self.unseen: dict[str, frozenset[int]] = {}
        self.noise = np.random.default_rng(8).normal(size=SAMPLES)
        self.impossible = False

    def residuals(self, hypothesis: Hypothesis, points: Sequence[FloatArray], *left_out: object) -> list[FloatArray | None]:
        if self.impossible:
            return [None for _ in points]
        at = [float(z[1]) * hypothesis.loose.get("mass_2", 1.0) / 10.0 for z in points]
        return [
            self.noise + DEEP * (1.0 - np.exp(-(((z - CENTRE) / WIDTH) ** 2))) + 0.01 * float(p[0]) for z, p in zip(at, points, strict=True)
        ]


def asked() -> list[Suspect]:
    names = ("mass_1", "mass_2", "inertia_2")
    factors = tuple(Factor(path=f"{name}.value", name=name, nominal={f"{name}.value": 1.0}, sigma=0.006) for name in names)
    return suspects(Hypothesis(factors), GROUPS, [])


def test_a_dip_that_no_step_leads_to_is_found_and_fitted() -> None:
    flat = Flat()
    assert 2.0 * WIDE / POINTS < WIDTH
    some = worth_a_scan(asked())
    looks = [scan(flat, suspect) for suspect in some]  # type: ignore[arg-type]
    found = fits_from(list(zip(some, looks, strict=True)))
    assert [suspect.label for suspect, _ in found] == [("parameter", "second"), ("parameter", "first")]
    fitted = run_task(flat, found[0][1])  # type: ignore[arg-type]
    assert fitted is not None
    assert fitted.z[1] == pytest.approx(CENTRE, abs=0.02)
    assert fitted.chi_fit < 1.1
    assert fitted.z[0] == pytest.approx(0.0, abs=1.0)
    sheet = some[1].first[0]
    stuck = run_task(flat, type(found[0][1])(sheet, sheet.start(), None, 20, 1e-4))  # type: ignore[arg-type]
    assert stuck is not None
    assert stuck.chi_fit > NEAR


def test_only_suspected_parameters_move_one_at_a_time() -> None:
    flat, [first, _] = Flat(), asked()
    look = scan(flat, first)  # type: ignore[arg-type]
    assert look is not None
    assert np.count_nonzero(look.z) == 1
    assert look.z[0] != 0.0


def test_what_cannot_be_run_is_left_out_and_no_more_than_the_best_are_fitted() -> None:
    flat = Flat()
    some = worth_a_scan(asked())
    look = scan(flat, some[0])  # type: ignore[arg-type]
    flat.impossible = True
    assert scan(flat, some[0]) is None  # type: ignore[arg-type]
    assert len(fits_from([(some[0], look), (some[1], None)])) == 1
    assert len(fits_from([(some[0], look)] * 5)) == FITTED


@pytest.mark.parametrize(
    ("before", "after", "scans"), [(1.5, 2.0, False), (2.0 * NEAR, 2.0, True), (2.0 * NEAR, 1.05, True), (2.0 * NEAR, 1.0, False)]
)
def test_a_search_scans_parameters_where_the_nominal_model_is_far_off_and_looks_explain_it_not(
    monkeypatch: pytest.MonkeyPatch, before: float, after: float, scans: bool
) -> None:
    """Said by what it reports; the mean squares that are left without a suspect and with one are given."""
    bench = bench_of_a_drive()
    simulator = Simulator(bench.trials(quiet()[0]), 2.5e-4, 8)
    hypothesis = Hypothesis(factors_of(bench))
    base = dataclasses.replace(fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=1), chi_fit=before)
    said: list[str] = []
    groups = {item.name: (item.name,) for item in hypothesis.factors[:2]}

    def leaving(simulator: Simulator, task: Task) -> Fitted | None:
        fitted = run_task(simulator, task)
        return None if fitted is None else dataclasses.replace(fitted, chi_fit=after, typical=after)

    monkeypatch.setattr("hdrive_mbs.diagnosis.search.run_task", leaving)
    with Team(1) as team:
        search(team, simulator, base, groups, [], report=lambda stage, done, total: said.append(stage))
    assert ("trying parameters along their range" in said) == scans
    assert "looking at candidates" in said
