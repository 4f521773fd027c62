"""Forces that grow with a power of the speed."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.expression import Value

SMALLEST = 1e-6
"""Share of the reference speed below which a force stays what it is, so that its slope is finite at standstill."""


def grown(speed: Value, reference: float, exponent: float) -> Value:
    """(|w|/w_0)^n; 1 for n = 0."""
    return 1.0 if exponent == 0.0 else np.maximum(np.abs(speed) / reference, SMALLEST) ** exponent
