"""Two effects in one scene, as pairs of causes are tried: of one law at two places, and of two laws at the same place and at others."""

from __future__ import annotations

import pytest

from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidates import Candidate, candidates
from hdrive_mbs.errors import ParameterError, PlaceError, SceneError
from models import drive_bench, rotor_bench

REFUSED = (ParameterError, PlaceError, SceneError)
"""What may not go together, in words: a search leaves it out."""


def recorded(bench: Bench, first: Candidate, second: Candidate) -> bool:
    """Whether the equations with both can be recorded; False where they are refused."""
    scene = bench.scene.with_effect(first.starts[0].effect, at=first.at, name="first")
    try:
        network = scene.with_effect(second.starts[0].effect, at=second.at, name="second").network()
    except REFUSED:
        return False
    line = CompiledLine(network, [network.channels[0].name])
    return len(line.structure.rates) == 2 * len(network.bodies) + len(network.states)


@pytest.mark.parametrize("bench", [drive_bench.bench(), rotor_bench.bench()], ids=["drive", "rotor"])
def test_equations_with_two_effects_can_be_recorded(bench: Bench) -> None:
    found = candidates(bench.scene)
    assert found
    places: dict[str, list[Candidate]] = {}
    for item in found:
        places.setdefault(item.kind.__name__, []).append(item)
    twice = [(some[0], other) for some in places.values() for other in some[1:]]
    beside = list(zip(found, [*found[7:], *found[:7]], strict=True))[::3]  # another law, here or there
    came = {name: [recorded(bench, *pair) for pair in pairs] for name, pairs in (("twice", twice), ("beside", beside))}
    assert sum(came["twice"]) > 0.8 * len(twice)
    assert sum(came["beside"]) > 0.8 * len(beside)
