"""All measurements of the benchmark."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

import hdrive_mbs as hm
from benchmarks.machine import machine
from benchmarks.stiffness_laws.claim import Claim
from benchmarks.teeth.claims import claims
from benchmarks.teeth.speed import accuracy, against_shapely, linearised, shapely_design, sweep
from hdrive_mbs.plots import plot
from hdrive_mbs.teeth.clearance import clearances
from models.double_harmonic_transmission import gear


def study(quick: bool = False, repeats: int = 3) -> tuple[dict[str, Any], list[Claim]]:
    """Numbers and claims."""
    count = 500 if quick else 10_000
    tasks = {f"{name}, {stage.name}": hm.DesignTask.of(stage) for name in ("A", "C") for stage in gear(name).stages()}
    numbers: dict[str, Any] = {
        "machine": machine(),
        "repeats": repeats,
        "sweeps": {name: sweep(task, count, repeats) for name, task in tasks.items()},
        "accuracy": {name: accuracy(task, 20 if quick else 300) for name, task in list(tasks.items())[:2]},
        "shapely": against_shapely(1 if quick else 3, 360),
        "shapely_design": shapely_design(next(iter(tasks.values())), 5 if quick else 100),
        "linearised": linearised(),
        "windows": {} if quick else {name: _window(task) for name, task in tasks.items()},
        "gears": {name: _gear(name) for name in ("A", "C")},
    }
    return numbers, claims()


def _window(task: hm.DesignTask) -> dict[str, Any]:
    window = task.window()
    return {
        "best": dict(window.best),
        "bounds": [vars(bound) for bound in window.bounds],
        "status": window.status,
        "words": window.explain(),
    }


def _gear(name: str) -> dict[str, Any]:
    one = gear(name)
    return {"ratio": one.ratio, "lost_motion_rad": one.lost_motion, "words": one.explain()}


def figures() -> dict[str, Figure]:
    """Pictures of set A: Figs 3 and 5 of the paper, the section, clearances and the window of stage I."""
    one = gear("A")
    drawn: dict[str, Any] = {"section": plot(one)}
    for number, stage in enumerate(one.stages(), start=1):
        drawn[f"positions_{number}"] = plot(hm.tooth_motion(stage, np.radians(np.arange(0.0, 181.0, 10.0))))
        drawn[f"clearance_map_{number}"] = plot(hm.clearance_map(stage))
        drawn[f"clearance_{number}"] = plot(clearances(stage))
    drawn["design_1"] = plot(hm.DesignTask.of(one.stages()[0]).window())
    return {name: axes.figure for name, axes in drawn.items()}
