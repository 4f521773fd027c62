"""Time response of a scene on Exudyn."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.coarse_step import coarse_step, warn_of
from hdrive_mbs.analysis.default_solver import default_solver
from hdrive_mbs.analysis.initial_values import finite_number, initial_values
from hdrive_mbs.analysis.laws_at_start import check_laws_at_start
from hdrive_mbs.analysis.main_channels import main_channels
from hdrive_mbs.analysis.result import Result, write_csv
from hdrive_mbs.analysis.stable_step import check_run, check_start
from hdrive_mbs.analysis.time_tables import for_tables
from hdrive_mbs.engine.assembly import Assembly, assemble
from hdrive_mbs.engine.simulation import RawRun, run
from hdrive_mbs.engine.solvers import Solver
from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.expression import Value
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Body, Network
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.progress import progress_bar
from hdrive_mbs.scene import Scene
from hdrive_mbs.signals import FloatArray, TimeHistory
from hdrive_mbs.summary import ChannelSummaries


@dataclass(frozen=True, kw_only=True, eq=False)
class Response(Result):
    """Histories of all channels on the solver's own times.

    ``response["motor.speed"]`` is a TimeHistory; angles and speeds of places are in true sense,
    twists and torques of connections are positive when the motor drives the load forward.

    times : s, shape (n,)
    values : channel -> shape (n,)
    units, docs : channel -> text
    slopes : channel -> channel that holds its time derivative
    steps, rejected : accepted and rejected steps of the solver
    seconds : CPU time of the integration
    lowering : element -> "native", "symbolic" or "python"
    error : body or state -> estimated relative error (empty if not asked for)
    """

    times: FloatArray
    values: Mapping[str, FloatArray]
    units: Mapping[str, str]
    docs: Mapping[str, str]
    slopes: Mapping[str, str]
    steps: int
    rejected: int
    seconds: float
    lowering: Mapping[str, str]
    error: Mapping[str, float] = field(default_factory=dict)

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of all channels."""
        return tuple(self.values)

    def __getitem__(self, name: str) -> TimeHistory:
        if name not in self.values:
            raise unknown_place("channel", name, self.values, "This response")
        slope = self.slopes.get(name)
        return TimeHistory(name, self.units[name], self.times, self.values[name], self.values[slope] if slope else None)

    def __contains__(self, name: object) -> bool:
        return name in self.values

    def at(self, name: str, times: npt.ArrayLike) -> FloatArray:
        """A channel at other times.

        Angles, speeds and states by Hermite interpolation; torques and everything else that follows from
        them by the laws at the interpolated state, so that few steps per period do not flatten them.
        Of a file that could not hold its scene, as TimeHistory.at does it.
        """
        history = self[name]
        network = None if self.scene is None else self.scene.network()
        channel = None if network is None else next((item for item in network.channels if item.name == name), None)
        if history.slope is not None or network is None or channel is None:
            return history.at(times)
        wanted = np.asarray(times, float)
        angles = {body.name: body.sense * self[channel_of(body, "angle")].at(wanted) for body in network.bodies}
        speeds = {body.name: body.sense * self[channel_of(body, "speed")].at(wanted) for body in network.bodies}
        states = {state.name: self[state.name].at(wanted) for state in network.states}
        return read_over(channel.read, network.moment(wanted, angles, speeds, states))

    def columns(self) -> dict[str, np.ndarray]:
        return {"time [s]": self.times} | {f"{name} [{self.units[name]}]": values for name, values in self.values.items()}

    def to_csv(self, path: str | os.PathLike[str], channels: Sequence[str] | None = None, *, step: float | None = None) -> Path:
        """Write histories as CSV (comma, point, one header line with units): of these channels, of all if not given.

        step : even distance of the samples [s], as a record needs it; the solver's own times if not given

        Raises ParameterError for a step that is not between 0 and the duration of the run.
        """
        if channels is None and step is None:
            return super().to_csv(path)
        names = self.channels if channels is None else channels
        times = self.times if step is None else self._even(step)
        values = {f"{name} [{self[name].unit}]": self[name].values if step is None else self.at(name, times) for name in names}
        return write_csv(path, {"time [s]": times} | values)

    def _even(self, step: float) -> FloatArray:
        """Times from the first to the last, so far apart."""
        first, span = float(self.times[0]), float(self.times[-1] - self.times[0])
        if not 0.0 < step <= span:
            raise ParameterError(f"step = {step:g} s: must be greater than 0 s and at most the duration of the run, {span:g} s.")
        return np.asarray(first + step * np.arange(int(span / step * (1.0 + 1e-12)) + 1), np.float64)

    def summary(self) -> ChannelSummaries:
        """min, max, mean, rms and final value of each channel."""
        return ChannelSummaries({name: self[name].summary() for name in self.values})

    def tables(self) -> tuple[PrintedTable, ...]:
        """min, max, mean and final value of speeds, torques and twists, of a rotor line of its main channels."""
        lateral = any(name.endswith(".radial") for name in self.channels)
        turning = [name for name in self.channels if name.endswith((".speed", ".torque", ".twist"))]
        shown = main_channels(self.scene, self.channels) if lateral else turning
        figures = {name: self[name].summary() for name in shown}
        rows = [(f"{name} [{self.units[name]}]", *(one[key] for key in ("min", "max", "mean", "final"))) for name, one in figures.items()]
        notes = [f"{len(shown)} of {len(self.channels)} channels; summary() has all"]
        if self.error:
            worst = max(self.error, key=lambda name: self.error[name])
            notes.append(f"estimated error: at most {100.0 * self.error[worst]:.2g} % of the largest value ({worst})")
        return (PrintedTable(heads=("channel", "min", "max", "mean", "final"), rows=tuple(rows), notes=tuple(notes)),)


