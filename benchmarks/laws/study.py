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

    of_nominal : time over that of the run without the law, both in turns, least of each
    step_error : largest difference from the run with half the step, of the largest reading;  NaN where a run is not finite
    """
    samples = 40 if quick else 1000
    rows: list[dict[str, Any]] = []
    for bench in benches():
        nominal = _line(bench, bench.scene)
        laws = [(item.kind.__name__, item.at, item.starts[0]) for item in _one_of_each(bench.scene, quick)]
        lines = [(name, at, _line(bench, bench.scene.with_effect(start.effect, at=at, name=start.name))) for name, at, start in laws]
        for name, at, line in [("none", "", nominal), *lines]:
            own, without = _in_turns(bench, line, nominal, samples, repeats)
            costs = {
                "operations": _operations(line.structure),
                "costly": _costly(line.structure),
                "run_s": own,
                "of_nominal": own / without,
            }
            rows.append({"bench": bench.name, "law": name, "at": at, **costs, "step_error": _step_error(bench, line, samples)})
    return {"about": about(), "lanes": processor().lanes, "repeats": repeats, "rows": rows}


def _one_of_each(scene: Scene, quick: bool) -> list[Candidate]:
    """Each law at the first place where a search would try it."""
    found: dict[str, Candidate] = {}
    for item in candidates(scene):
        found.setdefault(item.kind.__name__, item)
    return [item for name, item in found.items() if not quick or name in QUICK]


def _line(bench: Bench, scene: Scene) -> CompiledLine:
    network = scene.network()
    return CompiledLine(without_idle(network) if network.is_lateral else network, bench.channels)


def _in_turns(bench: Bench, line: CompiledLine, nominal: CompiledLine, samples: int, repeats: int) -> tuple[float, float]:
    """CPU seconds of a run of both lines, least of the repeats after a first one that is not counted."""
    taken: tuple[list[float], list[float]] = ([], [])
    for _ in range(repeats + 1):
        for some, times in zip((line, nominal), taken, strict=True):
            begun = time.process_time()
            _run(bench, some, samples, bench.inner)
            times.append(time.process_time() - begun)
    return min(taken[0][1:]), min(taken[1][1:])


def _step_error(bench: Bench, line: CompiledLine, samples: int) -> float:
    whole, half = (_run(bench, line, samples, parts * bench.inner) for parts in (1, 2))
    if not (np.isfinite(whole).all() and np.isfinite(half).all()):
        return float("nan")
    return float(np.max(np.abs(whole - half)) / np.max(np.abs(half)))


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
