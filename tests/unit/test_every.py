"""How many of the samples the search compares can be asked for: records that are thinned already have none to spare."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.digest import digest
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import EVERY, Prepared, prepare
from hdrive_mbs.effects.viscous_drag import ViscousDrag
from tests.unit.diagnosis_cases import bench, quiet

STEP = 1e-3


def samples_of_the_search(given: Prepared) -> int:
    hypothesis = Hypothesis(given.factors)
    [found] = given.coarse.residuals(hypothesis, [np.zeros(hypothesis.size)])
    assert found is not None
    return int(found.size)


def test_the_search_compares_as_many_samples_as_asked_for() -> None:
    usual, all_of_them, few = (prepare(bench(), quiet(), (), STEP, every=every) for every in (EVERY, 1, 16))
    counted = [samples_of_the_search(given) for given in (usual, all_of_them, few)]
    assert counted[1] == pytest.approx(EVERY * counted[0], rel=0.02)
    assert counted[1] == pytest.approx(16 * counted[2], rel=0.05)
    assert [given.settings["every"] for given in (usual, all_of_them, few)] == [EVERY, 1, 16]
    assert prepare(bench(), quiet(), (), STEP).settings["every"] == EVERY
    kept = [digest(given.inputs["trials"]) for given in (usual, prepare(bench(), quiet(), (), STEP), all_of_them)]
    assert kept[0] == kept[1]
    assert kept[0] != kept[2]  # so that what is kept in a folder belongs to one of them


def test_a_diagnosis_says_how_many_it_compared() -> None:
    found = diagnose(bench(), quiet(), candidates=(ViscousDrag,), pictures=False, step=STEP, every=np.int64(2))
    assert repr(found.settings["every"]) == "2"  # a plain number, which JSON takes
    assert found.verdict == "none"


@pytest.mark.parametrize("every", [0, -4, 1.5, True, "4"])
def test_what_is_no_number_of_samples_is_refused(every: Any) -> None:
    with pytest.raises(hm.ParameterError, match=r"every = .* must be a whole number of samples, at least 1"):
        diagnose(bench(), quiet(), every=every)


def test_a_search_that_would_see_next_to_nothing_is_refused() -> None:
    shortest = min(len(record.times) for record in quiet())
    assert samples_of_the_search(prepare(bench(), quiet(), (), STEP, every=shortest // 32)) > 0
    with pytest.raises(
        hm.ParameterError, match=rf"every = {shortest // 8} leaves a search \d+ values of '.+' in record '.+'; needed are 16"
    ):
        diagnose(bench(), quiet(), every=shortest // 8)