def simulate(
    scene: Scene,
    duration: float,
    *,
    solver: Solver | None = None,
    initial_speed: float = 0.0,
    initial: Mapping[str, float] | None = None,
    sample_step: float = 0.0,
    estimate_error: bool = False,
    progress: bool | None = None,
    cancel: threading.Event | None = None,
    lowering: str = "symbolic",
) -> Response:
    """Integrate a scene from t = 0.

    duration : s
    solver : by default DormandPrince(), for rotor lines Trapezoidal with a step for 1e-3 (analysis/default_solver.py).
        Its longest step is shortened where a table over time (TableTorque, SpeedTable) has closer points; for a short
        pulse in a function of your own set max_step yourself
    initial_speed : motor speed at t = 0 [rad/s]; every other place turns by its ideal ratio
    initial : values at t = 0 by channel name (``"load.angle"``, ``"motor.speed"``, a state), true sense
    sample_step : record about once in so long [s], at the solver's own times, which are not even; 0 records every step.  ``at`` and
        ``to_csv(step=...)`` give even ones
    estimate_error : run again with half the step (or 32 times tighter tolerances), return the finer
        run with its estimated error
    progress : True, False, or None for a bar when a terminal is attached and the run takes over 1 s
    cancel : event that stops the run; what was computed is returned with status "cancelled"
    lowering : "python" runs every law as a Python callback (for comparison only)

    A rotor line begins undeflected and rings under its weight; ``run_up`` and ``coast_down`` begin in its static deflection.

    Raises SimulationError when the run diverged or stopped early, or the step of an explicit solver is beyond its limit of
    stability; LawError for a law that gives no number at the start; ParameterError for bad arguments.  Warns
    CoarseStepWarning, and says so in the status, where the step of an implicit solver is too long for the motion that comes out.
    """
    response = integrate(
        scene,
        duration,
        solver=solver,
        initial_speed=initial_speed,
        initial=initial,
        sample_step=sample_step,
        estimate_error=estimate_error,
        progress=progress,
        cancel=cancel,
        lowering=lowering,
    )
    warn_of(scene.name, response.status)
    return response


