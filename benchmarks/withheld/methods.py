"""Ways to answer a case: the diagnosis itself, and the baselines that it is compared with."""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from benchmarks.withheld.answer import answer_of
from benchmarks.withheld.finding import finding_of
from benchmarks.withheld.memory import Memory
from benchmarks.withheld.names import names_of
from benchmarks.withheld.raw import places_of, raw_of
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.gather import Evidence
from hdrive_mbs.records.reading import read_record
from hdrive_mbs.records.record import Record


@dataclass(frozen=True, kw_only=True)
class Solved:
    """The answer to a case, with raw figures as plain data."""

    answer: dict[str, Any]
    raw: Mapping[str, Any] = field(default_factory=dict)


Method = Callable[..., Solved]
"""(bench, folder of a case) -> answer; a method may ask for more, by name: raw, truths.  A case has the name of its folder."""


def bench_of(name: str) -> Bench:
    """What is known of the bench "drive" or "rotor"."""
    module = importlib.import_module(f"models.{name}_bench")
    bench: Bench = module.bench()
    return bench


def records_of(folder: Path) -> list[Record]:
    """The records of a case; nothing else in its folder is looked at."""
    return [read_record(path) for path in sorted(folder.glob("*.parquet"))]


def full(bench: str, folder: Path, workers: int = 1, search_seconds: float | None = None) -> Solved:
    """The diagnosis as it is delivered, without pictures."""
    known, kept = bench_of(bench), []
    start = time.process_time()
    with Memory() as memory:
        diagnosis = diagnose(known, records_of(folder), workers=workers, pictures=False, watch=kept.append, search_seconds=search_seconds)
    evidence: Evidence = kept[0]
    finding = finding_of(diagnosis)
    raw = {
        "case": folder.name,
        "bench": bench,
        "seconds": diagnosis.seconds,
        "processor_seconds": time.process_time() - start,
        "memory_peak": memory.peak,
        **raw_of(evidence, known.groups),
        "where": {place.at: place.probability for place in diagnosis.where},
        "places": places_of(diagnosis),
        "elsewhere": finding.elsewhere,
        "verdict": diagnosis.verdict,
        "notes": list(diagnosis.notes),
        "warnings": list(diagnosis.warnings),
    }
    return Solved(answer=answer_of(folder.name, finding, names_of(bench)), raw=raw)


METHODS: dict[str, str] = {
    "full": "benchmarks.withheld.methods:full",
    "no-refit": "benchmarks.withheld.baselines:no_refit",
    "training": "benchmarks.withheld.baselines:training",
    "regression": "benchmarks.withheld.regression:regression",
    "chance": "benchmarks.withheld.baselines:chance",
    "oracle": "benchmarks.withheld.oracle:oracle",
}
"""Name of a method -> module:function."""


def method(name: str) -> Method:
    """The function of a method."""
    if name not in METHODS:
        raise ValueError(f"no method {name!r}; there are: {', '.join(METHODS)}.")
    module, _, function = METHODS[name].partition(":")
    found: Method = getattr(importlib.import_module(module), function)
    return found
