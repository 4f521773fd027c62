"""Every case of a set: the places found, beside the true one."""

from __future__ import annotations

import importlib
import json
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

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


def study(sets: Mapping[str, Sequence[Path]], *, kept: Path | None = None, most: int | None = None) -> dict[str, Any]:
    """All cases of all sets of each bench.

    kept : folder for what each case gave;  most : cases of each set
    """
    found: dict[str, list[dict[str, Any]]] = {}
    for name, folders in sets.items():
        bench = importlib.import_module(f"models.{name}_bench").bench()
        found[name] = []
        for folder in folders:
            cases = {case: truth for case, truth in read_truths(folder).items() if case.startswith(name)}
            for case, truth in list(cases.items())[:most]:
                given = _kept(kept, case, lambda n=name, b=bench, f=folder / case: located(n, b, f))
                found[name].append(judged(name, given, case, truth))
    return {"machine": machine(), "cases": found}


def _kept(folder: Path | None, case: str, made: Any) -> dict[str, Any]:
    if folder is None:
        return dict(made())
    file = folder / f"{case}.json"
    if not file.exists():
        folder.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(made(), indent=1), encoding="utf-8")
    return dict(json.loads(file.read_text(encoding="utf-8")))


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
