"""A drag at both ends of a stiff shaft, fitted from where a search begins with differences of many lengths."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from benchmarks.machine import machine as about
from benchmarks.withheld.make import make_set
from benchmarks.withheld.methods import bench_of, records_of
from hdrive_mbs.diagnosis import differences
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.differences import jacobian
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.ground import screen_from
from hdrive_mbs.diagnosis.prepared import EVERY, factors_of
from hdrive_mbs.diagnosis.screening import Look
from hdrive_mbs.diagnosis.search import fit_nominal
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.diagnosis.suspects import suspects
from hdrive_mbs.diagnosis.tasks import CONVERGED, FINE
from hdrive_mbs.effects.power_drag import PowerDrag

SEED, CASES, CASE = 7948545673254252689, 24, "drive-c08"
"""Our own fifteenth drive set (withheld/own/drive_15/made.json) and its case of a drag of the wave generator."""
LENGTHS = (math.inf, 5.0, 1.0, 0.3, 0.1, 0.03)
"""Changes of the residuals that a difference makes; infinite: every difference is as long as its coordinate's step."""


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Rows: place, change, cost, mean_square (of the fitted samples), converged, steps, runs, seconds (CPU, least of the repeats).

    ``bears`` : by place, what its columns bear
    """
    rows: list[dict[str, Any]] = []
    bears: dict[str, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        for place, simulator, look in _looks(Path(folder) / "cases", quick):
            fits = [_fitted(simulator, look, change, repeats) for change in ((math.inf, 0.3) if quick else LENGTHS)]
            rows += [{"place": place, **row} for _, row in fits]
            bears[place] = _bearing(simulator, min((fitted for fitted, _ in fits), key=lambda item: item.cost))
    return {"about": about(), "seed": SEED, "repeats": repeats, "rows": rows, "bears": bears}


def _looks(folder: Path, quick: bool) -> Iterator[tuple[str, Simulator, Look]]:
    """The look of a search at the drag at each of its places on the shaft."""
    if quick:
        make_set("drive", 1, 1, folder, names=("quadratic_drag",))
    else:
        make_set("drive", CASES, SEED, folder)
    known = bench_of("drive")
    trials = [trial for record in records_of(folder / ("drive-c01" if quick else CASE)) for trial in known.trials(record)]
    simulator = Simulator(trials, suitable_step(trials, factors_of(known)), EVERY)
    null = fit_nominal(simulator, factors_of(known))
    screen = screen_from(simulator, null)
    for suspect in suspects(null.hypothesis, {}, candidates(trials[0].scene, PowerDrag)):
        look = screen.look(suspect.all) if suspect.label[1] in ("motor", "wave_generator") else None
        if look is not None:
            yield suspect.label[1], simulator, look


def _fitted(simulator: Simulator, look: Look, change: float, repeats: int) -> tuple[Fitted, dict[str, Any]]:
    """A fit to the end with differences that change the residuals by so much."""
    first = differences.FIRST if math.isfinite(change) else 1.0
    seconds = []
    with patch.object(differences, "SHORT", change), patch.object(differences, "FIRST", first):
        for _ in range(repeats):
            simulator.forget()
            before, begun = simulator.runs, time.process_time()
            fitted = fit(simulator, look.hypothesis, look.z, steps=CONVERGED, share=FINE)
            seconds.append(time.process_time() - begun)
    named = change if math.isfinite(change) else None
    cost = {"steps": fitted.steps, "runs": simulator.runs - before, "seconds": min(seconds)}
    return fitted, {"change": named, "cost": fitted.cost, "mean_square": fitted.chi_fit, "converged": fitted.converged, **cost}


def _bearing(simulator: Simulator, fitted: Fitted) -> dict[str, float]:
    """What the records say of a unit of the coordinates at a point: root of the sum of squares of the ``largest`` column, and of the
    direction that shows ``least`` (priors not counted)."""
    mask = simulator.fit
    columns = jacobian(simulator, fitted.hypothesis, fitted.z, fitted.residuals)
    weighted = columns * np.sqrt(simulator.blocks.weights(fitted.residuals[mask]))[:, None]
    return {"largest": float(np.max(np.linalg.norm(weighted, axis=0))), "least": float(np.linalg.svd(weighted, compute_uv=False)[-1])}
