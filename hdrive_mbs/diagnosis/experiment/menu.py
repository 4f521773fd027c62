"""Plans that make sense for a bench whose motor follows a speed reference or a torque, with or without a load.

From rest: a staircase of speeds in both senses, slow reversals through zero, a sine sweep, three bands of multisines
about zero and about a mean speed, steps of load at several speeds, a cycle of load and a multisine of load at standstill.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.experiment.drives import Drive, load_of, motor_of
from hdrive_mbs.diagnosis.experiment.limits import Limits
from hdrive_mbs.diagnosis.experiment.multisine import low_phases, multisine, spread_harmonics
from hdrive_mbs.diagnosis.experiment.plan import Course, Plan
from hdrive_mbs.diagnosis.experiment.within import Shape, largest, nominal_model
from hdrive_mbs.errors import ParameterError

FloatArray = npt.NDArray[np.float64]

BANDS, LINES = ("low", "middle", "high"), 8
"""Bands of the multisines, even on a logarithmic scale, and lines in each."""
PERIODS, TOP = 2, 0.05
"""Periods of the slowest line in a record, and the fastest line as a share of the sampling rate."""
SLOW, MEAN = 0.05, 0.35
"""Of the speed limit: peak of slow reversals, and mean speed of records that must not reverse."""
RISE = 0.1
"""Of a record: the time it takes to the mean speed."""


def standard_menu(
    bench: Bench, limits: Limits, *, seconds: float, every: float, step: float | None = None, speeds: Sequence[float] = (0.25, 0.5, 1.0)
) -> tuple[Plan, ...]:
    """Plans of one length, each as large as the limits allow by the nominal model's prediction.

    seconds, every : length and sample time of the records [s];  step : of the integration [s]; half a sample if not given
    speeds : of the staircase and under steps of load, shares of the speed limit

    A plan that does not keep the limits at any size is left out.  Raises ParameterError for a bench whose inputs are none
    of these, or where nothing keeps the limits.
    """
    motor, load = motor_of(bench), load_of(bench)
    if motor is None:
        raise ParameterError(f"Bench {bench.scene.name!r} has no speed reference or motor torque among its inputs; give your own plans.")
    loaded = load if limits.load > 0.0 else None
    shapes = _shapes(motor, loaded, limits, seconds, every, tuple(speeds))
    found = [largest(bench, shape, limits, [nominal_model()], step or 0.5 * every) for shape in shapes]
    plans = tuple(plan for plan in found if plan is not None)
    if not plans:
        raise ParameterError(f"No plan of {seconds:g} s keeps within {limits}; give higher limits or more time.")
    return plans


def _shapes(motor: Drive, load: Drive | None, limits: Limits, seconds: float, every: float, speeds: tuple[float, ...]) -> Iterator[Shape]:
    times: FloatArray = np.asarray(every * np.arange(round(seconds / every)), float)
    unit: FloatArray = times / seconds
    top = limits.speed if motor.role == "speed" else limits.torque

    def shape(name: str, motion: FloatArray, base: FloatArray | None = None, torque: FloatArray | None = None) -> Shape:
        still = np.zeros_like(unit) if base is None else base

        def of(size: float) -> Plan:
            inputs: dict[str, Course] = {motor.column: (times, top * (still + size * motion))}
            if load is not None and torque is not None:
                inputs[load.column] = (times, limits.load * torque)
            return Plan(name=name, inputs=inputs, duration=seconds, every=every)

        return of

    # sums of sines start at zero and fade in, so that nothing jumps
    fading = np.clip(unit / RISE, 0.0, 1.0) ** 2 * (3.0 - 2.0 * np.clip(unit / RISE, 0.0, 1.0))
    speed = motor.role == "speed"
    mean = MEAN * fading
    if speed:
        yield shape("speed staircase", _staircase(unit, (*speeds, 0.0, *(-item for item in speeds), 0.0)))
    yield shape("slow reversals", (SLOW if speed else 0.5) * _triangle(3.0 * unit))
    bottom, highest = PERIODS, max(PERIODS + 2, int(TOP * len(times)))
    # the speed falls as the frequency rises: at the same speed fast lines would take all the torque
    sweep = fading * np.sin(_swept(unit, bottom, highest)) * np.sqrt(bottom / _frequency(unit, bottom, highest))
    yield shape("sine sweep", (0.6 if speed else 1.0) * sweep, mean if speed else None)
    edges = np.round(np.geomspace(bottom, highest, len(BANDS) + 1)).astype(int)
    for k, band in enumerate(BANDS):
        lines = spread_harmonics(edges[k], edges[k + 1], LINES)
        wave = fading * _wave(unit, lines, 1.0 / np.asarray(lines, float) if speed else np.ones(len(lines)), seed=k)
        yield shape(f"multisine, {band} band, about zero", wave)
        if speed:
            yield shape(f"multisine, {band} band, about a mean speed", (1.0 - MEAN) * wave, mean)
    if load is None:
        return
    if speed:
        counts = len(speeds)
        turn = unit * counts  # one load at each speed, on and off, its sense changing
        sense = np.where(turn % 2.0 < 1.0, 1.0, -1.0)
        steps = np.interp(turn % 1.0, (0.45, 0.46, 0.8, 0.81), (0.0, 1.0, 1.0, 0.0)) * sense
        yield shape("load steps at several speeds", _staircase(unit, speeds), torque=steps)
    nothing = np.zeros_like(unit)
    yield shape("load cycle at standstill", nothing, torque=_triangle(2.0 * unit))
    lines = spread_harmonics(edges[0], edges[1], LINES)
    wave = fading * _wave(unit, lines, np.ones(len(lines)), seed=9)
    yield shape("load multisine at standstill", nothing, torque=wave)


def _wave(unit: FloatArray, lines: Sequence[int], amplitudes: FloatArray, seed: int) -> FloatArray:
    """A multisine with a peak of 1."""
    wave = multisine(unit, lines, amplitudes, low_phases(lines, amplitudes, seed))
    return wave / float(np.abs(wave).max())


def _staircase(unit: FloatArray, levels: Sequence[float]) -> FloatArray:
    """Levels of equal length from zero, the first two fifths of each a ramp."""
    number = len(levels)
    corners = np.concatenate([[k, k + 0.4] for k in range(number)] + [[number]]) / number
    values = np.concatenate([[0.0 if k == 0 else levels[k - 1], levels[k]] for k in range(number)] + [[levels[-1]]])
    return np.interp(unit, corners, values)


def _triangle(turns: FloatArray) -> FloatArray:
    """0, 1, 0, -1, 0 over each turn, straight between."""
    return np.interp(turns % 1.0, (0.0, 0.25, 0.75, 1.0), (0.0, 1.0, -1.0, 0.0))


def _frequency(unit: FloatArray, low: float, high: float) -> FloatArray:
    """Of a logarithmic sweep, periods per record."""
    return np.asarray(low * (high / low) ** unit)


def _swept(unit: FloatArray, low: float, high: float) -> FloatArray:
    """Its phase."""
    return np.asarray(2.0 * np.pi * (_frequency(unit, low, high) - low) / np.log(high / low))
