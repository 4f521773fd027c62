"""Every planted case, diagnosed: what it says, how far the gap shrinks, what it costs."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.campaign import Where
from benchmarks.flagship.cases import CASES, Planted
from benchmarks.flagship.plant import drawn
from benchmarks.flagship.records import write
from benchmarks.machine import machine
from hdrive_mbs.cli.demo import one_law_each
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.records.reading import read_records
from models.robot_joint_line import bench

SEED = 7
RECORDS = ("to_and_fro",)


def study(*, quick: bool, names: Sequence[str] = (), laws: str = "one", where: Where | None = None) -> dict[str, Any]:
    """Answers to all cases; of ``quick`` only the first.  Each case draws its own specimen and noise.

    laws : "one" of each family, as the demo has it, or "all" of the library
    """
    chosen = [case.name for case in CASES if not names or case.name in names][: 1 if quick else None]
    started = machine()
    found = (where or Where()).sweep(diagnosed, [{"case": name, "laws": laws} for name in chosen])
    failed = {item["parameters"]["case"]: item["error"] for item in found.failures}
    cases = [_failed(name, failed[name]) if name in failed else dict(values) for name, values in zip(chosen, found.values, strict=True)]
    return {"machine": started, "seed": SEED, "records": RECORDS, "laws": laws, "cases": cases}


def diagnosed(point: Mapping[str, Any]) -> dict[str, Any]:
    """The answer to one case (``case``: its name; ``laws``: "one" or "all"), with its cost."""
    [case] = [item for item in CASES if item.name == point["case"]]
    return _case(case, one_law_each() if point["laws"] == "one" else None)


def _failed(name: str, error: str) -> dict[str, Any]:
    [case] = [item for item in CASES if item.name == name]
    return {"case": name, "planted": case.said, "right": case.right, "error": error, "cpu_s": None}


def _case(case: Planted, tried: Sequence[type[Effect]] | None) -> dict[str, Any]:
    rng = np.random.default_rng([SEED, CASES.index(case)])
    with tempfile.TemporaryDirectory() as folder:
        paths = write(case.joint(drawn(rng)), Path(folder), rng, records=RECORDS)
        records = read_records(paths)
    started = _cpu(), time.perf_counter()
    found = diagnose(bench(), records, candidates=tried, pictures=False)
    cpu, wall = _cpu() - started[0], time.perf_counter() - started[1]
    gap = found.gap
    answer = {
        "verdict": found.verdict,
        "causes": [{"effect": c.effect, "place": c.at, "law": c.law, "probability": c.probability} for c in found.causes],
        "tied": [list(item) for item in found.indistinguishable],
        "located": [{"place": place.at, "probability": place.probability} for place in found.where[:3]],
    }
    misfits = {name: {"value": m.value, "low": m.low, "high": m.high} for name, m in _misfits(gap)}
    right = _right(case, found)
    return {"case": case.name, "planted": case.said, "right": case.right, **answer, **right, "gap": misfits, "cpu_s": cpu, "wall_s": wall}


def _misfits(gap: Any) -> list[tuple[str, Any]]:
    return [("nominal", gap.nominal), ("refitted", gap.refit), ("with_cause", gap.effect)]


def _right(case: Planted, found: Diagnosis) -> dict[str, bool]:
    """Verdict, effect and place, each on its own; a second cause counts as wrong."""
    verdict, effect, place = case.right
    causes = [(cause.effect, cause.at) for cause in found.causes]
    return {
        "verdict_right": found.verdict == verdict,
        "effect_right": [name for name, _ in causes] == ([effect] if effect else []),
        "place_right": [at for _, at in causes] == ([place] if place else []),
    }


def _cpu() -> float:
    """User and system time of this process [s]."""
    times = os.times()
    return times.user + times.system
