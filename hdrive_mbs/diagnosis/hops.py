"""Out of small hollows: from where a fit stopped, along the weakly determined directions, and down again.

Where two stiffnesses in series are known only through their sum, say, the misfit over their difference is a wide bowl
with a small wave on it, and a fit stops in any trough.  Differences as long as such a direction bears see the bowl and
not the wave; the step that they propose is taken although the wave is in the way, and a new fit starts there.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from hdrive_mbs.diagnosis.bounded import bounded_step
from hdrive_mbs.diagnosis.fit import Fitted, fit, jacobian
from hdrive_mbs.diagnosis.simulator import Simulator

PARTS = (1.0, 0.4)
"""Of the proposed step from which new fits start."""
DOWN = 5
"""Steps of a new fit before it is judged."""
WORTH = 1.0
"""Gain of the cost (natural logarithm of the likelihood) that makes a hop count."""


def settled(simulator: Simulator, fitted: Fitted, hops: int = 3) -> Fitted:
    """The fit, or a better one that lies within some hops."""
    best = fitted
    for _ in range(hops if len(fitted.z) else 0):
        proposed = _bowl(simulator, best)
        tried = [best]
        for part in PARTS:
            start = best.hypothesis.clipped(best.z + part * proposed)
            residuals = simulator.residuals(best.hypothesis, [start])[0]
            if residuals is not None:
                tried.append(fit(simulator, best.hypothesis, start, steps=DOWN, share=1e-6, begin=residuals))
        new = min(tried, key=lambda item: item.cost)
        gain = best.cost - new.cost
        if gain <= 0.0:
            break
        best = dataclasses.replace(new, converged=True)
        if gain < WORTH:
            break
    return best


def _bowl(simulator: Simulator, fitted: Fitted) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """The Gauss-Newton step by long differences."""
    hypothesis, z = fitted.hypothesis, fitted.z
    mask = simulator.fit
    part = fitted.residuals[mask]
    weights = simulator.blocks.weights(part)
    metric = fitted.curvature + np.diag(hypothesis.curvatures(z))
    move = np.zeros_like(z)
    for _ in range(2):  # the metric of the first differences is that of the wave
        columns = jacobian(simulator, hypothesis, z, fitted.residuals, metric)
        weighted = columns * weights[:, None]
        curvature = weighted.T @ columns
        metric = curvature + np.diag(hypothesis.curvatures(z))
        normal = curvature + np.diag(hypothesis.precisions)
        move = bounded_step(hypothesis, z, normal, weighted.T @ part + hypothesis.precisions * z)
    reaches = hypothesis.reaches(z)
    return np.asarray(np.clip(move, -reaches, reaches))
