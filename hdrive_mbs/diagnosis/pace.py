"""How a search integrates rotor lines: in longer steps than the last fits, with the vibrations slowed that these cannot follow.

The step of a line with light rings is set by vibrations that hardly show in its records (compiled/slowed.py), and much of a search is
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
accelerations (c17 of our own thirty-second rotor set, labels open; by a script that is not kept)."""
MOVED = 1.0
"""Standard deviations by which all parameters are moved for a second and a third comparison."""
EVERY = 8
"""Samples from one to the next that are compared."""


@dataclass(frozen=True)
class Pace:
    """steps : of the integration in each trial [s];  slowed : vibrations;  shortest : step of what grows at these [s]"""

    steps: tuple[float, ...]
    slowed: tuple[Slowed, ...] = ()
    shortest: float | None = None


def pace_of(trials: Sequence[Trial], factors: Sequence[Factor], step: float) -> Pace:
    """In each trial the longest step of a whole part of the sample time whose nominal runs, and those with all parameters a standard
    deviation up or down, differ by less than CLOSE from runs with the line as it is; that step in all of them where no longer one does.

    step : of the line as it is [s]
    """
    hypothesis = Hypothesis(factors=tuple(factors))
    points = [np.full(hypothesis.size, size) for size in (0.0, MOVED, -MOVED)]
    sample = float(min(trial.every for trial in trials))
    steps = [sample / parts for parts in PARTS if 1.01 * step < sample / parts <= LONGEST]
    exact: list[FloatArray] = []
    for longest in steps:
        slowed = _slowed(trials, hypothesis, FOLLOWED / longest)
        if not slowed:
            break
        exact = exact or [item for item in Simulator(trials, step, EVERY).residuals(hypothesis, points) if item is not None]
        if len(exact) < len(points):
            break
        chosen: dict[int, float] = {}
        for tried in [item for item in (*steps, step) if item <= longest]:
            simulator = Simulator(trials, tried, EVERY, again=False, slowed=slowed)
            others = (k for k in range(len(trials)) if k not in chosen)
            chosen |= {k: tried for k in others if _is_close(simulator, k, hypothesis, points, exact)}
            if not chosen:  # no trial takes the longest one
                break
        if len(chosen) == len(trials):
            return Pace(tuple(chosen[k] for k in range(len(trials))), slowed, 0.5 * step)
    return Pace((step,) * len(trials))


def _slowed(trials: Sequence[Trial], hypothesis: Hypothesis, fastest: float) -> tuple[Slowed, ...]:
    """Those at rest of the line that moves in most ways across its axis."""
    networks = [as_run(trial, hypothesis, np.zeros(hypothesis.size)) for trial in trials]
    return slowed_vibrations(max(networks, key=lambda network: sum(body.lateral for body in network.bodies)), fastest)


def _is_close(simulator: Simulator, number: int, hypothesis: Hypothesis, points: Sequence[FloatArray], exact: Sequence[FloatArray]) -> bool:
    """Whether the runs of one trial are those of the line as it is."""
    spans = [segment.span for segment in simulator.segments if segment.trial == number]
    others = frozenset(range(len(simulator.trials))) - {number}
    for one, other in zip(simulator.residuals(hypothesis, points, others, exact), exact, strict=True):
        if one is None or not all(np.sqrt(np.mean((one - other)[span] ** 2)) < CLOSE for span in spans):
            return False
    return True
