"""All runs, interleaved, with their errors; and the time of each method at one error."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence
from typing import Any

import numpy as np

import hdrive_mbs as hm
from benchmarks.machine import machine
from benchmarks.speed.methods import Method, methods
from benchmarks.speed.reference import reference
from benchmarks.speed.start import around_a_run, fresh_processes
from hdrive_mbs.progress import progress_bar
from models.harmonic_drive_train import build

TARGET = 1e-6
CASES = {
    "train": "the train of models/harmonic_drive_train.py",
    "light": "the same with B_FS = 5 and B_wwy = 1 N m s/rad in place of 20 and 5",
    "joint": "the same with the data of a robot joint",
}
"""The dampings of the first make one mode of pure decay with 57,000 1/s; those of the others do not."""

CHANGES: dict[str, dict[str, float]] = {
    "train": {},
    "light": {"gear.damping": 5.0, "output_shaft.damping": 1.0},
    "joint": {
        "motor.inertia": 2.1e-3,
        "input_shaft.stiffness": 400.0,
        "input_shaft.inertia": 0.0,
        "gear.wave_generator_inertia": 4.5e-4,
        "gear.flexspline_inertia": 0.012,
        "gear.damping": 12.0,
        "gear.stiffness.lost_motion": 2.9e-4,
        "output_shaft.stiffness": 5.19e4,
        "output_shaft.damping": 6.0,
        "output_shaft.inertia": 0.0,
        "load.inertia": 1.8,
    },
}
"""The joint: an output flange of 0.012 kg m2 on the flexspline, a bench with a gear of the same size
(1 arcmin, 12 N m s/rad) and an elastic coupling of 400 N m/rad."""


def case(name: str) -> hm.Scene:
    """The scene of a case."""
    return build().replacing(CHANGES[name])


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Everything that the report needs."""
    duration = 0.01 if quick else 1.0
    facts = machine()
    plan = {name: methods(case(name), duration) for name in (["train"] if quick else CASES)}
    if quick:
        plan = {name: [Method(m.name, m.ladder[1:3], m.run) for m in found] for name, found in plan.items()}
    runs = sum(len(method.ladder) for found in plan.values() for method in found) * repeats
    cases = {}
    with progress_bar("speed of the train", runs + 20 * len(plan)) as report:
        done = 0
        for name, found in plan.items():
            exact = reference(case(name), duration)
            done += 20
            seconds: dict[tuple[str, float], list[float]] = {}
            errors: dict[tuple[str, float], float] = {}
            steps: dict[tuple[str, float], int] = {}
            for _ in range(repeats):
                for method in found:
                    for setting in method.ladder:
                        once = method.run(setting)
                        key = (method.name, setting)
                        seconds.setdefault(key, []).append(once.seconds)
                        if key not in errors:
                            errors[key], steps[key] = exact.error(once.times, once.states), len(once.times) - 1
                        done += 1
                        if report is not None:
                            report(done)
            cases[name] = {
                "what": CASES[name],
                "reference_agreement": exact.agreement,
                **_stability(case(name), duration),
                "methods": {method.name: _method(method, seconds, errors, steps) for method in found},
            }
    return {
        "duration": duration,
        "repeats": repeats,
        "target_error": TARGET,
        "cases": cases,
        "fresh_processes": fresh_processes(1 if quick else 7),
        "around_a_run": around_a_run(1 if quick else 11, duration),
        "machine": facts,
    }


STABILITY = 3.3
"""Radius on the negative real axis inside which the Dormand-Prince method 5(4) is stable (Hairer & Wanner II, IV.2)."""


def _stability(scene: hm.Scene, duration: float) -> dict[str, float]:
    """The fastest eigenvalue of the train, running under 20 N m, and the steps that an explicit method needs for it."""
    found = hm.modes(scene, torque=20.0)
    oscillating = found.damped / np.sqrt(1.0 - found.damping_ratio**2)
    fastest = float(max(np.max(oscillating, initial=0.0), np.max(found.decay_rates, initial=0.0)))
    return {"fastest_rate": fastest, "fewest_steps": fastest * duration / STABILITY}


Key = tuple[str, float]
"""Name of a method and its setting."""


def _method(method: Method, seconds: dict[Key, list[float]], errors: dict[Key, float], steps: dict[Key, int]) -> dict[str, Any]:
    keys = [(method.name, setting) for setting in method.ladder]
    medians = [statistics.median(seconds[key]) for key in keys]
    error = [errors[key] for key in keys]
    return {
        "settings": list(method.ladder),
        "error": error,
        "median_seconds": medians,
        "best_seconds": [min(seconds[key]) for key in keys],
        "samples": [steps[key] for key in keys],
        "seconds_at_target": time_at(TARGET, error, medians),
    }


def time_at(target: float, errors: Sequence[float], seconds: Sequence[float]) -> float:
    """Seconds for an error of the target: a straight line through log(seconds) over log(error), least squares.

    Through the runs whose error is within a factor of 100 of the target: where a step falls beside a corner of the
    law is chance, and so one run's error is uncertain by a factor of 3 or so.  NaN where no run is as good as
    the target, the fastest of them where none is worse.
    """
    near = [(e, s) for e, s in zip(errors, seconds, strict=True) if target / 100.0 <= e <= 100.0 * target and s > 0.0]
    good = [s for e, s in zip(errors, seconds, strict=True) if e <= target and s > 0.0]
    if not good:
        return math.nan
    if not any(e <= target for e, _ in near) or not any(e > target for e, _ in near):
        return min(good)
    _, offset = np.polyfit(np.log([e / target for e, _ in near]), np.log([s for _, s in near]), 1)
    return float(np.exp(offset))
