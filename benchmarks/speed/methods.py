"""The methods to compare: each runs the train once with one setting and says how long that took."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import odeint, solve_ivp

import hdrive_mbs as hm
from benchmarks.speed.compiled_loops import compiled_dormand_prince, compiled_runge_kutta
from benchmarks.speed.right_sides import (
    BODIES,
    FloatArray,
    compiled_right_side,
    numba_or_none,
    numpy_right_side,
    python_right_side,
)
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.simulation import run
from hdrive_mbs.errors import SimulationError


@dataclass(frozen=True)
class Run:
    """One run: CPU seconds of the integration, the solver's own times, (8, n) states."""

    seconds: float
    times: FloatArray
    states: FloatArray


@dataclass(frozen=True)
class Method:
    """A method with its ladder of settings (relative tolerances or steps [s]), coarse to fine."""

    name: str
    ladder: tuple[float, ...]
    run: Callable[[float], Run]


TOLERANCES = (1e-4, 1e-6, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9, 3e-10, 1e-10)
STEPS = (4e-5, 2e-5, 1e-5, 5e-6, 2.5e-6)


def methods(scene: hm.Scene, duration: float) -> list[Method]:
    """All methods for one train; those that need numba only where it is installed."""
    found = [
        _engine("engine, symbolic: DormandPrince", scene, duration, "symbolic", _dormand_prince, TOLERANCES),
        _engine("engine, Python functions: DormandPrince", scene, duration, "python", _dormand_prince, TOLERANCES),
        _engine("engine, symbolic: RungeKutta4", scene, duration, "symbolic", lambda h: hm.RungeKutta4(step=h), STEPS),
        _engine("engine, symbolic: Trapezoidal", scene, duration, "symbolic", lambda h: hm.Trapezoidal(step=h), STEPS),
    ]
    plain = python_right_side(scene)
    found += _scipy("Python right side", plain, duration)
    found += _scipy("numpy right side", numpy_right_side(scene), duration)[:2]
    if numba_or_none() is not None:
        found += _scipy("compiled right side", compiled_right_side(scene), duration)
        fixed, adaptive = compiled_runge_kutta(scene), compiled_dormand_prince(scene)
        found += [
            Method("compiled loop: RungeKutta4", (*STEPS, 1.25e-6), lambda h: _timed(lambda: fixed(max(1, round(duration / h)), duration))),
            Method("compiled loop: DormandPrince", TOLERANCES, lambda tolerance: _timed(lambda: adaptive(tolerance, duration))),
        ]
    return found


def _dormand_prince(tolerance: float) -> hm.Solver:
    return hm.DormandPrince(relative_tolerance=tolerance, absolute_tolerance=1e-2 * tolerance)


def _engine(
    name: str, scene: hm.Scene, duration: float, lowering: str, solver: Callable[[float], hm.Solver], ladder: tuple[float, ...]
) -> Method:
    assembly = assemble(scene.network(), lowering=lowering)

    def once(setting: float) -> Run:
        try:
            raw = run(assembly, duration=duration, solver=solver(setting), angles={}, speeds={}, states={})
        except SimulationError:  # a step beyond the stability limit
            return Run(float("nan"), np.array([0.0]), np.full((8, 1), np.nan))
        states = np.array([*(raw.angles[body] for body in BODIES), *(raw.speeds[body] for body in BODIES)])
        return Run(raw.seconds, raw.times, states)

    return Method(name, ladder, once)


def _scipy(kind: str, right: Callable[..., Any], duration: float) -> list[Method]:
    start = np.zeros(8)
    grid = np.linspace(0.0, duration, 1001)

    def ivp(method: str) -> Callable[[float], Run]:
        def integrate(tolerance: float) -> tuple[FloatArray, FloatArray]:
            found = solve_ivp(right, (0.0, duration), start, method=method, rtol=tolerance, atol=1e-2 * tolerance)
            return found.t, found.y

        return lambda tolerance: _timed(lambda: integrate(tolerance))

    def old(tolerance: float) -> tuple[FloatArray, FloatArray]:
        return grid, odeint(right, start, grid, rtol=tolerance, atol=1e-2 * tolerance, tfirst=True, mxstep=1_000_000).T

    return [
        Method(f"scipy LSODA (solve_ivp), {kind}", TOLERANCES, ivp("LSODA")),
        Method(f"scipy LSODA (odeint), {kind}", TOLERANCES, lambda tolerance: _timed(lambda: old(tolerance))),
        Method(f"scipy Radau, {kind}", TOLERANCES[:5], ivp("Radau")),
    ]


def _timed(integrate: Callable[[], tuple[FloatArray, FloatArray]]) -> Run:
    started = time.process_time()
    times, states = integrate()
    return Run(time.process_time() - started, times, states)
