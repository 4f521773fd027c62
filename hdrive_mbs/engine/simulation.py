"""One run of an assembly: progress, cancel, and the checks that exudyn does not make."""

from __future__ import annotations

import math
import signal
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import exudyn as exu
import numpy as np
import numpy.typing as npt

from hdrive_mbs.engine.assembly import Assembly
from hdrive_mbs.engine.solvers import Implicit, Solver
from hdrive_mbs.errors import SimulationError

FloatArray = npt.NDArray[np.float64]
Progress = Callable[[float], None]
"""Called now and then with the simulated time reached [s]."""

DENSE_LIMIT = 60
"""Coordinates up to which the dense solver of exudyn is the faster one."""

STUCK = 1e-9
"""A run that gets on by less than this share of its duration within 4096 steps is given up."""


@dataclass(frozen=True)
class RawRun:
    """What came out of the engine: forward coordinates on the solver's own times.

    accelerations : where coordinates are coupled by their masses (rotor lines), else empty
    """

    times: FloatArray
    angles: Mapping[str, FloatArray]
    speeds: Mapping[str, FloatArray]
    states: Mapping[str, FloatArray]
    status: str
    steps: int
    rejected: int
    seconds: float
    accelerations: Mapping[str, FloatArray] = field(default_factory=dict)


