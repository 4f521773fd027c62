"""Stretches in which a model leaves more than elsewhere, and what hangs together: a gap that comes and goes.

White samples r_i of one variance have the mean square s^2 in every stretch, within s^2 sqrt(2/n) of n samples, and of neighbours r_i, r_j
the mean product 0, within s^2/sqrt(n).  What a model lacks for a while is smooth over a few samples and raises both by its own mean
square.  Noise that is larger for a while raises the first alone, and a coarse encoder that turns slowly the second.  So a stretch
holds an excess where both lie more than BEYOND times their scatter above their medians over the column, the smaller of the two.  The
medians take out what is the same everywhere, of which the mean square tells: noise of another size or colour than stated, and a
misfit that lasts.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.simulator import Segment, Simulator

SAMPLES, FEWEST = 1024, 64
"""Samples of a stretch, and the fewest, of columns with less than STRETCHES times SAMPLES; shorter ones are not looked at."""
STRETCHES = 16
BEYOND = 4.0
"""Standard deviations: of 200 stretches of white noise one exceeds the second in one case of 160, and both next to never."""
EVEN = 0.005
"""Mean square in such stretches up to which what is left may be noise.  Of 24 nulls of the drive bench and 4 of the rotor bench none leaves
as much (benchmarks/withheld/evenness_drive.md, evenness_rotor.md); a brake that touched for two seconds left 0.018, c01 of our own
eighteenth drive set, opened, and had been taken for noise: it leaves 1.03 in all, less than CLEAN."""
MOST = 0.25
"""Of all samples: of more stretches than these no note tells."""
TOLD = 3
"""Stretches that are told, those with most of the excess."""


@dataclass(frozen=True)
class Patch:
    """A stretch of a column in which what is left hangs together.

    start, end : s;  samples : in it, those that count;  excess : sum over its samples of the squares beyond that of the rest
    """

    record: str
    column: str
    start: float
    end: float
    samples: int
    excess: float


def patches(simulator: Simulator, fitted: Fitted) -> tuple[Patch, ...]:
    """All of them, those next to each other joined, largest excess first."""
    found = [patch for segment in simulator.segments for patch in _of_column(simulator, fitted, segment)]
    return tuple(sorted(found, key=lambda patch: -patch.excess))


def unevenness(simulator: Simulator, found: Sequence[Patch]) -> float:
    """Mean square of all samples, in variances of the noise, that stands in these stretches."""
    return sum(patch.excess for patch in found) / int(np.count_nonzero(simulator.used))


def patch_words(simulator: Simulator, found: Sequence[Patch], of: str) -> tuple[str, ...]:
    """A note on where they lie, if they hold more than EVEN and are few: what is left most of the time is no matter of time.

    of : whose they are, such as 'the refitted nominal model'
    """
    share = unevenness(simulator, found)
    if share <= EVEN or sum(patch.samples for patch in found) > MOST * int(np.count_nonzero(simulator.used)):
        return ()
    told = [f"{item.column} of {item.record!r}, {item.start:.3g} s to {item.end:.3g} s" for item in found[:TOLD]]
    more = f", and {len(found) - TOLD} more" if len(found) > TOLD else ""
    return (
        f"What {of} leaves comes and goes: {share:.2g} of its mean square stands above the rest in {'; '.join(told)}{more}. "
        "Something acted there for a while that the model has not.",
    )


def _of_column(simulator: Simulator, fitted: Fitted, segment: Segment) -> list[Patch]:
    used = simulator.used[segment.span]
    left = np.where(used, fitted.residuals[segment.span], 0.0)
    size = min(SAMPLES, len(left) // STRETCHES)
    if size < FEWEST:
        return []
    number = len(left) // size
    whole = slice(0, number * size)
    products = np.append(left[1:] * left[:-1], 0.0)[whole].reshape(number, size).sum(axis=1)
    squares = (left[whole] ** 2).reshape(number, size).sum(axis=1)
    count = used[whole].reshape(number, size).sum(axis=1)
    full = count >= size // 2
    if np.count_nonzero(full) < STRETCHES // 2:
        return []
    counted = np.maximum(count, 1)
    products, squares = products / counted, squares / counted
    level = float(np.median(squares[full]))
    together, above = products - float(np.median(products[full])), squares - level
    stands = full & (together > BEYOND * level / math.sqrt(size)) & (above > BEYOND * level * math.sqrt(2.0 / size))
    excess = np.where(stands, np.minimum(together, above) * count, 0.0)
    trial = simulator.trials[segment.trial]
    times = trial.times[:: simulator.every]
    joined: list[Patch] = []
    for is_one, group in itertools.groupby(range(number), key=lambda k: bool(stands[k])):
        if is_one:
            at = list(group)
            start, end = float(times[at[0] * size]), float(times[(at[-1] + 1) * size - 1])
            joined.append(Patch(trial.name, segment.column, start, end, int(count[at].sum()), float(excess[at].sum())))
    return joined
