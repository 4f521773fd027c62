"""Points from which everything is looked at: a fitted model, and the same with its parameters held where they are likely.

What is missing bends the fitted parameters, to the end of what they may be where it is strong; from there the cause may
not show.  From the data sheet's own values the step is too long for a linear one where a resonance is sharp.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.differences import believed, jacobian
from hdrive_mbs.diagnosis.fit import Fitted, fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.screening import Screen
from hdrive_mbs.diagnosis.simulator import Simulator

FloatArray = npt.NDArray[np.float64]

LIKELY = 2.0
"""Prior standard deviations that a parameter may be off while it is held."""
STEPS, SHARE = 12, 1e-2
"""Of that fit: most steps, and relative change of the cost that ends it."""


def screen_from(simulator: Simulator, model: Fitted) -> Screen:
    """Looks at candidates from a model at a point, with its Jacobian there."""
    unseen = believed(simulator, model.hypothesis)
    return Screen(simulator, model, jacobian(simulator, model.hypothesis, model.z, model.residuals, unseen=unseen))


def held(simulator: Simulator, model: Fitted) -> Fitted:
    """The model with its parameters within LIKELY deviations of the data sheet, fitted from there, and its causes as they were found.

    Where this cannot be run, the model as it is.
    """
    start = as_known(model.hypothesis, model.z)
    residuals = simulator.residuals(model.hypothesis, [start])[0]
    if residuals is None:
        return model
    factors = tuple(replace(item, most=LIKELY) for item in model.hypothesis.factors)
    found = fit(simulator, replace(model.hypothesis, factors=factors), start, steps=STEPS, share=SHARE, begin=residuals)
    return replace(found, hypothesis=model.hypothesis)


def is_bent(model: Fitted) -> bool:
    """Whether a parameter that is not under suspicion is further off than is likely."""
    hypothesis = model.hypothesis
    parameters = zip(hypothesis.factors, hypothesis.nominal_part(model.z), strict=True)
    return any(abs(z) > LIKELY for item, z in parameters if item.name not in hypothesis.loose)


def as_known(hypothesis: Hypothesis, z: FloatArray) -> FloatArray:
    """Coordinates with the parameters that are not under suspicion at the values of the data sheet."""
    start = z.copy()
    start[: hypothesis.nominal_size] = [z[k] if item.name in hypothesis.loose else 0.0 for k, item in enumerate(hypothesis.factors)]
    return start
