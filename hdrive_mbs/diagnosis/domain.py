"""Where in the operating range the gap is: at which speed, torque, direction, order, frequency and time.

Each bin holds the mean square of the whitened residuals minus 1, which noise alone would give.  The speed is the measured one
where a column holds that of the reference shaft; it, torque and angle are else those of the best fit, for a model that lacks a
cause runs at speeds and torques that the machine never had.  Orders are counted per turn of the reference shaft: Fourier sums
over the angle in windows of whole turns, so that a slow and a fast stretch of the same ripple fall into one bin.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.locate.motion import Motion, motion_of
from hdrive_mbs.diagnosis.locate.spectra import windowed
from hdrive_mbs.diagnosis.result import DomainBin
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.turning import reference_place, reference_shaft
from hdrive_mbs.network.elements import Connection

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]

PARTS = 8
"""Bins of the speed; a torque of either sign has one more, so that one lies about zero."""
TIMES = 12
"""Bins of the time."""
REST = 0.02
"""Of the greatest speed: below it a shaft counts as at rest or turning round."""
ORDERS, STEP, TURNS = 24, 4, 8
"""Highest order, steps of an order at which it is looked at, and turns of a window."""
WINDOW = 1024
"""Samples of a window of the frequency bins."""
SAME = 1e-3
"""Of its largest: by what the modelled reading of a column may differ from the speed of the reference shaft and still be it."""


@dataclass(frozen=True, eq=False)
class _Stretch:
    """One trial: what happens at its samples, and residuals of both models by column, (columns, samples); 0 where not used."""

    times: FloatArray
    speed: FloatArray
    angle: FloatArray
    torque: FloatArray
    used: Mask
    before: FloatArray
    after: FloatArray
    every: float


def domain_map(simulator: Simulator, null: Fitted, claimed: Fitted | None = None) -> tuple[DomainBin, ...]:
    """The gap of the refitted nominal model by operating range, and what a claimed cause leaves of it (nan without one).

    null, claimed : fitted on this simulator
    """
    best = null if claimed is None else claimed
    motions = [motion_of(simulator, k, best.hypothesis, best.z) for k in range(len(simulator.trials))]
    carrier = _carrier(motions)
    stretches = [_stretch(simulator, null, claimed, k, motion, carrier) for k, motion in enumerate(motions)]
    turned = reference_place(motions[0].network)
    shaft = turned[0] if turned is not None else ""
    fastest = max(float(np.max(np.abs(item.speed))) for item in stretches)
    found: list[DomainBin] = []
    if fastest > 0.0:
        edges = np.linspace(0.0, fastest, PARTS + 1)
        found += _binned("speed", shaft, "rad/s", stretches, lambda item: np.abs(item.speed), edges)
    largest = max(float(np.max(np.abs(item.torque))) for item in stretches)
    if largest > 0.0:
        negative = min(float(np.min(item.torque)) for item in stretches) < -0.1 * largest
        edges = np.linspace(-largest, largest, PARTS + 2) if negative else np.linspace(0.0, largest, PARTS + 1)
        found += _binned("torque", carrier, "N m", stretches, lambda item: item.torque if negative else np.abs(item.torque), edges)
    if fastest > 0.0:
        edges = np.array([-fastest, -REST * fastest, REST * fastest, fastest])
        found += _binned("direction", shaft, "rad/s", stretches, lambda item: item.speed, edges)
        found += _orders(shaft, stretches)
    found += _frequencies(stretches)
    longest = max(float(item.times[-1] + item.every) for item in stretches)
    found += _binned("time", "", "s", stretches, lambda item: item.times, np.linspace(0.0, longest, TIMES + 1))
    return tuple(found)


def _stretch(simulator: Simulator, null: Fitted, claimed: Fitted | None, k: int, motion: Motion, carrier: str) -> _Stretch:
    each = simulator.every
    spans = [segment.span for segment in simulator.segments if segment.trial == k]
    used = np.array([simulator.used[span] for span in spans])
    before = np.array([null.residuals[span] for span in spans]) * used
    after = np.full(before.shape, np.nan) if claimed is None else np.array([claimed.residuals[span] for span in spans]) * used
    speed, angle = reference_shaft(motion)
    measured = _measured_speed(motion)
    speed = np.where(np.isfinite(measured), measured, speed)
    torque = motion.reading(f"{carrier}.torque") if _shows(motion, carrier) else np.zeros(motion.trial.samples)
    trial = simulator.trials[k]
    return _Stretch(trial.times[::each], speed[::each], angle[::each], torque[::each], used, before, after, trial.every * each)


def _carrier(motions: Sequence[Motion]) -> str:
    """The shaft or gear that carries the largest torque over all trials, whose views may differ; empty where there is none."""
    energy: dict[str, float] = {}
    for motion in motions:
        for item in motion.network.elements:
            if isinstance(item, Connection) and item.flanges and _shows(motion, item.name):
                energy[item.name] = energy.get(item.name, 0.0) + float(np.sum(motion.reading(f"{item.name}.torque") ** 2))
    return max(energy, key=lambda name: energy[name], default="")


def _shows(motion: Motion, name: str) -> bool:
    """Whether a run can tell the torque of a part."""
    return any(channel.name == f"{name}.torque" for channel in motion.network.channels)


def _measured_speed(motion: Motion) -> FloatArray:
    """Speed of the reference shaft [rad/s] by the column of least noise that measures it, in its true sense; nan where there is none.

    A column measures it whose channel, without what a cause does to a sensor, reads it along the run.
    """
    trial = motion.trial
    speed = reference_shaft(motion)[0]
    largest = float(np.max(np.abs(speed), initial=0.0))
    found = np.full(trial.samples, np.nan)
    if not largest > 0.0:
        return found
    plain = {channel.name: channel for channel in trial.scene.network().channels}
    moment = motion.moment()
    for column in sorted(trial.columns, key=lambda name: trial.measured[name].total):
        item = trial.measured[column]
        channel = plain.get(item.channel)
        if channel is None or channel.unit != "rad/s" or item.offset > 0.0:
            continue
        try:
            reading = np.broadcast_to(np.asarray(channel.read(moment), float), speed.shape)
        except KeyError:
            continue  # it reads a state that the network of the run has not
        for sense in (1.0, -1.0):
            if float(np.max(np.abs(sense * reading - speed))) <= SAME * largest:
                return np.asarray(sense * trial.columns[column], float)
    return found


def _binned(
    over: str, of: str, unit: str, stretches: Sequence[_Stretch], value: Callable[[_Stretch], FloatArray], edges: FloatArray
) -> Iterator[DomainBin]:
    count, before, after = (np.zeros(len(edges) - 1) for _ in range(3))
    for item in stretches:
        at = np.clip(np.searchsorted(edges, value(item), side="right") - 1, 0, len(edges) - 2)
        count += np.bincount(at, item.used.sum(axis=0), minlength=len(count))
        before += np.bincount(at, (item.before**2).sum(axis=0), minlength=len(count))
        after += np.bincount(at, (item.after**2).sum(axis=0), minlength=len(count))
    for k in np.flatnonzero(count):
        yield _bin(over, of, unit, edges[k], edges[k + 1], before[k], after[k], count[k])


def _bin(over: str, of: str, unit: str, low: float, high: float, before: float, after: float, count: float) -> DomainBin:
    excess, left = before / count - 1.0, after / count - 1.0
    return DomainBin(over=over, of=of, unit=unit, low=float(low), high=float(high), excess=excess, after=left, samples=int(count))


def _frequencies(stretches: Sequence[_Stretch]) -> Iterator[DomainBin]:
    """Octaves up to half the sample rate."""
    every = min(item.every for item in stretches)
    lowest = max(2.0 * math.pi / (_window(item) * item.every) for item in stretches)
    edges = [0.0, lowest]
    while 1.5 * edges[-1] < math.pi / every:
        edges.append(min(2.0 * edges[-1], math.pi / every))
    count, before, after = (np.zeros(len(edges) - 1) for _ in range(3))
    for item in stretches:
        window = _window(item)
        bins = window // 2
        at = np.searchsorted(edges, 2.0 * np.pi * (np.arange(bins) + 0.5) / (window * item.every), side="right") - 1
        at = np.clip(at, 0, len(count) - 1)
        for total, rows in ((before, item.before), (after, item.after)):
            total += np.bincount(at, np.sum(np.abs(windowed(rows, window, bins)) ** 2, axis=(0, 1)), minlength=len(count))
        count += np.bincount(at, minlength=len(count)) * float(item.used.sum()) / bins
    for k in np.flatnonzero(count):
        yield _bin("frequency", "", "rad/s", edges[k], edges[k + 1], before[k], after[k], count[k])


def _window(item: _Stretch) -> int:
    return min(WINDOW, len(item.times) // 4 // 2 * 2)


def _orders(shaft: str, stretches: Sequence[_Stretch]) -> Iterator[DomainBin]:
    """Below half an order, then orders 1, 2, ... of the reference shaft, each with what lies up to half an order beside it."""
    grid = STEP * ORDERS + STEP // 2
    count, before, after = (np.zeros(grid) for _ in range(3))
    for item in stretches:
        turned = np.cumsum(np.abs(np.diff(item.angle, prepend=item.angle[0]))) / (2.0 * np.pi)
        number = np.floor(turned / TURNS).astype(int)
        first = np.flatnonzero(np.diff(number, prepend=-1))[:-1]  # the last window is not full
        last = np.append(first[1:], len(number) if not len(first) else np.flatnonzero(number == number[-1])[0])
        if not len(first):
            continue
        end = int(last[-1])
        taper = np.sin(np.pi * np.modf(turned[:end] / TURNS)[0])
        power = np.maximum(np.add.reduceat(taper**2, first), 1e-9)
        fastest = np.maximum.reduceat(np.abs(item.speed[:end]), first)
        turning = np.exp(-2j * np.pi * turned[:end] / STEP)
        factor = taper.astype(complex)
        for k in range(1, grid):
            factor = factor * turning
            seen = fastest * k / STEP < 0.8 * np.pi / item.every
            if not seen.any():
                break
            for total, rows in ((before, item.before), (after, item.after)):
                sums = np.add.reduceat(rows[:, :end] * factor, first, axis=1)
                total[k] += float(np.sum((np.abs(sums) ** 2 / power)[:, seen]))
            count[k] += len(item.before) * int(seen.sum())
    for order in range(ORDERS + 1):
        near = np.arange(max(1, STEP * order - STEP // 2), STEP * order + STEP // 2)
        if count[near].sum() > 0.0:
            energies = (float(total[near].sum()) for total in (before, after, count))
            yield _bin("order", shaft, "1", max(order - 0.5, 0.0), order + 0.5, *energies)
