"""Parameters that may be far off, tried all along their range: beside a sharp resonance that sits elsewhere a step leads nowhere.

Where a mass is a few percent off, the resonances of model and record lie apart by more than their widths.  The misfit then is flat
but for a dip as narrow as a resonance is, and a fit that begins outside stops in some hollow, with other parameters bent.  Runs at
points across the range, all else as the data sheet says, see the dip.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hdrive_mbs.diagnosis.screening import Look
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Suspect
from hdrive_mbs.diagnosis.tasks import FINE, Task

POINTS, WIDE = 32, 2.0
"""Across the range, and the standard deviations of a suspected parameter to both sides.  Of a mass that is known to 0.6 % neighbours lie
0.8 % apart, 0.4 % of a frequency: the width of a resonance that is damped by 0.4 % of the critical damping."""
FITTED, STEPS = 3, 6
"""Parameters that are fitted from the best point, and joint steps that they get."""


def worth_a_scan(everything: Sequence[Suspect]) -> list[Suspect]:
    """Parameters among suspects."""
    return [suspect for suspect in everything if suspect.law == PARAMETER]


def scan(simulator: Simulator, suspect: Suspect) -> Look | None:
    """The best of all points along each of the suspected parameters by itself; None where none can be run."""
    hypothesis, best = suspect.first[0], None
    sheet = hypothesis.start()
    for k, item in enumerate(hypothesis.factors):
        if item.name not in hypothesis.loose:
            continue
        points = []
        for value in np.linspace(-WIDE, WIDE, POINTS):
            point = sheet.copy()
            point[k] = value
            points.append(hypothesis.clipped(point))
        for point, residuals in zip(points, simulator.residuals(hypothesis, points), strict=True):
            if residuals is not None:
                cost = simulator.blocks.cost(residuals[simulator.fit]) + hypothesis.prior_cost(point)
                if best is None or cost < best.cost:
                    best = Look(hypothesis, point, cost, residuals, hypothesis)
    return best


def fits_from(scanned: Sequence[tuple[Suspect, Look | None]], beat: float | None = None) -> list[tuple[Suspect, Task]]:
    """Fits from the best points, of the parameters whose points are the best;  beat : a cost that they have to come down to."""
    there = sorted(((suspect, look) for suspect, look in scanned if look is not None), key=lambda pair: pair[1].cost)
    return [(suspect, Task(look.hypothesis, look.z, look.residuals, STEPS, FINE, beat=beat)) for suspect, look in there[:FITTED]]
