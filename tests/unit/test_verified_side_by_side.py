"""The answer and what comes next are run on the engine in the processes of the search, as far as these are there still."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from hdrive_mbs.diagnosis import diagnose as diagnosing
from hdrive_mbs.diagnosis import verify
from hdrive_mbs.diagnosis.diagnose import _on_the_engine
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Suspect
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team
from tests.unit.diagnosis_cases import bench, quiet


@pytest.mark.parametrize("at_hand", [True, False])
def test_both_fits_are_verified_alike_in_processes_and_here(at_hand: bool) -> None:
    simulator = Simulator(bench().trials(quiet()[0]), 2.5e-4)
    hypothesis = Hypothesis(factors_of(bench()))
    best, other = (fit(simulator, hypothesis, np.full(hypothesis.size, z), steps=0) for z in (0.0, 0.5))
    suspect = Suspect(("parameter", "some"), "parameter", (hypothesis,), (hypothesis,))
    evidence = SimpleNamespace(fine=simulator, singles=(Found(suspect, other, 3.0),), pairs=())
    said: list[tuple[str, int, int]] = []
    with Team(2) as team:
        assert not team.is_at_hand
        if at_hand:
            team.map(max, 1, [2, 3])
        found = _on_the_engine(team, evidence, best, lambda *words: said.append(words))  # type: ignore[arg-type]
        assert team.is_at_hand is at_hand
    assert found == [verify.verified(simulator, item) for item in (best, other)]
    assert len(found) == 2
    assert not any(item.differs for item in found)
    assert all("agree" in item.text for item in found)
    assert {words for words, _, _ in said} == {"verifying on the engine"}
    assert said[0][1:] == (0, 2)


def test_a_fit_that_differs_is_a_warning_and_one_that_cannot_be_run_a_note(monkeypatch: pytest.MonkeyPatch) -> None:
    simulator = Simulator(bench().trials(quiet()[0]), 2.5e-4)
    hypothesis = Hypothesis(factors_of(bench()))
    fitted = fit(simulator, hypothesis, np.zeros(hypothesis.size), steps=0)
    monkeypatch.setattr(verify, "engine_difference", lambda *some: 0.31)
    differing = verify.verified(simulator, fitted)
    assert differing.differs
    assert "DIFFER" in differing.text
    assert "0.31" in differing.text

    def raising(*some: object) -> float:
        raise diagnosing.ParameterError("no such body")

    monkeypatch.setattr(verify, "engine_difference", raising)
    assert verify.verified(simulator, dataclasses.replace(fitted)).text.endswith("no such body")
    assert not verify.verified(simulator, fitted).differs
