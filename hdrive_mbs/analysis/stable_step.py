"""Whether the constant step of an explicit solver is stable: what grows of itself is no motion of the scene."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.step_limit import stable_step
from hdrive_mbs.engine.assembly import Assembly
from hdrive_mbs.engine.linearisation import linearise
from hdrive_mbs.engine.simulation import RawRun
from hdrive_mbs.engine.solvers import RungeKutta4, Solver
from hdrive_mbs.errors import SimulationError

MOMENTS = 9
"""Moments of a run, evenly spaced, at which its step is looked at."""

OSCILLATING = 1e-6
"""Share of an imaginary part from which an eigenvalue is a vibration (differences leave 1e-8)."""

WAY_OUT = "Take a shorter step, the adaptive DormandPrince() or, for stiff shafts and damping, an implicit solver (Trapezoidal)."


@dataclass(frozen=True)
class _Limit:
    """The longest stable step [s], and what sets it in words."""

    step: float
    reason: str


def check_start(assembly: Assembly, solver: Solver, duration: float, starts: Mapping[str, Mapping[str, float]]) -> None:
    """Raise SimulationError where a vibration about the start would grow of itself with this step.

    Decays alone are left to ``check_run``: friction at rest is stiff, and a moment later it is not.
    """
    if isinstance(solver, RungeKutta4) and solver.step <= duration:
        limit = _limit(assembly, starts["angles"], starts["speeds"], starts["states"], vibrations=True)
        if solver.step > limit.step:
            raise SimulationError(_text(solver, limit, "at the start"))


def check_run(assembly: Assembly, solver: Solver, raw: RawRun) -> None:
    """Raise SimulationError where the step was not stable in most of the moments of the run that are looked at."""
    if not isinstance(solver, RungeKutta4) or len(raw.times) < 2:
        return
    beyond: list[tuple[float, _Limit]] = []
    for k in np.linspace(0, len(raw.times) - 1, MOMENTS).astype(int):
        groups = (raw.angles, raw.speeds, raw.states)
        angles, speeds, states = ({name: float(values[k]) for name, values in group.items()} for group in groups)
        limit = _limit(assembly, angles, speeds, states)
        if solver.step > limit.step:
            beyond.append((float(raw.times[k]), limit))
    if len(beyond) > MOMENTS // 2:
        time, limit = min(beyond, key=lambda item: item[1].step)
        raise SimulationError(_text(solver, limit, f"at t = {time:.4g} s"))


def _text(solver: RungeKutta4, limit: _Limit, when: str) -> str:
    return (
        f"{type(solver).__name__}.step = {solver.step:g} s is beyond its limit of stability, {limit.step:.3g} s for {limit.reason} {when}: "
        f"what comes out grows of itself. {WAY_OUT}"
    )


def _limit(
    assembly: Assembly, angles: Mapping[str, float], speeds: Mapping[str, float], states: Mapping[str, float], *, vibrations: bool = False
) -> _Limit:
    """The limit at a state, of vibrations alone or of decays too; infinite where the rates are not finite (the run says that)."""
    try:
        matrix = linearise(assembly, angles=angles, speeds=speeds, states=states).matrix
    except Exception:  # whatever a law raises, the run raises it again with its place
        return _Limit(math.inf, "")
    if not np.isfinite(matrix).all():
        return _Limit(math.inf, "")
    values, shapes = np.linalg.eig(matrix)
    values = np.asarray(values, complex)
    if vibrations:
        kept = np.abs(values.imag) > OSCILLATING * np.abs(values)
        values, shapes = values[kept], shapes[:, kept]
    if not len(values):
        return _Limit(math.inf, "")
    fastest = int(np.argmax(np.abs(values)))
    return _Limit(stable_step(values), _named(assembly, complex(values[fastest]), np.abs(shapes[:, fastest])))


def _named(assembly: Assembly, value: complex, shape: npt.NDArray[np.float64]) -> str:
    """The motion of an eigenvalue in words: the coordinate whose speed, or the state that, is the largest in it."""
    n = len(assembly.bodies)
    name = (*assembly.bodies, *assembly.states)[int(np.argmax(shape[n:]))]
    if abs(value.imag) > OSCILLATING * abs(value):
        return f"the vibration of {name} at {abs(value):.4g} rad/s"
    return f"the decay of {name} with {abs(value):.4g} 1/s"
