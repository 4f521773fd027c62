"""How much the records speak for a hypothesis: its evidence by Laplace's method.

log Z = -misfit + log p(z) + (n/2) log 2 pi - log det(J^T W J + P)/2

with n search coordinates, the prior density p and P the curvature of the prior (for a strength, whose logarithm is
uniform, 1/z^2).  Samples that no fit saw add their own misfit at these parameters where a verdict is due (tasks.proven):
Z of both would be p(seen) p(unseen | seen), of which the second is taken at the most probable point.  The misfit takes the
scale of the noise as unknown wherever the model is wrong (robust.py).
Source: MacKay, Information Theory, Inference and Learning Algorithms, 27.
"""

from __future__ import annotations

import math

import numpy as np

from hdrive_mbs.diagnosis.fit import Fitted


def log_evidence(fitted: Fitted) -> float:
    """Logarithm of the evidence, up to a constant that all hypotheses on the same records share."""
    hypothesis, z = fitted.hypothesis, fitted.z
    sign, logdet = np.linalg.slogdet(fitted.curvature + np.diag(hypothesis.curvatures(z)))
    if sign <= 0.0:
        return -math.inf
    misfit = fitted.cost - hypothesis.prior_cost(z)
    return -misfit + hypothesis.log_prior(z) + 0.5 * len(z) * math.log(2.0 * math.pi) - 0.5 * float(logdet)
