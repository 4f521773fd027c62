"""Processes of a diagnosis begin before its records are checked, and end with it however the checks come out."""

from __future__ import annotations

import dataclasses
import multiprocessing
import sys

import pytest

from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.errors import RecordError
from tests.unit.diagnosis_cases import bench, records


def _is_read(module: str, item: int) -> bool:
    return module in sys.modules


def test_processes_that_stand_by_take_the_first_work() -> None:
    with Team(2) as team:
        team.stand_by()
        standing = [worker.process.pid for worker in team._running]
        assert len(standing) == 2
        assert team.map(max, 3, [1, 5, 2]) == [3, 5, 3]
        assert [worker.process.pid for worker in team._running] == standing
    assert multiprocessing.active_children() == []


def test_a_process_that_stands_by_has_read_what_it_was_told_to() -> None:
    with Team(2) as team:
        team.stand_by("wave")
        assert team.map(_is_read, "wave", [1, 2]) == [True, True]
        assert team.map(_is_read, "tabnanny", [1, 2]) == [False, False]  # else the first line shows nothing


def test_one_process_has_nobody_to_stand_by() -> None:
    with Team(1) as team:
        team.stand_by()
        assert not team.is_at_hand


def test_records_that_are_refused_leave_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    begun: list[int] = []
    stand_by = Team.stand_by

    def noted(team: Team, *needed: str) -> None:
        stand_by(team, *needed)
        begun.append(len(team._running))

    monkeypatch.setattr(Team, "stand_by", noted)
    [record, *_] = records()
    wrong = dataclasses.replace(record, channels={name: item for name, item in record.channels.items() if name != "speed_reference"})
    with pytest.raises(RecordError, match="speed_reference"):
        diagnose(bench(), wrong, workers=2)
    assert begun == [2]
    assert multiprocessing.active_children() == []
