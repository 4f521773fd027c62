"""Many parameter sets of a hypothesis, run through all trials: whitened residuals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.line import CompiledLine, run_many
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.noise import Whitener
from hdrive_mbs.diagnosis.robust import Blocks
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import LawError, ParameterError, SimulationError

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

BLOCKS = 12
"""Stretches of a record, each with its own scale where the model is wrong."""
LARGEST = 1e7
"""A whitened residual beyond it counts as this: such a run is far from the record."""


@dataclass(frozen=True, eq=False)
class Segment:
    """Where one column of one trial sits in the vector of residuals."""

    trial: int
    column: str
    span: slice


class Simulator:
    """Trials with their whitening, ready for hypotheses.

    trials : at least one;  step : longest step of the integration [s]
    every : compare only each such sample: a cheaper look, less sharp

    Residuals are measured minus simulated in standard deviations of the noise, all columns of all trials one after
    the other (``segments``); ``fit`` and ``held_out`` say which of them a fit may see.
    """

    def __init__(self, trials: Sequence[Trial], step: float, every: int = 1) -> None:
        if not trials:
            raise ParameterError("A diagnosis needs at least one record.")
        self.trials, self.step, self.every = tuple(trials), step, every
        segments: list[Segment] = []
        fit: list[Mask] = []
        held: list[Mask] = []
        self._whiteners: list[Whitener] = []
        self._measured: list[FloatArray] = []
        self._there: list[Mask | None] = []
        at = 0
        for k, trial in enumerate(self.trials):
            for column, values in trial.columns.items():
                there = np.isfinite(values)
                number = len(values[::every])
                segments.append(Segment(k, column, slice(at, at + number)))
                at += number
                fit.append((there & ~trial.held_out)[::every])
                held.append((there & trial.held_out)[::every])
                self._whiteners.append(Whitener(trial.measured[column], there, every))
                self._measured.append(np.where(there, values, 0.0))
                self._there.append(None if there.all() else there)
        self.segments = tuple(segments)
        self.fit, self.held_out = np.concatenate(fit), np.concatenate(held)
        self.used = self.fit | self.held_out
        self.blocks = Blocks(self._numbered()[self.fit])
        self.runs = 0

    def _numbered(self) -> npt.NDArray[np.int64]:
        """Block of every residual: BLOCKS stretches of each column of each trial."""
        parts = []
        for k, segment in enumerate(self.segments):
            samples = segment.span.stop - segment.span.start
            parts.append(k * BLOCKS + np.arange(samples) * BLOCKS // samples)
        return np.unique(np.concatenate(parts), return_inverse=True)[1]

    @property
    def size(self) -> int:
        """Number of residuals."""
        return len(self.fit)

    def residuals(self, hypothesis: Hypothesis, points: Sequence[FloatArray]) -> list[FloatArray | None]:
        """Whitened residuals at each point, shape (size,); None where a point cannot be simulated."""
        found: list[FloatArray | None] = [np.empty(self.size) for _ in points]
        index = 0
        for trial in self.trials:
            simulated = self._simulated(trial, hypothesis, points)
            for column in trial.columns:
                span, whiten, measured, there = self.segments[index].span, self._whiteners[index], self._measured[index], self._there[index]
                for k, values in enumerate(simulated):
                    own = found[k]
                    if values is None or own is None:
                        found[k] = None
                        continue
                    left = measured - values[column]
                    own[span] = np.clip(whiten(left if there is None else left * there), -LARGEST, LARGEST)
                index += 1
        return found

    def _simulated(self, trial: Trial, hypothesis: Hypothesis, points: Sequence[FloatArray]) -> list[dict[str, FloatArray] | None]:
        """Values of the columns of a trial at its samples, by point."""
        channels = [trial.measured[column].channel for column in trial.columns]
        lines: list[CompiledLine] = []
        where: list[int] = []
        for k, point in enumerate(points):
            try:
                network = hypothesis.scene(trial.scene, point).network()
                lines.append(CompiledLine(network, channels))
                where.append(k)
            except (ParameterError, LawError):
                continue
        late = {column for column, item in trial.measured.items() if item.late}
        fold = 2 if late else 1
        runs = run_many(lines, fold * trial.samples, trial.every / fold, step=self.step, angles=trial.angles, speeds=trial.speeds)
        self.runs += len(lines)
        found: list[dict[str, FloatArray] | None] = [None] * len(points)
        for k, run in zip(where, runs, strict=True):
            if isinstance(run, SimulationError):
                continue
            found[k] = {
                column: run.values[trial.measured[column].channel][(1 if column in late else 0) :: fold] for column in trial.columns
            }
        return found


def chi_square(residuals: FloatArray, mask: Mask) -> float:
    """Mean square over a part of the residuals; 1 where nothing but noise is left."""
    part = residuals[mask]
    return float(part @ part) / len(part)
