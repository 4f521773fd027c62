"""Columns that drive the scene and look as if they had been read in another unit: times a known factor the model comes far nearer.

Where friction is missing a model that hardly moves may be nearer than one that runs away: so it has to be nearer than at rest too.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Sequence

import numpy as np

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.scale_checks import OTHERS
from hdrive_mbs.diagnosis.simulator import Simulator, chi_square
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.errors import HdriveError
from hdrive_mbs.records.record import Record

FAR, NEARER, MOVING = 100.0, 0.1, 0.5
"""Mean square of the nominal residual (noise: 1) from which this is asked, and the shares that another unit may leave of it, and of
what is left if the column is zero."""


def drives_scaled(bench: Bench, records: Sequence[Record], simulator: Simulator, factors: Sequence[Factor]) -> tuple[str, ...]:
    """Driving columns that look as if they were in another unit, in words, one line for each.

    simulator : of these records, with the nominal scene
    """
    if not bench.inputs:
        return ()
    before = _misfit(simulator, factors)
    if not FAR < before < np.inf:
        return ()
    found = []
    for name in bench.inputs:
        units = {record[name].unit for record in records if name in record.channels}
        most = min(NEARER * before, MOVING * _scaled(bench, records, simulator, factors, name, 0.0))
        tried = [(_scaled(bench, records, simulator, factors, name, size), words) for unit in units for size, words in _sizes(unit)]
        after, words = min(tried, default=(np.inf, ""))
        if after < most:
            found.append(
                f"Column {name!r}, which drives the scene, looks as if {words}: so the nominal model would leave {after / before:.2g} of"
                f" the mean square that it leaves now. Give its unit when reading: --unit {name}=... (under its name in the file)."
            )
    return tuple(found)


def _sizes(unit: str) -> Iterator[tuple[float, str]]:
    """Factors that put numbers right that were read in the wrong unit, with what they say."""
    for other, size in OTHERS.get(unit, {}).items():
        yield size, f"its numbers were in {other} and had been read as {unit}"
        yield 1.0 / size, f"its numbers were in {unit} and had been read as {other}"


def _scaled(bench: Bench, records: Sequence[Record], simulator: Simulator, factors: Sequence[Factor], name: str, size: float) -> float:
    """Mean square of the nominal residual with a driving column times a factor; inf where the bench does not take that."""
    try:
        trials = [trial for record in records for trial in bench.trials(_with(record, name, size))]
        same = {trial.name for trial in simulator.trials}
        chosen = [dataclasses.replace(trial, held_out=np.zeros_like(trial.held_out)) for trial in trials if trial.name in same]
        return _misfit(Simulator(chosen, simulator.step, simulator.every, slowed=simulator.slowed, shortest=simulator.shortest), factors)
    except (HdriveError, ValueError):
        return np.inf


def _with(record: Record, name: str, size: float) -> Record:
    if name not in record.channels:
        return record
    column = record[name]
    new = column.replacing(values=size * np.asarray(column.values, float))
    return record.with_channels(new if item is column else item for item in record)


def _misfit(simulator: Simulator, factors: Sequence[Factor]) -> float:
    """Mean square of the nominal residual; inf where the model cannot be run."""
    hypothesis = Hypothesis(factors=tuple(factors))
    [residuals] = simulator.residuals(hypothesis, [np.zeros(hypothesis.size)])
    return np.inf if residuals is None else chi_square(residuals, simulator.used)