def integrate(
    scene: Scene,
    duration: float,
    *,
    solver: Solver | None = None,
    initial_speed: float = 0.0,
    initial: Mapping[str, float] | None = None,
    sample_step: float = 0.0,
    estimate_error: bool = False,
    progress: bool | None = None,
    cancel: threading.Event | None = None,
    lowering: str = "symbolic",
    judged: bool = True,
) -> Response:
    """What ``simulate`` does, without the warning.

    judged : say in the status where the step of an implicit solver that is given is too long for what comes out
    """
    given = solver is not None
    duration = finite_number("duration", duration, "s")
    sample_step = finite_number("sample_step", sample_step, "s")
    if duration <= 0.0:
        raise ParameterError(f"duration = {duration:g} s: must be greater than 0 s.")
    if sample_step < 0.0:
        raise ParameterError(f"sample_step = {sample_step:g} s: must be at least 0 s (0 records every step of the solver).")
    network = scene.network()
    starts = initial_values(network, initial_speed, initial or {})
    remark = ""
    if solver is None:
        chosen = default_solver(network, duration, initial_speed, initial)
        solver, remark = chosen.solver, chosen.remark
    if not isinstance(solver, Solver):
        raise ParameterError(f"solver = {solver!r}: must be a Solver, for instance DormandPrince() or RungeKutta4(step=1e-5).")
    solver = for_tables(solver, scene, duration)
    assembly = assemble(network, lowering=lowering)
    check_laws_at_start(network, starts)
    check_start(assembly, solver, duration, starts)
    every = 0.0 if estimate_error else sample_step  # between thin samples the interpolation would err more than the solver

    def once(with_solver: Solver) -> RawRun:
        with progress_bar(f"{scene.name}: {duration:g} s", duration, progress) as report:
            raw = run(assembly, duration=duration, solver=with_solver, **starts, sample_step=every, progress=report, cancel=cancel)
        check_run(assembly, with_solver, raw)
        return raw

    raw, error, used = once(solver), {}, solver
    if estimate_error and raw.status == "complete":
        used = solver.refined()
        finer = once(used)
        if finer.status == "complete":
            divisor = 1.0 if solver.adaptive else 2.0**solver.order - 1.0
            error = {name: value / divisor for name, value in _difference(network, raw, finer).items()}
            raw = finer
    remark = coarse_step(assembly, used, raw) if given and judged else remark
    raw = _thinned(raw, sample_step) if estimate_error else raw
    settings = {"duration": duration, "solver": used.describe(), "initial_speed": initial_speed, "sample_step": sample_step}
    response = _response(scene, network, assembly, raw, settings | {"initial": dict(initial or {})}, error, remark)
    assembly.mbs.Reset()  # exudyn would keep the samples of its sensors
    return response


def channel_of(body: Body, kind: str) -> str:
    """The channel that holds "angle", "speed" or "acceleration" of a coordinate."""
    if body.lateral:
        return body.name + {"angle": "", "speed": "_rate", "acceleration": "_acceleration"}[kind]
    return f"{body.name}.{kind}"


