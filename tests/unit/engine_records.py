"""Records of rotor lines made by the multibody engine, with a step of its own, parameters off by their tolerance, and noise."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record

STEP = 1e-3
"""Between two samples [s]."""


def disturbed(scene: hm.Scene, knowledge: Mapping[str, tuple[Sequence[str], float]], off: Mapping[str, float]) -> hm.Scene:
    """A scene whose parameters are off.

    knowledge : paths of each group and their relative standard deviation;  off : how many of these it is off, by group
    """
    known = scene.parameters()
    changed = {path: known[path].value * math.exp(sigma * off[name]) for name, (paths, sigma) in knowledge.items() for path in paths}
    return scene.replacing(changed)


def engine_record(
    plant: hm.Scene, effects: Sequence[tuple[Effect, str]], channels: Sequence[str], *, duration: float, noise: float, seed: int
) -> Record:
    """Displacements of a scene with effects in it, run undeflected from its start [m]."""
    for effect, place in effects:
        plant = plant.with_effect(effect, at=place)
    times = np.asarray(STEP * np.arange(round(duration / STEP) + 1), float)
    run = hm.simulate(plant, duration, solver=hm.Trapezoidal(step=5e-5, newton_tolerance=1e-8), sample_step=STEP, progress=False)
    rng = np.random.default_rng(seed)
    values = {name: run.at(name, times) + noise * rng.standard_normal(len(times)) for name in channels}
    return Record(name="run_up", times=times, channels={n: Measurement(name=n, unit="m", values=v) for n, v in values.items()})
