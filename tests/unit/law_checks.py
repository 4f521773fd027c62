"""What the unit tests ask of every law, whatever it describes."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.simulation import RawRun, run
from hdrive_mbs.engine.solvers import DormandPrince
from hdrive_mbs.expression import Expression, evaluate, gradient, record, variable

ROUNDING = 1e-12
"""A recorded law may order its operations differently: some tens of roundings of 1.1e-16, relative."""


def assert_records_itself(law: Callable[..., Any], *arguments: np.ndarray) -> None:
    """The law called with expressions gives an expression of the same values as called with arrays."""
    names = [f"x{i}" for i in range(len(arguments))]
    expression = record(law(*(variable(name) for name in names)))
    assert isinstance(expression, Expression)
    recorded = evaluate(expression, dict(zip(names, arguments, strict=True))) + 0.0 * arguments[0]
    plain = law(*arguments) + 0.0 * arguments[0]
    scale = np.max(np.abs(plain))
    assert scale > 0.0
    np.testing.assert_allclose(recorded, plain, rtol=0.0, atol=ROUNDING * scale)


def assert_derivative_is_exact(
    function: Callable[[Any], Any], points: np.ndarray, step: float, kinks: tuple[float, ...], error: float
) -> None:
    """The derivative of the record equals central differences at points further than a step from a kink.

    error : bound of the difference quotient's own error, step^2 max|f'''|/6 + 1e-16 max|f|/step with room
    """
    away = np.all([np.abs(points - kink) > 2.0 * step for kink in kinks], axis=0) if kinks else np.full(points.shape, True)
    chosen = points[away]
    assert len(chosen) > 0.8 * len(points)
    exact = gradient(function)(chosen) + 0.0 * chosen
    quotient = (function(chosen + step) - function(chosen - step)) / (2.0 * step)
    np.testing.assert_allclose(exact, quotient, rtol=0.0, atol=error)


def run_on_engine(scene: hm.Scene, duration: float, tolerance: float = 1e-6) -> tuple[RawRun, dict[str, str]]:
    """A run, and how each element entered the engine; a Python callback is a failure."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", hm.LoweringWarning)
        assembly = assemble(scene.network())
    result = run(
        assembly,
        duration=duration,
        solver=DormandPrince(relative_tolerance=tolerance, absolute_tolerance=1e-2 * tolerance),
        angles={},
        speeds={},
        states={},
    )
    how = {item.element: item.how for item in assembly.lowered}
    assert set(how.values()) <= {"native", "symbolic"}, how
    return result, how