def _thinned(raw: RawRun, sample_step: float) -> RawRun:
    """Samples no closer than sample_step [s], and the last one: what the engine keeps of a run."""
    if sample_step == 0.0:
        return raw
    kept, due = [0], sample_step
    for k, time in enumerate(raw.times[1:], start=1):
        if time >= due * (1.0 - 1e-12):
            kept.append(k)
            due += sample_step * max(1.0, np.ceil((time - due) / sample_step))
    kept = sorted({*kept, len(raw.times) - 1})

    def pick(values: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        return {name: value[kept] for name, value in values.items()}

    return replace(
        raw,
        times=raw.times[kept],
        angles=pick(raw.angles),
        speeds=pick(raw.speeds),
        states=pick(raw.states),
        accelerations=pick(raw.accelerations),
    )


def run_moment(network: Network, raw: RawRun) -> Moment:
    """All moments of a run at once, as arrays."""
    return network.moment(raw.times, raw.angles, raw.speeds, raw.states)


def read_over(function: Callable[[Moment], Value], moment: Moment) -> FloatArray:
    """A quantity over all moments; point by point where a law does not take arrays."""
    return _read_all(lambda m: {"": function(m)}, moment)[""]


def _read_all(function: Callable[[Moment], Mapping[str, Value]], moment: Moment) -> dict[str, FloatArray]:
    """Several quantities over all moments.

    A law for plain numbers may fail on arrays, or not fail and mean something else (``max``,
    ``np.sum``), so three points are compared.
    """
    count = len(moment.time)
    with np.errstate(all="ignore"):
        try:
            whole = {name: np.broadcast_to(np.asarray(value, float), (count,)).copy() for name, value in function(moment).items()}
            for k in {count // 3, 2 * count // 3, count - 1} if count else ():
                for name, value in function(_point(moment, k)).items():
                    if not np.isclose(whole[name][k], float(value), rtol=1e-9, atol=1e-12, equal_nan=True):
                        raise ValueError(name)
            return whole
        except Exception:  # whatever the law raises, the points below raise again if it is real
            rows = [function(_point(moment, k)) for k in range(count)]
            return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def _point(moment: Moment, k: int) -> Moment:
    def pick(values: Mapping[str, Value]) -> dict[str, float]:
        return {name: float(value[k]) for name, value in values.items()}

    return Moment(time=float(moment.time[k]), angles=pick(moment.angles), speeds=pick(moment.speeds), states=pick(moment.states))


def _response(
    scene: Scene, network: Network, assembly: Assembly, raw: RawRun, settings: dict[str, Any], error: dict[str, float], remark: str
) -> Response:
    moment = run_moment(network, raw)
    values: dict[str, FloatArray] = {}
    units: dict[str, str] = {}
    docs: dict[str, str] = {}
    slopes: dict[str, str] = {}
    senses = {body.name: body.sense for body in network.bodies}
    for channel in network.channels:
        values[channel.name] = read_over(channel.read, moment)
        units[channel.name], docs[channel.name] = channel.unit, channel.doc
        if channel.slope:
            slopes[channel.name] = channel.slope
    rates = _rates(network, raw, moment)
    for channel in network.channels:
        if channel.factors is not None:
            name = f"{channel.name}_acceleration"
            values[name] = np.asarray(sum((f * rates[c] for c, f in channel.factors.items()), np.zeros(len(raw.times))))
            units[name], docs[name] = f"{channel.unit}/s^2", f"acceleration of the {channel.doc}"
    for place, node in network.places.items():
        if node in senses and f"{place}.speed" in values:
            name = f"{place}.acceleration"
            values[name] = senses[node] * rates[node]
            units[name], docs[name] = "rad/s^2", f"angular acceleration of {place}, true sense"
    for state in network.states:
        name = f"{state.name}.rate"
        values[name], units[name], docs[name] = rates[state.name], f"{state.unit}/s", f"rate of {state.name}"
        slopes[state.name] = name
    slopes = {name: slope for name, slope in slopes.items() if slope in values}
    status = (
        "; ".join(["complete", *filter(None, [remark])])
        if raw.status == "complete"
        else f"cancelled at t = {raw.times[-1]:.6g} s; the histories end there"
    )
    return Response(
        scene=scene,
        status=status,
        settings=settings,
        times=raw.times,
        values=values,
        units=units,
        docs=docs,
        slopes=slopes,
        steps=raw.steps,
        rejected=raw.rejected,
        seconds=raw.seconds,
        lowering={item.element: item.how for item in assembly.lowered},
        error=error,
    )


def _rates(network: Network, raw: RawRun, moment: Moment) -> dict[str, FloatArray]:
    """Acceleration of each body (from the engine where masses couple them) and rate of each state."""
    if not raw.accelerations:
        return _read_all(network.accelerations, moment)
    states = {equation.state: read_over(equation.rate, moment) for equation in network.state_equations()}
    start = network.accelerations(_point(moment, 0))  # explicit solvers of the engine leave zeros there
    moved = {name: np.concatenate([[float(start[name])], values[1:]]) for name, values in raw.accelerations.items()}
    return {**moved, **states}


def _difference(network: Network, coarse: RawRun, fine: RawRun) -> dict[str, float]:
    """Largest difference of two runs over the largest value, per body (angle and speed) and state.

    Compared at the times of the coarser run: with half the step they are times of both.
    """
    moment = run_moment(network, fine)
    slopes = _rates(network, fine, moment)
    result = {}

    def compare(name: str, rough: FloatArray, good: FloatArray, slope: FloatArray) -> None:
        reference = TimeHistory(name, "", fine.times, good, slope).at(coarse.times)
        size = float(np.max(np.abs(good)))
        result[name] = float(np.max(np.abs(rough - reference))) / size if size > 0.0 else 0.0

    for name in fine.angles:
        compare(f"{name}.angle", coarse.angles[name], fine.angles[name], fine.speeds[name])
        compare(f"{name}.speed", coarse.speeds[name], fine.speeds[name], slopes[name])
    for name in fine.states:
        compare(name, coarse.states[name], fine.states[name], slopes[name])
    return result
