"""The last fits side by side: the refitted nominal model is begun beside all others and asked for at their end."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.all_samples import on_all_samples
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.located import Located
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.team import Team
from tests.unit.diagnosis_cases import bench, records


def test_two_processes_end_where_one_does() -> None:
    known = bench()
    simulator = Simulator(known.trials(records((hm.CoulombStribeckFriction(coulomb=8.0), "load"))[0]), 2.5e-4, 4)
    nominal = Hypothesis(factors_of(known))
    null = fit(simulator, nominal, np.zeros(nominal.size), steps=1)
    found = []
    for at in ("load", "motor"):
        hypothesis = Hypothesis(factors_of(known), (Added(hm.CoulombStribeckFriction(coulomb=1.0), at, "cause"),))
        found.append(fit(simulator, hypothesis, hypothesis.start(), steps=1))
    ends = []
    for workers in (1, 2):
        said: list[tuple[int, int]] = []
        with Team(workers) as team:
            place = Located(places=(), doubt="", forces=(), turned=())
            last = on_all_samples(team, simulator, null, found, place, lambda done, total, said=said: said.append((done, total)))
            assert team.lost == []
        assert said[-1] == (4, 4)
        assert [done for done, _ in said] == sorted(done for done, _ in said)
        assert last.refitted.hypothesis.is_nominal
        assert last.refitted.steps > 1
        others = [item for item in last.others if item is not None]
        assert len(others) == 2
        ends.append([last.nominal.cost, last.refitted.cost, *(item.cost for item in others)])
    assert ends[0] == pytest.approx(ends[1], rel=1e-9)
    assert ends[0][0] > ends[0][1] > ends[0][2]
