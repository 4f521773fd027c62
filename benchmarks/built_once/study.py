"""Lines of parameter sets of each law that a search tries on the two benches: built one by one, and from a template."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.machine import machine as about
from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine, run_many
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.templates import PAYS, Templates
from hdrive_mbs.network.network import Network
from models import drive_bench, rotor_bench

SETS = 16
"""Parameter sets of a batch: about a Jacobian."""


@dataclass(frozen=True)
class _Bench:
    """A bench with what a run of it takes.

    bench : with scene, tolerances and channels;  every, step : sample time and step [s]
    large : whether its templates are of rotor lines
    """

    bench: Any
    samples: int
    every: float
    step: float
    large: bool

    def line(self, network: Network) -> CompiledLine:
        """The network with the channels that are measured."""
        return CompiledLine(without_idle(network) if network.is_lateral else network, self.channels)

    @property
    def channels(self) -> Sequence[str]:
        """Those that are measured, each once."""
        return tuple(dict.fromkeys(item.channel for item in self.bench.measured.values()))


BENCHES: Mapping[str, Callable[[], _Bench]] = {
    "drive": lambda: _Bench(drive_bench.bench(), 18_001, 5e-4, 2.5e-4, large=False),
    "rotor": lambda: _Bench(rotor_bench.bench(), 16_801, rotor_bench.SAMPLE_TIME, rotor_bench.STEP, large=True),
}
"""Runs as long as a record, in the steps that a diagnosis of it takes."""


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Rows: bench, law, place, made_s (the template), built_s and template_s (each of a batch, least of the repeats), run_s (each set of
    a run side by side), apart (constants, largest relative difference), kept (sets for which the template holds, of SETS)."""
    rows = []
    for name, made in BENCHES.items():
        on = made()
        factors = factors_of(on.bench)
        for candidate in candidates(on.bench.scene)[:: 8 if quick else 1]:
            hypothesis = Hypothesis(factors, candidate.starts[:1])
            points = _points(hypothesis)
            measured = _measured(on, hypothesis, points, repeats)
            rows.append({"bench": name, "law": candidate.kind.__name__, "place": candidate.at, **measured})
    return {"about": about(), "repeats": repeats, "sets": SETS, "pays": PAYS, "rows": rows}


def _points(hypothesis: Hypothesis) -> list[np.ndarray]:
    """About the start, with all coordinates moved."""
    rng = np.random.default_rng(7)
    start = hypothesis.start()
    return [hypothesis.clipped(start + 0.5 * rng.standard_normal(len(start))) for _ in range(SETS)]


def _measured(on: _Bench, hypothesis: Hypothesis, points: list[np.ndarray], repeats: int) -> dict[str, Any]:
    scene = on.bench.scene
    begun = time.process_time()
    template = Templates(large=on.large).of(hypothesis, scene, points[0], "bench", on.line, asked=SETS)
    made = time.process_time() - begun
    building, taking = [], []
    for _ in range(repeats):
        begun = time.process_time()
        built = [on.line(hypothesis.scene(scene, z, to_run=True).network()) for z in points]
        building.append(time.process_time() - begun)
        begun = time.process_time()
        taken = [] if template is None else template.lines([hypothesis.values(z, to_run=True) for z in points])
        taking.append(time.process_time() - begun)
    run_many(built[:1], 3, on.every, step=on.step)  # its machine code
    begun = time.process_time()
    run_many(built, on.samples, on.every, step=on.step)
    running = time.process_time() - begun
    pairs = [(line.program, own.program) for line, own in zip(taken, built, strict=False) if line is not None]
    same = [(a.constants, b.constants) for a, b in pairs if a.structure == b.structure]
    apart = max((float(np.max(np.abs(a - b) / np.maximum(np.abs(b), 1e-300), initial=0.0)) for a, b in same), default=float("nan"))
    each = {"built_s": min(building) / SETS, "template_s": min(taking) / SETS, "run_s": running / SETS}
    return {"made_s": made, **each, "apart": apart, "kept": len(pairs), "has": template is not None}
