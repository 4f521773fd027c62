"""How a search integrates rotor lines: in longer steps than the last fits, with the vibrations slowed that these cannot follow.

The step of a line with light rings is set by vibrations that its records do not show (compiled/slowed.py), and much of a search is
integration.  What it finds is fitted to all samples and verified with the line as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.slowed import Slowed, slowed_vibrations
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.locate.motion import as_run
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.step import ERROR, LONGEST, PARTS
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor

FloatArray = npt.NDArray[np.float64]

FOLLOWED = 2.2
"""Step times the angular frequency to which vibrations are slowed: 2.8 is where undamped ones grow, and a law may stiffen the line."""
CLOSE = ERROR / 3.0
"""Standard deviations of the noise (rms, worst column) that the longer step of a trial may cost: with a corner in a law it costs more than
with none.  In whole samples a blow on a line cost 0.07 of the nominal one, and with a clearance in a bearing 0.6 and 0.9 in two
accelerations (c17 of our own thirty-second rotor set, labels open)."""
MOVED = 1.0
"""Standard deviations by which all parameters are moved for a second and a third comparison."""
EVERY = 8
"""Samples from one to the next that are compared."""


@dataclass(frozen=True)
class Pace:
    """steps : of the integration in each trial [s];  slowed : vibrations"""

    steps: tuple[float, ...]
    slowed: tuple[Slowed, ...] = ()


def pace_of(trials: Sequence[Trial], factors: Sequence[Factor], step: float) -> Pace:
    """In each trial the longest step of a whole part of the sample time whose nominal runs, and those with all parameters a standard
    deviation up or down, differ by less than CLOSE from runs with the line as it is; that step in all of them where no longer one does.

    step : of the line as it is [s]
    """
    hypothesis = Hypothesis(factors=tuple(factors))
    points = [np.full(hypothesis.size, size) for size in (0.0, MOVED, -MOVED)]
    sample = float(min(trial.every for trial in trials))
    steps = [sample / parts for parts in PARTS if 1.01 * step < sample / parts <= LONGEST]
    exact: list[FloatArray | None] = []
    for longest in steps:
        slowed = _slowed(trials, hypothesis, FOLLOWED / longest)
        if not slowed:
            break
        exact = exact or Simulator(trials, step, EVERY).residuals(hypothesis, points)
        if any(item is None for item in exact):
            break
        chosen: dict[int, float] = {}
        for tried in [item for item in (*steps, step) if item <= longest]:
            others = [k for k in range(len(trials)) if k not in chosen]
            simulator = Simulator(trials, tried, EVERY, again=False, slowed=slowed)
            skipped = frozenset(chosen)
            found = simulator.residuals(hypothesis, points, skipped, [item for item in exact if item is not None])
            chosen |= {k: tried for k in others if _is_close(simulator, k, found, exact)}
        if longest in chosen.values() and len(chosen) == len(trials):
            return Pace(tuple(chosen[k] for k in range(len(trials))), slowed)
    return Pace((step,) * len(trials))


def _slowed(trials: Sequence[Trial], hypothesis: Hypothesis, fastest: float) -> tuple[Slowed, ...]:
    """Those of the first line that moves across its axis, at rest."""
    networks = (as_run(trial, hypothesis, np.zeros(hypothesis.size)) for trial in trials)
    return next((slowed_vibrations(network, fastest) for network in networks if network.is_lateral), ())


def _is_close(simulator: Simulator, number: int, some: Sequence[FloatArray | None], others: Sequence[FloatArray | None]) -> bool:
    spans = [segment.span for segment in simulator.segments if segment.trial == number]
    for one, other in zip(some, others, strict=True):
        if one is None or other is None or any(np.sqrt(np.mean((one - other)[span] ** 2)) >= CLOSE for span in spans):
            return False
    return True