@contextmanager
def _interrupt_flag() -> Iterator[threading.Event]:
    """An event that Ctrl-C sets while the context is active (main thread only)."""
    flag = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield flag
        return
    previous = signal.signal(signal.SIGINT, lambda *_: flag.set())
    try:
        yield flag
    finally:
        signal.signal(signal.SIGINT, previous)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep exudyn from printing to the console: what matters comes back as status or error."""
    before = exu.config.printToConsole
    exu.config.printToConsole = False
    try:
        yield
    finally:
        exu.config.printToConsole = before


def run(
    assembly: Assembly,
    *,
    duration: float,
    solver: Solver,
    angles: Mapping[str, float],
    speeds: Mapping[str, float],
    states: Mapping[str, float],
    sample_step: float = 0.0,
    progress: Progress | None = None,
    cancel: threading.Event | None = None,
) -> RawRun:
    """Integrate from t = 0 to duration.

    sample_step : record no more often than this [s]; 0 records every step
    cancel : an event that stops the run from another thread; Ctrl-C does the same

    Raises SimulationError when the run diverged or stopped early; a cancelled run returns what
    it has with status "cancelled".
    """
    mbs = assembly.mbs
    assembly.set_initial(angles, speeds, states)
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = sample_step
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.startTime = 0.0
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.explicit.computeEndOfStepAccelerations = assembly.network.is_coupled
    if len(assembly.bodies) > DENSE_LIMIT:
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    solver_type = solver.configure(settings, duration)
    error = ""
    assembly.failures.clear()
    with _interrupt_flag() as interrupted, _quiet():
        stuck = _watch(mbs, duration, getattr(solver, "max_steps", math.inf), interrupted, cancel, progress)
        started = time.process_time()
        try:
            mbs.SolveDynamic(settings, solverType=solver_type, showHints=False, showCausingItems=False)
        except Exception as failure:  # exudyn raises its own and pybind errors; all end the run the same way
            error = str(failure).strip().partition("\n")[0] or type(failure).__name__
        seconds = time.process_time() - started
    if stuck:
        error = stuck[0]
    elif assembly.failures:
        error = assembly.failures[0]
    cancelled = interrupted.is_set() or (cancel is not None and cancel.is_set())
    return _collect(assembly, solver, duration, error, cancelled, seconds)


NOTHING = "the step shrinks to nothing, so there the solution grows without bound or a law gives no finite number"
CHATTER = (
    "a law that jumps (JumpTorqueStiffness under a load inside its gap torque, for one) makes the solver chatter. Take a "
    "continuous law, looser tolerances or a fixed step, or raise max_steps if the run is just long"
)

ADVICE = (
    "Use a smaller step or tighter tolerances, an implicit solver (Trapezoidal) for stiff shafts and damping, "
    "or look at the law that jumps."
)
IMPLICIT_ADVICE = "Use a shorter step, or look at the law that jumps or has a corner."


class _StopError(Exception):
    """Ends a run from inside the solver."""


def _watch(
    mbs: Any,
    duration: float,
    max_steps: float,
    interrupted: threading.Event,
    cancel: threading.Event | None,
    progress: Progress | None,
) -> list[str]:
    """Look at the cancel flags every 32 steps and report at most ten times a second.

    Returns a list that holds the reason when the run is given up: where values stop being finite
    DOPRI5 repeats its step for ever, and then only an exception stops it (the False of a cancel does not).
    """
    clock, given_up = time.monotonic, list[str]()
    # t is the end of the step that is tried; a rejected step may reach far ahead, so the lowest of a block counts
    calls, stopping, next_report, last, lowest = -1, 0, clock() + 0.1, -1.0, math.inf

    def before_step(_mbs: Any, t: float) -> bool:
        nonlocal calls, stopping, next_report, last, lowest
        calls += 1
        if calls & 31:
            return True
        if interrupted.is_set() or (cancel is not None and cancel.is_set()):
            calls, stopping = -1, stopping + 1
            if stopping > 2:
                raise _StopError
            return False
        lowest = min(lowest, t)
        if calls & 4095 == 4064:
            if lowest - last < STUCK * duration:
                given_up.append(NOTHING)
                raise _StopError
            last, lowest = lowest, math.inf
        if calls > max_steps:
            given_up.append(f"{calls} trial steps are more than max_steps = {max_steps:g}; {CHATTER}")
            raise _StopError
        if progress is not None and clock() > next_report:
            progress(t)
            next_report = clock() + 0.1
        return True

    mbs.SetPreStepUserFunction(before_step)
    return given_up


def _collect(assembly: Assembly, solver: Solver, duration: float, error: str, cancelled: bool, seconds: float) -> RawRun:
    mbs = assembly.mbs
    columns = {name: [np.asarray(mbs.GetSensorStoredData(sensor)) for sensor in group] for name, group in assembly.sensors.items()}
    times = next(iter(columns.values()))[0][:, 0]
    # exudyn repeats the last sample when the end falls on a write time
    keep = np.concatenate(([True], np.diff(times) > 0.0)) if len(times) else np.zeros(0, bool)
    times = times[keep]
    q, v, a = (_coordinates(assembly, columns, kind, keep) for kind in range(3))
    finite = np.ones(len(times), bool)
    for values in (*q.values(), *v.values()):
        finite &= np.isfinite(values)
    reached = float(times[-1]) if len(times) else 0.0
    implicit = isinstance(solver, Implicit)
    advice = IMPLICIT_ADVICE if implicit else ADVICE
    if not finite.all():
        first = int(np.argmin(finite))
        raise SimulationError(
            f"The run diverged: values are not finite from t = {times[first]:.6g} s on (of {duration:g} s) "
            f"with {solver.describe()}. {advice}"
        )
    complete = reached >= duration * (1.0 - 1e-9)
    if not complete and not cancelled:
        if implicit and error.startswith("SolveDynamic"):
            error = "Newton's method found no solution of a step"
        why = f": {error}" if error else ""
        way_out = "Correct the law." if assembly.failures else "" if CHATTER in error else advice
        raise SimulationError(f"The run stopped at t = {reached:.6g} s of {duration:g} s with {solver.describe()}{why}. {way_out}".rstrip())
    iteration = mbs.sys["dynamicSolver"].it
    return RawRun(
        times=times,
        angles={name: q[name] for name in assembly.bodies},
        speeds={name: v[name] for name in assembly.bodies},
        states={name: v[name] for name in assembly.states},
        status="complete" if complete else "cancelled",
        steps=int(iteration.currentStepIndex) - 1,
        rejected=int(iteration.rejectedAutomaticStepSizeSteps),
        seconds=seconds,
        accelerations={name: a[name] for name in assembly.bodies} if a else {},
    )


def _coordinates(assembly: Assembly, columns: Mapping[str, list[FloatArray]], kind: int, keep: FloatArray) -> dict[str, FloatArray]:
    """Coordinates (0), speeds (1) or accelerations (2) by name, counted forward."""
    owner = {rotor.coordinates[0]: rotor.coordinates for rotor in assembly.network.rotors} | assembly.groups
    found: dict[str, FloatArray] = {}
    for name, group in columns.items():
        if kind < len(group):
            for k, coordinate in enumerate(owner.get(name, (name,)), start=1):
                found[coordinate] = assembly.signs.get(coordinate, 1) * group[kind][keep, k]
    return found
