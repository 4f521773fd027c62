"""How large the gap is on what no fit has seen, and how far it shrinks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bench import units_of
from hdrive_mbs.diagnosis.result import Gap, Misfit
from hdrive_mbs.diagnosis.simulator import Simulator

FloatArray = npt.NDArray[np.float64]

PIECES, DRAWS, SEED = 60, 400, 20
"""Pieces of a record for the block bootstrap, resamplings, and the seed that makes them the same each time."""


def gaps(simulator: Simulator, nominal: FloatArray, refit: FloatArray, effect: FloatArray) -> tuple[Gap, ...]:
    """Root mean squares of held-out whitened residuals: of everything, then of each column of each record.

    nominal, refit, effect : whitened residuals of all samples

    The interval is that of a block bootstrap: stretches of a record are drawn with replacement, all its columns
    together, because neighbouring samples of a model error are alike (Kuensch 1989).
    """
    rng = np.random.default_rng(SEED)
    parts = {trial: [k for k, segment in enumerate(simulator.segments) if segment.trial == trial] for trial in range(len(simulator.trials))}
    sums = [np.array([_sums(simulator, k, values) for values in (nominal, refit, effect)]) for k in range(len(simulator.segments))]
    counts = [_sums(simulator, k, np.ones(simulator.size)) for k in range(len(simulator.segments))]
    draws = {trial: _drawn(rng, counts[own[0]]) for trial, own in parts.items()}
    found = []
    everything = list(range(len(simulator.segments)))
    found.append(_gap("", "", "", 1.0, *_misfits(simulator, sums, counts, draws, everything)))
    for k, segment in enumerate(simulator.segments):
        trial = simulator.trials[segment.trial]
        measured = trial.measured[segment.column]
        unit = units_of(trial.scene.network()).get(measured.channel, "")
        if counts[k].sum() > 0:
            found.append(_gap(trial.name, segment.column, unit, measured.total, *_misfits(simulator, sums, counts, draws, [k])))
    return tuple(found)


def _gap(record: str, column: str, unit: str, noise: float, nominal: Misfit, refit: Misfit, effect: Misfit) -> Gap:
    return Gap(record=record, column=column, unit=unit, noise=noise, nominal=nominal, refit=refit, effect=effect)


def _sums(simulator: Simulator, k: int, values: FloatArray) -> FloatArray:
    """Sum of squares in each piece of a segment, over held-out samples."""
    span = simulator.segments[k].span
    own = np.where(simulator.held_out[span], values[span], 0.0)
    piece = np.arange(len(own)) * PIECES // len(own)
    return np.asarray(np.bincount(piece, own**2, minlength=PIECES), float)


def _drawn(rng: np.random.Generator, counts: FloatArray) -> npt.NDArray[np.int64]:
    """Pieces that hold samples, drawn with replacement, (DRAWS, number)."""
    there = np.flatnonzero(counts > 0)
    if len(there) == 0:
        return np.zeros((DRAWS, 0), dtype=np.int64)
    return np.asarray(rng.choice(there, size=(DRAWS, len(there))))


def _misfits(
    simulator: Simulator,
    sums: Sequence[FloatArray],
    counts: Sequence[FloatArray],
    draws: dict[int, npt.NDArray[np.int64]],
    segments: Sequence[int],
) -> tuple[Misfit, Misfit, Misfit]:
    total = sum(counts[k].sum() for k in segments)
    found = []
    for which in range(3):
        value = float(np.sqrt(sum(sums[k][which].sum() for k in segments) / total)) if total else float("nan")
        above, below = np.zeros(DRAWS), np.zeros(DRAWS)
        for k in segments:
            drawn = draws[simulator.segments[k].trial]
            above += sums[k][which][drawn].sum(axis=1)
            below += counts[k][drawn].sum(axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            low, high = np.nanpercentile(np.sqrt(above / below), [2.5, 97.5]) if total else (float("nan"), float("nan"))
        found.append(Misfit(value=value, low=float(low), high=float(high)))
    return found[0], found[1], found[2]
