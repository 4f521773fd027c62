"""Fits of suspects to do, and what has come of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.evidence import log_evidence
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hops import settled
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import Label, Suspect
from hdrive_mbs.errors import AnalysisError

FloatArray = npt.NDArray[np.float64]

FIRST = 2
"""Steps after which a fit against another one is given up where it is hopeless."""

FINE, CONVERGED = 1e-4, 25
"""Relative change of the cost that ends a fit, and steps that one to the end may take."""
NEAR = 3.0
"""Mean square up to which hops out of hollows help, and up to which it is worth a fit of the nominal model as sharp as that of the
causes: farther away they lead nowhere."""
RIVAL = 25.0
"""Log-likelihood behind the best within which another label is fitted as far as it: what so little tells apart has to be fitted alike."""
HOPELESS = 10.0
"""Times the mean square of a law that is near, above which others are not fitted to the end."""


@dataclass(frozen=True, eq=False)
class Found:
    """A fitted suspect with the logarithm of its evidence over that of the model it adds to; see ``scored`` and ``proven``."""

    suspect: Suspect
    fitted: Fitted
    log_odds: float = 0.0


@dataclass(frozen=True, eq=False)
class Task:
    """A fit to do: where it begins, how far it may go, and hops at its end.  ``done`` is set where it is fitted already.

    leading : mean square of what it is tried against, if anything: given up after the first steps where it is hopeless beside that
    beat : cost of what it is tried against, if anything: given up where its steps do not lead there
    patient : whether it goes on where its steps gain little, see ``fit``
    """

    hypothesis: Hypothesis
    z: FloatArray
    residuals: FloatArray | None
    steps: int
    share: float
    done: Fitted | None = None
    hops: int = 0
    leading: float | None = None
    beat: float | None = None
    patient: bool = False


def run_task(simulator: Simulator, task: Task) -> Fitted | None:
    """Do it; None where it cannot be run from where it begins."""
    first = task.steps if task.leading is None else min(FIRST, task.steps)
    on = partial(fit, simulator, task.hypothesis, share=task.share, beat=task.beat, patient=task.patient)
    try:
        fitted = task.done or on(task.z, steps=first, begin=task.residuals)
        if task.leading is not None and not fitted.converged and not is_hopeless(fitted.chi_fit, task.leading):
            fitted = on(fitted.z, steps=task.steps - first, begin=fitted.residuals)
    except AnalysisError:
        return None
    hops = task.hops if fitted.chi_fit < NEAR and (task.beat is None or fitted.cost <= task.beat) else 0
    return settled(simulator, fitted, hops) if hops else fitted


def rivalling(best: Fitted) -> float:
    """The cost that a rival of the best fit has to come down to."""
    return best.cost + RIVAL


def is_hopeless(left: float, leading: float) -> bool:
    """Whether a mean square is so far above that of a law which is near that it will not come down to it."""
    return leading < NEAR and left > HOPELESS * leading


def further(
    fitted: Fitted, steps: int = CONVERGED, share: float = FINE, hops: int = 0, beat: float | None = None, patient: bool = False
) -> Task:
    """To fit on from where a fit stands; with patience also where it has converged without."""
    done = fitted.converged and fitted.patient >= patient
    return Task(fitted.hypothesis, fitted.z, fitted.residuals, steps, share, fitted if done else None, hops, beat=beat, patient=patient)


def scored(found: Found, base: Fitted) -> Found:
    """With its log odds against the model it adds to."""
    return Found(found.suspect, found.fitted, log_evidence(found.fitted) - log_evidence(base))


def proven(found: Found, base: Fitted) -> Found:
    """With its log odds against the model it adds to, from the samples that its fit saw and from how it tells those that no fit saw."""
    told = base.misfit_held - found.fitted.misfit_held
    return Found(found.suspect, found.fitted, log_evidence(found.fitted) - log_evidence(base) + told)


def those_that_ran(suspects_: Sequence[Suspect], fits: Sequence[Fitted | None]) -> list[Found]:
    """Suspects with their fits, without those that could not be run."""
    return [Found(suspect, fitted) for suspect, fitted in zip(suspects_, fits, strict=True) if fitted is not None]


def cheapest(found: Sequence[Found]) -> list[Found]:
    """The best fit of each law at each place, best first."""
    best: dict[tuple[Label, str], Found] = {}
    for item in sorted(found, key=lambda item: item.fitted.cost):
        best.setdefault((item.suspect.label, item.suspect.law), item)
    return list(best.values())
