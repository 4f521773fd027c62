"""The step of the compiled integration: long enough to be quick, short enough to lie below the noise."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.errors import AnalysisError

FloatArray = npt.NDArray[np.float64]

ERROR = 0.15
"""Standard deviations of the noise (rms, worst column) that the step may cost."""
PARTS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64)
"""Steps in a sample that are tried.  Thirds too: what limits the step of a rotor line is not accuracy but where its fastest vibration,
the tilting of a light ring, grows of itself, and there a third of a sample may do where a half does not."""
LONGEST = 2.5 / FASTEST_RATE
"""Step [s] that is stable for effects with states of their own, which follow rates up to FASTEST_RATE."""


def suitable_step(trials: Sequence[Trial], factors: Sequence[Factor]) -> float:
    """Longest step [s] up to LONGEST, a whole part of the sample time, whose nominal runs differ little from those with half of it;
    1/128 of a sample where none of them does.

    Raises AnalysisError where no step down to 1/128 of a sample gives a finite run.
    """
    hypothesis = Hypothesis(factors=tuple(factors))
    every = float(min(trial.every for trial in trials))

    def residuals(parts: int, divided: int) -> tuple[Simulator, FloatArray | None]:
        simulator = Simulator(trials, every / parts, 8, parts=divided, again=False)
        return simulator, simulator.residuals(hypothesis, [np.zeros(hypothesis.size)])[0]

    for parts in PARTS:
        if every / parts > LONGEST:
            continue
        simulator, whole = residuals(parts, 1)
        sharper = None if whole is None else residuals(parts, 2)[1]
        if whole is None or sharper is None:
            continue
        if max(float(np.sqrt(np.mean((whole - sharper)[segment.span] ** 2))) for segment in simulator.segments) < ERROR:
            return every / parts
    finest = 2 * PARTS[-1]
    if residuals(finest, 1)[1] is None:
        raise AnalysisError(
            f"The nominal scene cannot be simulated through the records with steps down to {every / finest:.3g} s; look at its start"
            " values and inputs, or give a shorter step."
        )
    return every / finest
