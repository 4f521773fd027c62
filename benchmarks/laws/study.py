"""A run of each bench with each law at one place, against the run without it."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from benchmarks.machine import machine as about
from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.lanes import Lanes, run_lanes
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.machine import processor
from hdrive_mbs.compiled.structure import Structure
from hdrive_mbs.diagnosis.candidates import Candidate, candidates
from hdrive_mbs.scene import Scene
from models import drive_bench, rotor_bench

FloatArray = npt.NDArray[np.float64]

COSTLY = ("pow", "exp", "log", "tanh", "sin", "cos", "div", "sqrt", "pieces")
"""Operations that are told by number."""
QUICK = ("DahlFriction", "Looseness", "PreslidingFriction")
"""Laws of the smoke test."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Bench:
    """A scene with what its runs read, where they start, and their step.

    every, inner : distance of the samples [s] and steps in it
    """

    name: str
    scene: Scene
    channels: tuple[str, ...]
    speeds: Mapping[str, float]
    every: float
    inner: int


def benches() -> tuple[Bench, ...]:
    """The drive bench pushed off, the rotor bench at speed, both left to themselves."""
    places = ("bearing_1", "rotor_1", "bearing_2", "rotor_2")
    return (
        Bench(
            name="drive bench",
            scene=drive_bench.build(),
            channels=("motor.speed", "load.speed"),
            speeds={"motor": 100.0},
            every=5e-4,
            inner=2,
        ),
        Bench(
            name="rotor bench",
            scene=rotor_bench.undriven("run_up"),
            channels=("rotor_1.x", "rotor_2.y"),
            speeds=dict.fromkeys(places, 300.0),
            every=rotor_bench.SAMPLE_TIME,
            inner=3,
        ),
    )


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Rows: bench, law, at, operations, costly (operation -> number), run_s (least of the repeats), of_nominal, step_error.

    step_error : largest difference from the run with half the step, of the largest reading;  NaN where a run is not finite
    """
    rows: list[dict[str, Any]] = []
    for bench in benches():
        nominal = _row(bench, bench.scene, quick, repeats)
        rows.append({"bench": bench.name, "law": "none", "at": "", **nominal, "of_nominal": 1.0})
        for law in _one_of_each(bench.scene, quick):
            item = law.starts[0]
            made = _row(bench, bench.scene.with_effect(item.effect, at=item.at, name=item.name), quick, repeats)
            share = made["run_s"] / nominal["run_s"]
            rows.append({"bench": bench.name, "law": law.kind.__name__, "at": law.at, **made, "of_nominal": share})
    return {"about": about(), "lanes": processor().lanes, "repeats": repeats, "rows": rows}


def _one_of_each(scene: Scene, quick: bool) -> list[Candidate]:
    """Each law at the first place where a search would try it."""
    found: dict[str, Candidate] = {}
    for item in candidates(scene):
        found.setdefault(item.kind.__name__, item)
    return [item for name, item in found.items() if not quick or name in QUICK]


def _row(bench: Bench, scene: Scene, quick: bool, repeats: int) -> dict[str, Any]:
    network = scene.network()
    line = CompiledLine(without_idle(network) if network.is_lateral else network, bench.channels)
    samples = 40 if quick else 1000
    taken = []
    for _ in range(repeats):
        begun = time.process_time()
        whole = _run(bench, line, samples, bench.inner)
        taken.append(time.process_time() - begun)
    half = _run(bench, line, samples, 2 * bench.inner)
    error = float(np.max(np.abs(whole - half)) / np.max(np.abs(half))) if np.isfinite(whole).all() and np.isfinite(half).all() else np.nan
    return {"operations": _operations(line.structure), "costly": _costly(line.structure), "run_s": min(taken), "step_error": error}


def _run(bench: Bench, line: CompiledLine, samples: int, inner: int) -> FloatArray:
    """Readings of one lane of all lanes, shape (channels, samples); NaN where the run was not finite."""
    initial = np.array([line.initial(None, bench.speeds, None)])
    out, good = run_lanes(Lanes([line.program], processor().lanes), initial, samples, bench.every, inner, 0.0)
    return out[:, 0] if good[0] == samples else np.full_like(out[:, 0], np.nan)


def _operations(structure: Structure) -> int:
    return sum(step.operation not in ("constant", "number", "variable", "input") for step in structure.steps)


def _costly(structure: Structure) -> dict[str, int]:
    counts = Counter(step.operation for step in structure.steps if step.operation in COSTLY)
    return {name: counts[name] for name in COSTLY if counts[name]}
