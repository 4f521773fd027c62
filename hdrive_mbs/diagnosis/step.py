"""The step of the compiled integration: long enough to be quick, short enough to lie below the noise."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE
from hdrive_mbs.errors import AnalysisError

ERROR = 0.15
"""Standard deviations of the noise (rms, worst column) that the step may cost."""
HALVINGS = 7
LONGEST = 2.5 / FASTEST_RATE
"""Step [s] that is stable for effects with states of their own, which follow rates up to FASTEST_RATE."""


def suitable_step(trials: Sequence[Trial], factors: Sequence[Factor]) -> float:
    """Longest step [s] up to LONGEST, a whole part of the sample time, whose nominal runs differ little from those with half of it.

    Raises AnalysisError where no step down to 1/128 of a sample gives a finite run.
    """
    hypothesis = Hypothesis(factors=tuple(factors))
    every = float(min(trial.every for trial in trials))
    before = None
    for k in range(HALVINGS + 1):
        step = every / 2**k
        simulator = Simulator(trials, step, 8)
        residuals = simulator.residuals(hypothesis, [np.zeros(hypothesis.size)])[0]
        if residuals is not None and before is not None and 2.0 * step <= LONGEST:
            worst = max(float(np.sqrt(np.mean((residuals - before)[segment.span] ** 2))) for segment in simulator.segments)
            if worst < ERROR:
                return float(2.0 * step)
        before = residuals
    if before is None:
        raise AnalysisError(
            f"The nominal scene cannot be simulated through the records with steps down to {every / 2**HALVINGS:.3g} s; look at its start"
            " values and inputs, or give a shorter step."
        )
    return float(every / 2**HALVINGS)
