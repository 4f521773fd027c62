"""A search that is given a time looks for no more after it, and says what it left out."""

from __future__ import annotations

import math

import pytest

from hdrive_mbs.diagnosis import deadline
from hdrive_mbs.diagnosis.deadline import Deadline
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.effects.coulomb_stribeck_friction import CoulombStribeckFriction
from hdrive_mbs.effects.kinematic_error import KinematicError
from hdrive_mbs.errors import ParameterError
from tests.unit.diagnosis_cases import bench, quiet, records

KINDS = (CoulombStribeckFriction, KinematicError)


def test_it_passes_after_its_seconds_and_keeps_each_thing_left_out_once(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr(deadline.time, "monotonic", lambda: now[0])
    short, never = Deadline(30.0), Deadline()
    now[0] = 129.0
    assert not short.passed("a second cause")
    assert short.said() == ()
    now[0] = 131.0
    assert short.passed("a second cause")
    assert short.passed("other laws")
    assert short.passed("a second cause")
    assert short.left_out == ["a second cause", "other laws"]
    [said] = short.said()
    assert "after 30 s, as asked" in said
    assert "a second cause, other laws." in said
    now[0] = 1e9
    assert not never.passed("a second cause")
    assert never.said() == ()


@pytest.mark.parametrize("seconds", [0.0, -1.0, math.nan])
def test_no_time_at_all_is_refused(seconds: float) -> None:
    with pytest.raises(ParameterError, match=r"search_seconds = .* s: must be above 0"):
        diagnose(bench(), quiet(), search_seconds=seconds)


def two() -> tuple[tuple[CoulombStribeckFriction, str], tuple[KinematicError, str]]:
    return (CoulombStribeckFriction(coulomb=0.05, smoothing_speed=0.3), "motor"), (KinematicError(amplitude=1e-4, phase=0.8), "gear")


def short_of(found: Diagnosis) -> list[str]:
    return [text for text in found.warnings if "The search stopped after" in text]


@pytest.mark.slow
def test_the_second_of_two_causes_is_left_out_and_the_answer_says_so() -> None:
    given = records(*two())
    short, long = (diagnose(bench(), given, candidates=KINDS, pictures=False, search_seconds=limit) for limit in (1e-6, 600.0))
    assert {cause.effect for cause in long.causes} == {"friction", "kinematic_error"}
    assert short_of(long) == []
    assert len(short.causes) < 2
    [said] = short_of(short)
    assert "a second cause" in said
    assert short.gap.effect.value > 1.05  # what is left is told, not hidden


@pytest.mark.slow
def test_what_needs_no_further_search_is_as_good_as_without_a_limit() -> None:
    given = records(two()[1])
    short, long = (diagnose(bench(), given, candidates=KINDS, pictures=False, search_seconds=limit) for limit in (1e-6, None))
    assert short_of(short) == []
    # by their digits: a nominal value of nan equals no other one where fields are compared one by one, as from Python 3.13 on
    assert [(c.effect, c.at, repr(c.parameters)) for c in short.causes] == [(c.effect, c.at, repr(c.parameters)) for c in long.causes]
    assert short.gap == long.gap
