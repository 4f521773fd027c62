"""What is kept from one line to the next changes nothing: a line built anew has the same numbers to the last bit."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs import topology
from hdrive_mbs.compiled import constant_mass, groups, linear_forces, structure
from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.time_inputs import TimeInput, time_input
from hdrive_mbs.components import shaft_section
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.expression import record, variable
from hdrive_mbs.network import claims
from models import drive_bench, rotor_bench

KEPT: tuple[Any, ...] = (
    topology._joints, topology._check, topology._layout, shaft_section._kept_ends, shaft_section._kept_matrices, claims._values,
    groups._groups, linear_forces._shares, constant_mass._factor, constant_mass._column, structure.shaped,
)  # fmt: skip

BENCHES: dict[str, tuple[Callable[[], Bench], Callable[[], hm.Scene], list[str], int]] = {
    "rotor": (rotor_bench.bench, lambda: rotor_bench.build("bump"), ["rotor_1.x", "bearing_2.housing.y_acceleration"], 10),
    "drive": (drive_bench.bench, drive_bench.build, ["load.angle", "output_shaft.torque"], 3),
}
"""Bench, scene, channels, and of how many effects at places one is taken: a rotor line takes ten times as long."""


def changed(bench: Bench, scene: hm.Scene, factor: float) -> hm.Scene:
    """The scene with every uncertain parameter multiplied."""
    pairs = [(path, value) for name, item in bench.knowledge.items() for path, value in zip(item.paths, bench.nominal(name), strict=True)]
    return scene.replacing({path: factor * value for path, value in pairs})


def variants(name: str) -> Iterator[Callable[[], hm.Scene]]:
    """Each effect at each place, in the nominal bench, and in one whose parameters are all others."""
    make, build, _, nth = BENCHES[name]
    bench, scene = make(), build()
    other = changed(bench, scene, 1.01)
    for item in [start for candidate in candidates(scene) for start in candidate.first[:1]][::nth]:
        for base in (scene, other):
            yield lambda base=base, item=item: base.with_effect(item.effect, at=item.at)  # type: ignore[misc]


def numbers(scene: hm.Scene, channels: list[str]) -> tuple[object, ...]:
    """Everything that a run takes from a line."""
    program = CompiledLine(without_idle(scene.network()), channels).program
    tables = [(table.pieces, table.values.tobytes()) for table in program.tables]
    return program.structure, program.constants.tobytes(), tables, program.inputs


@pytest.mark.slow
@pytest.mark.parametrize("name", BENCHES)
def test_lines_from_what_is_kept_are_those_built_anew_to_the_last_bit(name: str) -> None:
    channels = BENCHES[name][2]
    made = [numbers(make(), channels) for make in variants(name)]
    again = list(variants(name))
    assert len(made) == len(again) > 30
    for first, make in zip(made, again, strict=True):
        for cache in KEPT:
            cache.cache_clear()
        assert numbers(make(), channels) == first
    assert len({(first[0], first[1]) for first in made}) > len(made) // 2  # other numbers, other lines


def test_what_is_kept_cannot_be_changed() -> None:
    scene = rotor_bench.build("bump")
    section = scene.parts["section_1"]
    assert isinstance(section, hm.ShaftSection)
    for matrix in shaft_section._matrices(section.beam(), section.rotary_inertia):
        with pytest.raises(ValueError, match="read-only"):
            matrix[0, 0] = 1.0


def test_equal_tables_of_time_are_held_once_and_let_go_with_the_last_line_that_has_them() -> None:
    def made(factor: float) -> TimeInput:
        t = variable("t")
        return time_input(record(factor * np.interp(t, [0.0, 1.0, 2.0], [0.0, 3.0, 1.0])))

    first, second, other = made(2.0), made(2.0), made(3.0)
    assert first is second
    assert other is not first
    kept = weakref.ref(first)
    del first, second
    gc.collect()
    assert kept() is None
