"""Points from which everything is looked at: a fitted model, and the same with the values of the data sheet."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.fit import Fitted, fit, jacobian
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.screening import Screen
from hdrive_mbs.diagnosis.simulator import Simulator

FloatArray = npt.NDArray[np.float64]


def screen_from(simulator: Simulator, model: Fitted) -> Screen:
    """Looks at candidates from a model at a point, with its Jacobian there."""
    return Screen(simulator, model, jacobian(simulator, model.hypothesis, model.z, model.residuals))


def reset(simulator: Simulator, model: Fitted) -> Fitted:
    """The model with its parameters where the data sheet has them, and its causes as they were found; not fitted.

    Where this cannot be run, the model as it is.
    """
    start = as_known(model.hypothesis, model.z)
    residuals = simulator.residuals(model.hypothesis, [start])[0]
    if residuals is None:
        return model
    return fit(simulator, model.hypothesis, start, steps=0, begin=residuals)


def as_known(hypothesis: Hypothesis, z: FloatArray) -> FloatArray:
    """Coordinates with the parameters that are not under suspicion at the values of the data sheet."""
    start = z.copy()
    start[: hypothesis.nominal_size] = [z[k] if item.name in hypothesis.loose else 0.0 for k, item in enumerate(hypothesis.factors)]
    return start
