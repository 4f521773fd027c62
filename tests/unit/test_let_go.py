"""What compiled runs keep for later ones, let go."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.compiled import constant_mass, linear_forces, machine, springs, structure, time_inputs
from hdrive_mbs.compiled.let_go import let_go
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.time_inputs import time_input
from hdrive_mbs.expression import record, variable
from tests.unit.diagnosis_job import KINDS, run


def line() -> CompiledLine:
    torque = hm.TorqueHistory(times=(0.0, 0.5, 1.0), torques=(0.0, 2.0, 0.0))
    scene = hm.Scene(
        name="line",
        parts={
            "motor": hm.Motor(inertia=1e-3, viscous=1e-3, characteristic=torque),
            "shaft": hm.Shaft(stiffness=500.0, damping=0.1),
            "load": hm.Load(inertia=0.02, viscous=0.01, torque=hm.ConstantTorque(value=0.0)),
        },
        connections=[("motor", "shaft", "load")],
    )
    return CompiledLine(scene.network(), ["load.speed"])


def test_runs_after_it_are_the_same_and_nothing_is_kept_in_between() -> None:
    before = line().run(100, 1e-3, step=1e-3)
    assert machine.machine.cache_info().currsize
    assert structure.shaped.cache_info().currsize
    assert time_inputs._kept
    let_go()
    kept = (machine.machine, structure.shaped, constant_mass._factor, constant_mass._column, linear_forces._shares, springs._springs)
    assert [item.cache_info().currsize for item in kept] == [0] * len(kept)
    assert not time_inputs._kept
    after = line().run(100, 1e-3, step=1e-3)
    np.testing.assert_array_equal(after.values["load.speed"], before.values["load.speed"])


def test_a_line_in_use_keeps_its_code() -> None:
    made = line()
    before = made.run(50, 1e-3, step=1e-3)
    let_go()
    np.testing.assert_array_equal(made.run(50, 1e-3, step=1e-3).values["load.speed"], before.values["load.speed"])


@pytest.mark.parametrize("workers", [1, 2])
def test_a_diagnosis_that_leaves_its_runs_to_processes_keeps_nothing_for_later(tmp_path: Path, workers: int) -> None:
    run(tmp_path, workers, kinds=KINDS[:1])
    assert bool(machine.machine.cache_info().currsize) is (workers == 1)
    assert bool(time_inputs._kept) is (workers == 1)


def test_columns_that_were_asked_for_longest_ago_are_let_go_first(monkeypatch: pytest.MonkeyPatch) -> None:
    grid = time_inputs.Grid(start=0.0, every=1e-3, inner=1, first=0, samples=100)
    size = len(grid.times()) * 8
    monkeypatch.setattr(time_inputs, "KEPT_BYTES", 3 * size)
    t = variable("t")
    first, second, third = (time_input(record(factor * t)) for factor in (2.0, 3.0, 4.0))
    let_go()
    kept, gone = first.column(grid), second.column(grid)  # and the time itself
    assert first.column(grid) is kept
    third.column(grid)
    assert sum(column.nbytes for column in time_inputs._kept.values()) <= 3 * size
    assert first.column(grid) is kept
    again = second.column(grid)
    assert again is not gone
    np.testing.assert_array_equal(again, 3.0 * grid.times())
