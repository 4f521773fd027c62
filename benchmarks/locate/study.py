"""Every case of a set: the places found, beside the true one."""

from __future__ import annotations

import importlib
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.campaign import Where
from benchmarks.locate.judging import judged
from benchmarks.machine import machine
from benchmarks.withheld.truths import read_truths
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.locate import Localiser
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.records.reading import read_record

STEPS = {"drive": 0.25e-3, "rotor": 1.0 / 12000.0}
"""Step of the integration [s]."""
EVERY, ROUNDS = 4, 15
"""Samples of which the refit of the drive bench uses one, and its most steps."""
SHOWN = 4
"""Places that are kept of each case."""


def study(sets: Mapping[str, Sequence[Path]], *, most: int | None = None, where: Where | None = None) -> dict[str, Any]:
    """All cases of all sets of each bench; a case that fails is left out, and counted.

    most : cases of each set
    """
    started = machine()
    truths = {
        (name, str((folder / case).resolve())): truth
        for name, folders in sets.items()
        for folder in folders
        for case, truth in [item for item in read_truths(folder).items() if item[0].startswith(name)][:most]
    }
    points = [{"bench": name, "folder": folder} for name, folder in truths]
    found = (where or Where()).sweep(places_of, points) if points else None
    rows: dict[str, list[dict[str, Any]]] = {name: [] for name in sets}
    for point, values in zip(points, found.values if found else (), strict=True):
        if values:
            name, folder = point["bench"], point["folder"]
            rows[name].append(judged(name, values, Path(folder).name, truths[name, folder]))
    return {"machine": started, "cases": rows, "failed": [dict(item["parameters"]) for item in (found.failures if found else ())]}


def places_of(point: Mapping[str, Any]) -> dict[str, Any]:
    """Places of one case (``bench``: drive or rotor; ``folder``: of its records)."""
    name = point["bench"]
    return located(name, importlib.import_module(f"models.{name}_bench").bench(), Path(point["folder"]))


def located(name: str, bench: Bench, folder: Path) -> dict[str, Any]:
    """Places of one case, and CPU seconds for them (the refit not counted)."""
    records = [read_record(path) for path in sorted(folder.glob("*.parquet"))]
    simulator = Simulator([trial for record in records for trial in bench.trials(record)], STEPS[name])
    null = _null(name, simulator, bench)
    start = time.process_time()
    localiser = Localiser(simulator, null)
    places = localiser.places()
    return {
        "places": [
            {"at": item.at, "probability": item.probability, "gain": item.gain, "share": item.share, "tied": list(item.tied)}
            for item in places[:SHOWN]
        ],
        "trusted": localiser.trusted,
        "left": localiser.left,
        "seconds": time.process_time() - start,
    }


def _null(name: str, simulator: Simulator, bench: Bench) -> Fitted:
    """Drive: refitted, briefly.  Rotor: as the data sheet says; there the localisation refits on its own."""
    factors = tuple(
        Factor(path=item.paths[0], name=key, nominal=dict(zip(item.paths, bench.nominal(key), strict=True)), sigma=item.sigma)
        for key, item in bench.knowledge.items()
    )
    nominal = Hypothesis(factors=factors)
    if name == "rotor":
        return fit(simulator, nominal, np.zeros(nominal.size), steps=0)
    coarse = Simulator(simulator.trials, simulator.step, EVERY)
    return fit(coarse, nominal, np.zeros(nominal.size), steps=ROUNDS)
