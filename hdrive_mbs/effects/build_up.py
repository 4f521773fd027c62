"""Dahl's way of building up a force: what is left to the limit, to a power that keeps its sign."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.expression import Value

SMALLEST = 1e-9
"""Part of the limit below which the power stays what it is, so that its slope is finite at the limit itself."""


def secant(left: Value, exponent: float) -> Value:
    """|u|^(n-1) of what is left, u: times u it is the build-up |u|^n sign(u), times n the slope of that."""
    return 1.0 if exponent == 1.0 else np.maximum(np.abs(left), SMALLEST) ** (exponent - 1.0)
