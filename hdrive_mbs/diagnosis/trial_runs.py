"""Lines run through a trial; with half the step where they grow at the one that was chosen for the nominal model."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.line import CompiledLine, CompiledRun, run_many
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import SimulationError

FloatArray = npt.NDArray[np.float64]

LARGEST = 1e7
"""Standard deviations of its noise that a column may be off: a run beyond it is far from the record, and beyond ten times what was
measured besides it has grown of itself."""


def run_trial(
    trial: Trial,
    lines: Sequence[CompiledLine],
    angles: Sequence[Mapping[str, float]],
    step: float,
    *,
    parts: int = 1,
    again: bool = True,
) -> list[CompiledRun | SimulationError]:
    """Each line through the trial from its angles [rad, m].

    step : longest one of the integration [s];  parts : in which it is divided
    again : whether what grows is run again with half of it: what stiffens a line may need that
    """
    fold = fold_of(trial)
    every = trial.every / fold
    inner = math.ceil(every / step * (1.0 - 1e-9))

    def run(at: Sequence[int], parts: int) -> list[CompiledRun | SimulationError]:
        some, where = [lines[k] for k in at], [angles[k] for k in at]
        return run_many(some, fold * trial.samples, every, step=every / (inner * parts), angles=where, speeds=trial.speeds)

    runs = run(range(len(lines)), parts)
    limits = _limits(trial)
    wild = [k for k, item in enumerate(runs) if again and _grows(item, limits)]
    if wild:
        for k, item in zip(wild, run(wild, 2 * parts), strict=True):
            runs[k] = item
    return runs


def measured_in(trial: Trial, run: CompiledRun) -> dict[str, FloatArray]:
    """The values of the measured columns at their samples; those that are compared half a sample later from there."""
    fold = fold_of(trial)
    return {name: run.values[item.channel][1 if item.late else 0 :: fold].copy() for name, item in trial.measured.items()}


def fold_of(trial: Trial) -> int:
    """Runs are sampled twice as often where a column is compared half a sample later."""
    return 2 if any(item.late for item in trial.measured.values()) else 1


def _limits(trial: Trial) -> dict[str, float]:
    """Values beyond which a channel has grown of itself."""
    found: dict[str, float] = {}
    for name, item in trial.measured.items():
        there = trial.columns[name][np.isfinite(trial.columns[name])]
        limit = LARGEST * item.white + 10.0 * float(np.max(np.abs(there), initial=0.0))
        found[item.channel] = max(limit, found.get(item.channel, 0.0))
    return found


def _grows(run: CompiledRun | SimulationError, limits: Mapping[str, float]) -> bool:
    return isinstance(run, SimulationError) or any(np.max(np.abs(run.values[name])) > limit for name, limit in limits.items())
