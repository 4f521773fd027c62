"""Expressions recorded from laws.

A law is written once, with ordinary arithmetic and numpy functions.  Called with numbers or
arrays it computes; called with :class:`Expression` arguments it records itself.  The engine
turns the record into a symbolic user function, the analyses differentiate it, and a law that
cannot be recorded (``if`` on an argument, ``math.sin``, ``float(x)``) raises
:class:`TraceError` instead of being frozen silently at one value.

numpy dispatches to expressions by its ``__array_ufunc__`` and ``__array_function__`` protocols
(NEP 13, NEP 18), so ``np.sin``, ``np.where``, ``np.clip``, ``np.interp`` work unchanged.
"""

from __future__ import annotations

from hdrive_mbs.expression import numpy_functions
from hdrive_mbs.expression.calculus import derivative, gradient
from hdrive_mbs.expression.node import Expression, TraceError, Value, constant, is_constant, variable
from hdrive_mbs.expression.pieces import Pieces, unfold
from hdrive_mbs.expression.python_code import scalar_function, scalar_source
from hdrive_mbs.expression.use import evaluate, in_order, record, trace, variables

__all__ = [
    "Expression",
    "Pieces",
    "TraceError",
    "Value",
    "constant",
    "derivative",
    "evaluate",
    "gradient",
    "in_order",
    "is_constant",
    "numpy_functions",
    "record",
    "scalar_function",
    "scalar_source",
    "trace",
    "unfold",
    "variable",
    "variables",
]
