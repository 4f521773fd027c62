"""The ways of the benchmark of records that begin in rotation, without its diagnoses.  No time is judged here."""

from __future__ import annotations

import math

import pytest

from benchmarks.in_rotation.case import AT, FIRST, FOLD, LAST, PLANTED, PROBES, STEP, fan, log
from benchmarks.in_rotation.report import report
from benchmarks.in_rotation.ways import ways


@pytest.mark.slow
def test_the_elimination_leaves_what_the_fitted_state_leaves_and_run_ins_alone_more() -> None:
    true = fan().with_effect(PLANTED, at=AT)
    rows = ways(true, log(true), 1)
    rms = {row["way"]: row["rms"] for row in rows}
    samples = len(PROBES) * (LAST - FIRST) / (STEP * FOLD)
    assert rms["free vibration eliminated"] == pytest.approx(1.0, abs=3.0 / math.sqrt(2.0 * samples))
    # of the peer, which knows nothing of roots and projections; the encoder's steps are in both
    assert rms["state at the begin fitted"] == pytest.approx(1.0, abs=3.0 / math.sqrt(2.0 * samples))
    alone = [row["rms"] for row in rows if row["way"].startswith("run-in")]
    assert alone == sorted(alone, reverse=True)
    assert alone[-1] > 2.0
    numbers = {"ways": rows, "planted": {}, "laws": 0, "diagnoses": [], "about": {"processor": "some"}}
    assert all(row["way"] in report(numbers) for row in rows)
