"""Lines of parameter sets of each law that a search tries on the drive bench: built one by one, and from a template."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from benchmarks.machine import machine as about
from hdrive_mbs.compiled.line import CompiledLine, run_many
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.diagnose import factors_of
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.templates import Templates
from hdrive_mbs.network.network import Network
from models import drive_bench

CHANNELS = ("motor_encoder", "load_encoder", "torque_sensor")
SETS = 16
"""Parameter sets of a batch: about a Jacobian."""
SAMPLES, EVERY, STEP = 18_001, 5e-4, 2.5e-4
"""Of a run: a record of the bench, 9 s at 2 kHz, in the steps that a diagnosis of it takes."""


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Rows: law, place, made_s (the template), built_s and template_s (each of a batch, least of the repeats), run_s (each set of a run
    side by side), apart (constants, largest relative difference), kept (sets for which the template holds, of SETS)."""
    bench = drive_bench.bench()
    factors = factors_of(bench)
    tried = candidates(bench.scene)[:: 8 if quick else 1]
    rows = []
    for candidate in tried:
        hypothesis = Hypothesis(factors, candidate.starts[:1])
        rng = np.random.default_rng(7)
        start = hypothesis.start()
        points = [hypothesis.clipped(start + 0.5 * rng.standard_normal(len(start))) for _ in range(SETS)]
        rows.append({"law": candidate.kind.__name__, "place": candidate.at, **_measured(hypothesis, bench.scene, points, repeats)})
    return {"about": about(), "repeats": repeats, "sets": SETS, "rows": rows}


def _compiled(network: Network) -> CompiledLine:
    return CompiledLine(network, CHANNELS)


def _measured(hypothesis: Hypothesis, scene: Any, points: list[np.ndarray], repeats: int) -> dict[str, Any]:
    begun = time.process_time()
    template = Templates().of(hypothesis, scene, points[0], "bench", _compiled)
    made = time.process_time() - begun
    building, taking = [], []
    for _ in range(repeats):
        begun = time.process_time()
        built = [_compiled(hypothesis.scene(scene, z, to_run=True).network()) for z in points]
        building.append(time.process_time() - begun)
        begun = time.process_time()
        taken = [] if template is None else template.lines([hypothesis.values(z, to_run=True) for z in points])
        taking.append(time.process_time() - begun)
    run_many(built[:1], 3, EVERY, step=STEP)  # its machine code
    begun = time.process_time()
    run_many(built, SAMPLES, EVERY, step=STEP)
    running = time.process_time() - begun
    pairs = [(line.program.constants, own.program.constants) for line, own in zip(taken, built, strict=False) if line is not None]
    apart = max((float(np.max(np.abs(a - b) / np.maximum(np.abs(b), 1e-300))) for a, b in pairs), default=float("nan"))
    each = {"built_s": min(building) / SETS, "template_s": min(taking) / SETS, "run_s": running / SETS}
    return {"made_s": made, **each, "apart": apart, "kept": len(pairs), "has": template is not None}
