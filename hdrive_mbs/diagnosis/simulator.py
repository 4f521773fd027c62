"""Many parameter sets of a hypothesis, run through all trials: whitened residuals."""

from __future__ import annotations

import copy
import itertools
from collections import OrderedDict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.slowed import Slowed
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.lines import Lines, Start
from hdrive_mbs.diagnosis.noise import Free, Whitener
from hdrive_mbs.diagnosis.resting import repeated
from hdrive_mbs.diagnosis.robust import Blocks
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.trial_runs import LARGEST, Through, measured_in, run_trials
from hdrive_mbs.errors import ParameterError, SimulationError

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]
Values = dict[str, FloatArray]
Skipped = frozenset[int]

BLOCKS = 12
"""Stretches of a record, each with its own scale where the model is wrong."""
KEPT = 8
"""Runs of each trial that are kept: an effect of sensors or of the drive leaves some trials as they are."""
AT_ONCE = 8
"""Points that are run at once: their columns in all trials take memory, of which residuals keep a part."""


@dataclass(frozen=True, eq=False)
class Segment:
    """Where one column of one trial sits in the vector of residuals."""

    trial: int
    column: str
    span: slice


class Simulator:
    """Trials with their whitening, ready for hypotheses.

    trials : at least one;  step : longest step of the integration [s], or one for each of them
    every : compare only each such sample: a cheaper look, less sharp
    parts : in which each step is divided;  again : whether what grows at it is run again with half of it, see ``run_trials``,
        or with the ``shortest`` one [s]
    slowed : vibrations that are slowed in all lines (pace.py)

    unseen : by name of a nominal parameter the trials in which it is not believed to show (``Simulator.knowing``)

    Residuals are measured minus simulated in standard deviations of the noise, all columns of all trials one after
    the other (``segments``); ``fit`` and ``held_out`` say which of them a fit may see.
    """

    def __init__(
        self,
        trials: Sequence[Trial],
        step: float | Sequence[float],
        every: int = 1,
        *,
        parts: int = 1,
        again: bool = True,
        slowed: Sequence[Slowed] = (),
        shortest: float | None = None,
    ) -> None:
        if not trials:
            raise ParameterError("A diagnosis needs at least one record.")
        self.trials, self.every, self.parts, self.again = tuple(trials), every, parts, again
        self.steps = tuple(step) if isinstance(step, Sequence) else (step,) * len(self.trials)
        if len(self.steps) != len(self.trials):
            raise ParameterError(f"{len(self.steps)} steps for {len(self.trials)} trials; give one for all or one for each.")
        self.shortest = shortest
        self.slowed = tuple(slowed)
        segments: list[Segment] = []
        fit: list[Mask] = []
        held: list[Mask] = []
        self._whiteners: list[Whitener] = []
        self._measured: list[FloatArray] = []
        self._there: list[Mask | None] = []
        at = 0
        for k, trial in enumerate(self.trials):
            for column, values in trial.columns.items():
                there = np.isfinite(values) & ~repeated(trial.measured[column], values, every)
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
        blocks = self._numbered()
        self.blocks, self.held_blocks = Blocks(blocks[self.fit]), Blocks(blocks[self.held_out])
        self.spans = self._spans()
        self.unseen: Mapping[str, Skipped] = {}
        self.runs = 0
        self.forget()

    def forget(self) -> None:
        """Let go of the runs and lines that are kept for what is asked again."""
        self._lines = Lines(self.trials, self.slowed)
        self._kept: list[OrderedDict[object, Values | None]] = [OrderedDict() for _ in self.trials]
        self._started: tuple[Hypothesis, FloatArray, list[dict[str, float]]] | None = None

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in self.__dict__.items() if name not in ("_lines", "_kept", "_started")}

    def __setstate__(self, state: dict[str, object]) -> None:
        self.__dict__.update(state)
        self.forget()

    def _numbered(self) -> npt.NDArray[np.int64]:
        """Block of every residual: BLOCKS stretches of each column of each trial."""
        parts = []
        for k, segment in enumerate(self.segments):
            samples = segment.span.stop - segment.span.start
            parts.append(k * BLOCKS + np.arange(samples) * BLOCKS // samples)
        return np.unique(np.concatenate(parts), return_inverse=True)[1]

    def _spans(self) -> tuple[slice, ...]:
        """Where the fitted residuals of each trial sit among all fitted ones."""
        spans = [[segment.span for segment in self.segments if segment.trial == k] for k in range(len(self.trials))]
        counts = [int(np.count_nonzero(self.fit[some[0].start : some[-1].stop])) if some else 0 for some in spans]
        ends = np.cumsum([0, *counts])
        return tuple(slice(int(a), int(b)) for a, b in itertools.pairwise(ends))

    def knowing(self, unseen: Mapping[str, Collection[str]]) -> Simulator:
        """The same one, told in which trials, by name, a nominal parameter is not believed to show; fits check it."""
        other = copy.copy(self)
        other.unseen = {
            name: frozenset(k for k, trial in enumerate(self.trials) if trial.name in trials) for name, trials in unseen.items()
        }
        other.forget()
        return other

    @property
    def step(self) -> float:
        """The shortest of its steps [s]."""
        return min(self.steps)

    @property
    def size(self) -> int:
        """Number of residuals."""
        return len(self.fit)

    def residuals(
        self,
        hypothesis: Hypothesis,
        points: Sequence[FloatArray],
        skipped: Skipped = frozenset(),
        instead: Sequence[FloatArray] = (),
    ) -> list[FloatArray | None]:
        """Whitened residuals at each point, shape (size,); None where a point cannot be simulated.

        skipped : numbers of trials that are not run;  instead : for each point residuals, shape (size,), from which theirs are taken
        """
        found: list[FloatArray | None] = []
        for first in range(0, len(points), AT_ONCE):
            found += self._residuals(hypothesis, points[first : first + AT_ONCE], skipped, instead[first : first + AT_ONCE])
        return found

    def _residuals(
        self, hypothesis: Hypothesis, points: Sequence[FloatArray], skipped: Skipped, instead: Sequence[FloatArray]
    ) -> list[FloatArray | None]:
        found: list[FloatArray | None] = [instead[k].copy() if skipped else np.empty(self.size) for k in range(len(points))]
        index = 0
        simulated = self._simulated(self._lines.at(hypothesis, points, skipped))
        for number, trial in enumerate(self.trials):
            if number in skipped:
                index += len(trial.columns)
                continue
            for k, values in enumerate(simulated[number]):
                own = found[k]
                if values is None or own is None:
                    found[k] = None
                    continue
                free = self._free(trial, hypothesis, points[k])
                for at, column in enumerate(trial.columns, index):
                    span, whiten, measured, there = self.segments[at].span, self._whiteners[at], self._measured[at], self._there[at]
                    left = measured - values[column]
                    np.clip(whiten(left if there is None else left * there, free), -LARGEST, LARGEST, out=own[span])
            index += len(trial.columns)
        return found

    def _free(self, trial: Trial, hypothesis: Hypothesis, point: FloatArray) -> Free | None:
        """Free vibration of the line at a point that could be run, with which a record may begin."""
        if trial.ringing is None:
            return None
        scene = hypothesis.scene(trial.scene, point, to_run=True)
        # a law with which forces do not balance at rest has none to give
        roots = trial.ringing.roots(scene, trial.every) or trial.ringing.roots(trial.scene, trial.every)
        return Free(trial.ringing.courses(roots, trial.samples, trial.every)) if roots else None

    def columns(self, hypothesis: Hypothesis, point: FloatArray) -> list[Values]:
        """Simulated values of the columns of each trial, in their units; empty where a trial cannot be run."""
        return [item or {} for item in self.columns_at(hypothesis, [point])[0]]

    def columns_at(self, hypothesis: Hypothesis, points: Sequence[FloatArray]) -> list[list[Values | None]]:
        """Likewise at several points, for each of them: None for a trial that cannot be run."""
        found = self._simulated(self._lines.at(hypothesis, points))
        return [[item[k] for item in found] for k in range(len(points))]

    def start_of(self, number: int, hypothesis: Hypothesis, point: FloatArray) -> dict[str, float]:
        """Angles at which a trial starts [rad, m], by coordinate."""
        if self._started is None or self._started[0] is not hypothesis or not np.array_equal(self._started[1], point):
            found = [starts[0] for starts in self._lines.at(hypothesis, [point])]
            self._started = hypothesis, point.copy(), [{} if start is None else start.angles for start in found]
        return dict(self._started[2][number])

    def _simulated(self, starts: Sequence[Sequence[Start | None]]) -> list[list[Values | None]]:
        """For each trial the values of its columns at its samples, by point; equal lines are run once."""
        keys = [[None if start is None else start.key for start in some] for some in starts]
        new: dict[tuple[int, object], Start] = {}
        for number, some in enumerate(starts):
            for key, start in zip(keys[number], some, strict=True):
                if start is not None and key not in self._kept[number]:
                    new[number, key] = start
        found = dict(zip(new, self._run([(number, start) for (number, _), start in new.items()]), strict=True))
        for number, kept in enumerate(self._kept):
            for key in keys[number]:
                if key in kept:
                    kept.move_to_end(key)
                    found[number, key] = kept[key]
            kept.update((key, values) for (of, key), values in found.items() if of == number)
            while len(kept) > KEPT:
                kept.popitem(last=False)
        return [[None if key is None else found[number, key] for key in some] for number, some in enumerate(keys)]

    def _run(self, starts: Sequence[tuple[int, Start]]) -> list[Values | None]:
        """Values of the columns of trials from starts, each with the number of its trial."""
        asked = [Through(self.trials[number], start.line, start.angles, self.steps[number], self.shortest) for number, start in starts]
        self.runs += len(asked)
        found: dict[int, Values | None] = {}
        for k, run in run_trials(asked, parts=self.parts, again=self.again):
            found[k] = None if isinstance(run, SimulationError) else measured_in(asked[k].trial, run)
        return [found[k] for k in range(len(asked))]


def chi_square(residuals: FloatArray, mask: Mask) -> float:
    """Mean square over a part of the residuals; 1 where nothing but noise is left."""
    part = residuals[mask]
    return float(part @ part) / len(part)
