"""Each law keeps its structure from point to point: lines of a search stand side by side, and none is compiled anew."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.candidates import Candidate, candidates
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.effects.shaft_bending import bent_shapes
from hdrive_mbs.network.bearing_draft import ShaftPiece
from hdrive_mbs.shafts.beam import Beam
from models import drive_bench, rotor_bench

BENCHES: dict[str, tuple[Bench, hm.Scene, list[str]]] = {
    "rotor": (rotor_bench.bench(), rotor_bench.build("bump"), ["rotor_1.x", "bearing_2.housing.y_acceleration"]),
    "drive": (drive_bench.bench(), drive_bench.build(), ["load.angle", "output_shaft.torque"]),
}


def one_of_each(scene: hm.Scene) -> list[Candidate]:
    found: dict[str, Candidate] = {}
    for item in candidates(scene):
        found.setdefault(item.kind.__name__, item)
    return list(found.values())


@pytest.mark.slow
@pytest.mark.parametrize("name", BENCHES)
def test_a_law_has_one_structure_at_points_near_each_other(name: str) -> None:
    """With the numbers of a bench and of the law a little off in all digits; none of them passes zero."""
    bench, scene, channels = BENCHES[name]
    rng = np.random.default_rng(7)
    laws = one_of_each(scene)
    assert len(laws) > 30
    for law in laws:
        hypothesis = Hypothesis(factors=factors_of(bench), added=law.starts[:1])
        points = [hypothesis.start() + rng.uniform(0.01, 0.05, hypothesis.size) for _ in range(3)]
        scenes = [hypothesis.scene(scene, hypothesis.clipped(point), to_run=True) for point in points]
        assert len({CompiledLine(without_idle(made.network()), channels).structure for made in scenes}) == 1, law.kind.__name__


@pytest.mark.parametrize("shear", [False, True])
def test_two_shapes_hold_the_whole_bending_stiffness_of_a_piece(shear: bool) -> None:
    beam = Beam.circular(length=0.36, diameter=0.045, youngs_modulus=2.06e11, shear_modulus=7.9e10, density=0.0, shear=shear)
    bending = beam.bending_stiffness()

    class Whole(ShaftPiece):
        def stretch(self, row):  # type: ignore[no-untyped-def]
            return {str(k): float(value) for k, value in enumerate(row)}

    total = np.zeros((12, 12))
    for shape, stiffness in bent_shapes(Whole("piece", (None, None), beam.length, bending)):  # type: ignore[arg-type]
        for key in "xy":
            row = shape.size * np.array(list(shape.stretches[key].values()))
            total += stiffness * np.outer(row, row)
    np.testing.assert_allclose(total, bending, rtol=0.0, atol=1e-13 * np.max(np.abs(bending)))
