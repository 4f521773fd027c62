"""Lines run through trials; with half the step where they grow at the one that was chosen for the nominal model.

Lines of different trials go side by side where these are sampled and stepped alike: most questions are of one line or two, and a run of as
many as the processor has lanes takes little longer than one of one (benchmarks/lanes).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.line import CompiledLine, CompiledRun, run_many
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import SimulationError

FloatArray = npt.NDArray[np.float64]

LARGEST = 1e7
"""Standard deviations of its noise that a column may be off: a run beyond it is far from the record, and beyond ten times what was
measured besides it has grown of itself."""
AT_ONCE = 16
"""Lines whose whole courses are held in memory at a time."""


@dataclass(frozen=True, eq=False)
class Through:
    """A line that is to go through a trial from its angles [rad, m].

    step, shortest : longest steps of the integration [s], and those of what grows at them; half of them if not given
    """

    trial: Trial
    line: CompiledLine
    angles: Mapping[str, float]
    step: float
    shortest: float | None = None


def run_trials(asked: Sequence[Through], *, parts: int = 1, again: bool = True) -> Iterator[tuple[int, CompiledRun | SimulationError]]:
    """(number of what was asked, its run), in an order of its own.

    parts : in which each step is divided
    again : whether what grows is run again with the shortest ones: what stiffens a line may need that
    """
    alike: dict[tuple[float, int, int], list[int]] = {}
    for number, item in enumerate(asked):
        every = item.trial.every / fold_of(item.trial)
        inner = _whole(every / item.step)
        finest = 2 * inner if item.shortest is None else _whole(every / item.shortest)
        alike.setdefault((every, inner, finest), []).append(number)
    for (every, inner, finest), numbers in alike.items():
        numbers.sort(key=lambda k: -_samples(asked[k].trial))  # those that go to the same end together
        for first in range(0, len(numbers), AT_ONCE):
            some = numbers[first : first + AT_ONCE]
            found = dict(zip(some, _side_by_side([asked[k] for k in some], every, inner * parts), strict=True))
            if wild := [k for k, item in found.items() if again and _grows(item, asked[k].trial)]:
                found.update(zip(wild, _side_by_side([asked[k] for k in wild], every, finest * parts), strict=True))
            yield from found.items()


def _whole(steps: float) -> int:
    return math.ceil(steps * (1.0 - 1e-9))


def _side_by_side(asked: Sequence[Through], every: float, inner: int) -> list[CompiledRun | SimulationError]:
    samples = [_samples(item.trial) for item in asked]
    angles, speeds = [item.angles for item in asked], [item.trial.speeds for item in asked]
    return run_many([item.line for item in asked], samples, every, step=every / inner, angles=angles, speeds=speeds)


def _samples(trial: Trial) -> int:
    return fold_of(trial) * trial.samples


def run_trial(
    trial: Trial, lines: Sequence[CompiledLine], angles: Sequence[Mapping[str, float]], step: float, *, parts: int = 1
) -> list[CompiledRun | SimulationError]:
    """Each line through one trial from its angles [rad, m] in steps of at most this length [s], as ``run_trials`` does."""
    asked = [Through(trial, line, start, step) for line, start in zip(lines, angles, strict=True)]
    found = dict(run_trials(asked, parts=parts))
    return [found[k] for k in range(len(lines))]


def measured_in(trial: Trial, run: CompiledRun) -> dict[str, FloatArray]:
    """The values of the measured columns at their samples; those that are compared half a sample later from there."""
    fold = fold_of(trial)
    return {name: run.values[item.channel][1 if item.late else 0 :: fold].copy() for name, item in trial.measured.items()}


def fold_of(trial: Trial) -> int:
    """Runs are sampled twice as often where a column is compared half a sample later."""
    return 2 if any(item.late for item in trial.measured.values()) else 1


def _grows(run: CompiledRun | SimulationError, trial: Trial) -> bool:
    """Whether a run ended, or a channel of it is beyond what can have been measured."""
    if isinstance(run, SimulationError):
        return True
    farthest: dict[str, float] = {}
    for name, item in trial.measured.items():
        limit = LARGEST * item.white + 10.0 * trial.largest[name]
        farthest[item.channel] = max(limit, farthest.get(item.channel, 0.0))
    return any(run.values[name].max() > limit or run.values[name].min() < -limit for name, limit in farthest.items())
