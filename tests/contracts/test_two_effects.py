"""Two effects in one scene, as pairs of causes are tried: of one law at two places, and of two laws at the same place and at others."""

from __future__ import annotations

import pytest

from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidates import Candidate, candidates
from models import drive_bench, rotor_bench


def check_recorded(bench: Bench, first: Candidate, second: Candidate) -> None:
    """The equations with both can be recorded, with rates of all that moves and of all states."""
    scene = bench.scene.with_effect(first.starts[0].effect, at=first.at, name="first")
    network = scene.with_effect(second.starts[0].effect, at=second.at, name="second").network()
    line = CompiledLine(network, [network.channels[0].name])
    assert len(line.structure.rates) == 2 * len(network.bodies) + len(network.states), (first.label, second.label)


@pytest.mark.parametrize("bench", [drive_bench.bench(), rotor_bench.bench()], ids=["drive", "rotor"])
def test_equations_with_two_effects_can_be_recorded(bench: Bench) -> None:
    found = candidates(bench.scene)
    assert found
    places: dict[str, list[Candidate]] = {}
    for item in found:
        places.setdefault(item.kind.__name__, []).append(item)
    twice = [(some[0], other) for some in places.values() for other in some[1:]]
    beside = list(zip(found, [*found[7:], *found[:7]], strict=True))[::3]  # another law, here or there
    assert len(twice) > 80
    for first, second in (*twice, *beside):
        check_recorded(bench, first, second)
