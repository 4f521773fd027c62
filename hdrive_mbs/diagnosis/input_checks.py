"""Whether a bench and its records can be diagnosed at all: refused early, and in words.

What is wrong with a record alone (gaps, saturated or stuck channels, contradicting units) its own checks say
(``Record.checked``); here it is held against the bench.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bench import Bench, Input, units_of
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.scale_checks import check_scale
from hdrive_mbs.diagnosis.simulator import Simulator, chi_square
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.errors import ParameterError, RecordError, UnitError, unknown_place
from hdrive_mbs.quantities import Described
from hdrive_mbs.quantity import Quantity
from hdrive_mbs.records.record import Record

FloatArray = npt.NDArray[np.float64]

LEAST = 16
"""Values of a column that a fit has to see, and of all columns together that it must not see."""
MOVES = 10.0
"""Standard deviations of its noise by which a column has to vary somewhere, or nothing was excited."""
FAR = 100.0
"""Mean square of the nominal residual (noise: 1) from which a model that nothing measured drives is said to be far away."""
START, SHARE = 20.0, 0.1
"""A record does not start like the scene where a speed differs by that many standard deviations and that share of its range."""
ALIKE = 0.7
"""Likeness of two names (difflib) from which one may have been meant by the other."""
FIRST = 16
"""Samples that make up the start."""


def check_records(bench: Bench, records: Sequence[Record]) -> None:
    """Hold records against a bench.

    Raises ParameterError, PlaceError, UnitError or RecordError for what makes a diagnosis impossible or meaningless.
    """
    _check_bench(bench)
    names = [record.name for record in records]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ParameterError(f"Two records are named {twice[0]!r}; give each its own name, like record.replacing(name='...').")
    for record in records:
        record.checked()
        for name in bench.inputs:
            if name in record.channels:
                _check_input(bench, record, name)


def _check_bench(bench: Bench) -> None:
    owner: dict[str, str] = {}
    for name, item in bench.knowledge.items():
        for path, value in zip(item.paths, bench.nominal(name), strict=True):
            if value == 0.0:
                raise ParameterError(
                    f"{path} = 0, whose uncertainty {name!r} is a relative one of {100.0 * item.sigma:g} %: no factor changes 0."
                    " Give it a value, or leave it out of knowledge."
                )
            if path in owner:
                raise ParameterError(f"{path} is uncertain twice, as {owner[path]!r} and as {name!r}; leave one of them out.")
            owner[path] = name
    for group, members in bench.together.items():
        for name in members:
            if name not in bench.knowledge:
                raise unknown_place(f"parameter of the group {group!r}", name, bench.knowledge, "The knowledge of this bench")


def _check_input(bench: Bench, record: Record, name: str) -> None:
    values = record.channels[name].values
    bad = ~np.isfinite(values)
    if bad.any():
        raise RecordError(
            f"Record {record.name!r}: {name!r} drives the scene, but {int(bad.sum())} of its {len(values)} values are missing,"
            f" first at t = {record.times[int(np.argmax(bad))]:.6g} s. Use repaired(record, not_finite='interpolate'), or"
            " record.between(start, end)."
        )
    item = bench.inputs[name]
    unit = _unit_of_input(item)
    column = record.channels[name]
    if unit and column.unit != unit:
        raise UnitError(
            f"Record {record.name!r}: column {name!r} is in {column.unit_as_read}, but {item.path}, which it drives,"
            f" is in {unit}. Correct the unit when reading: units={{{name!r}: ...}}, or take another column."
        )


def _unit_of_input(item: Input) -> str:
    """Unit of the field that takes the values; empty where that cannot be seen, as of a law that smooths them."""
    try:
        return _unit_of_law(item.law(np.array([0.0, 1.0]), np.array([0.25, 0.75])), (0.25, 0.75))
    except ParameterError:
        return ""


def _unit_of_law(law: Any, values: tuple[float, ...]) -> str:
    """Unit of the field of a law that took these values; empty where that cannot be seen."""
    if not isinstance(law, Described):
        return ""
    for _, value, metadata in law.fields():
        quantity: Quantity | None = metadata.get("quantity")
        if quantity is not None and value == values:
            return quantity.unit
    return ""


def checked_every(every: object, searched: Iterable[Trial]) -> int:
    """Of so many samples the search compares one, as a plain number.

    Raises ParameterError for what is no whole number from 1 on, or leaves less of a record than a fit needs.
    """
    if isinstance(every, bool) or not isinstance(every, (int, np.integer)) or every < 1:
        raise ParameterError(f"diagnose: every = {every!r} must be a whole number of samples, at least 1 (all of them).")
    for trial in searched:
        for column, values in trial.columns.items():
            there = np.isfinite(values) & ~trial.held_out
            seen = int(there[::every].sum())
            if seen < min(LEAST, int(there.sum())):
                raise ParameterError(
                    f"diagnose: every = {every} leaves a search {seen} values of {column!r} in record {trial.name!r}; needed are {LEAST}."
                    " Choose less, down to 1 for all."
                )
    return int(every)


def check_trials(simulator: Simulator, factors: Sequence[Factor], *, fitted: bool = True) -> None:
    """Hold samples against the nominal model.

    fitted : whether they are fitted: then something has to move in one of them

    Raises RecordError for too few samples, records in which nothing moves, a column that stands still while the model
    moves, one that is the factor of a unit away from what the model does, and a record that starts at another speed than the scene.
    """
    for trial in simulator.trials:
        _check_samples(trial)
    if fitted and not any(_moves(trial, column) for trial in simulator.trials for column in trial.columns):
        raise RecordError(
            f"Nothing moves in {', '.join(repr(trial.name) for trial in simulator.trials)}: no column varies by more than {MOVES:g} times"
            " its noise, so no cause can be told from another. Record a motion: speeds of both signs, changing load, a sweep."
        )
    hypothesis = Hypothesis(factors=tuple(factors))
    simulated = simulator.columns(hypothesis, np.zeros(hypothesis.size))
    for trial, own in zip(simulator.trials, simulated, strict=True):
        if not own:
            continue  # what cannot be run at all is said by the first fit
        units = units_of(trial.scene.network())
        for column in trial.columns:
            _check_alive(trial, column, own[column], units)
            check_scale(trial, column, own[column], units.get(trial.measured[column].channel, ""))
            _check_start(trial, column, own[column], units)


def not_driven(
    bench: Bench, records: Sequence[Record], simulator: Simulator, factors: Sequence[Factor], *, bare: bool = False
) -> tuple[str, ...]:
    """Says so, and what to do, where no column drives the scene and the model stands still while the records move.

    bare : whether a scene alone was given: then also where the model, by laws of its own, is far from the records
    """
    if bench.inputs or any(trial.motions for trial in simulator.trials):
        return ()
    hypothesis = Hypothesis(factors=tuple(factors))
    simulated = simulator.columns(hypothesis, np.zeros(hypothesis.size))
    still = all(own and not _shows(own, trial) for trial, own in zip(simulator.trials, simulated, strict=True))
    if not still:
        [residuals] = simulator.residuals(hypothesis, [np.zeros(hypothesis.size)])
        if not bare or residuals is None or chi_square(residuals, simulator.used) < FAR:
            return ()
    how = "the model stands still while the records move" if still else "the model runs by laws of its own, far from what was measured"
    unused = sorted({name for record in records for name in record.channels if name not in bench.measured})
    which = repr(unused[0] if unused else "motor_torque")
    others = f" Columns that are not used: {', '.join(unused)}." if unused else ""
    return (
        f"No column drives the scene, and {how}: whatever is said below is about that."
        f" If a column holds what drove the bench, write a bench() that says so, with Bench(..., inputs={{{which}:"
        " Input(path='motor.characteristic', law=lambda t, v: hm.TorqueHistory(times=t, torques=v))}), see docs/diagnosis.md."
        f"{others}",
    )


def _shows(simulated: Mapping[str, FloatArray], trial: Trial) -> bool:
    """Whether a column of the model moves by more than noise."""
    return any(_range(simulated[column]) > MOVES * trial.measured[column].total for column in trial.columns)


def not_compared(bench: Bench, records: Sequence[Record]) -> tuple[str, ...]:
    """Columns that the bench measures and a record has not, in words, with what they may have been called."""
    found = []
    known = {*bench.measured, *bench.inputs}
    for column in bench.measured:
        without = [record for record in records if column not in record.channels]
        if without:
            where = ", ".join(repr(record.name) for record in without)
            others = sorted({name for record in without for name in record.channels if name not in known})
            unused = f" Columns there that the bench does not know: {', '.join(others)}." if others else ""
            near = difflib.get_close_matches(column, others, 1, ALIKE)
            meant = f" Did you mean {near[0]!r}? Then name both alike." if near else ""
            found.append(f"{column!r}, which the bench measures, was not compared in {where}: no such column there.{unused}{meant}")
    return tuple(found)


def _check_samples(trial: Trial) -> None:
    held = 0
    for column, values in trial.columns.items():
        there = np.isfinite(values)
        seen = int((there & ~trial.held_out).sum())
        held += int((there & trial.held_out).sum())
        if seen < LEAST and not trial.held_out.all():
            raise RecordError(
                f"Record {trial.name!r}: {column!r} has {seen} values that a fit may see; needed are {LEAST}."
                f" Leave the column out (record.without({column!r})), or record longer."
            )
    if held < LEAST:
        raise RecordError(f"Record {trial.name!r} has {held} values in the stretches that are held out; needed are {LEAST}. Record longer.")


def _range(values: FloatArray) -> float:
    finite = values[np.isfinite(values)]
    return float(np.ptp(finite)) if len(finite) else 0.0


def _moves(trial: Trial, column: str) -> bool:
    return _range(trial.columns[column]) > MOVES * trial.measured[column].total


def _check_alive(trial: Trial, column: str, simulated: FloatArray, units: Mapping[str, str]) -> None:
    values, measured = trial.columns[column], trial.measured[column]
    unit = units.get(measured.channel, "")
    if _range(values) == 0.0 and _range(simulated) > MOVES * measured.total:
        shown = float(values[np.isfinite(values)][0])
        raise RecordError(
            f"Record {trial.name!r}: {column!r} shows {shown:.6g} {unit} all along, while {measured.channel} of the nominal scene moves by"
            f" {_range(simulated):.3g} {unit}: the sensor is dead, or the column is another one. Leave it out: record.without({column!r})."
        )


def _at_first(times: FloatArray, values: FloatArray, power: int) -> float:
    """Value (power 0) or slope (1) at the first time, by a polynomial of one degree more: a record may start to accelerate."""
    fitted = np.polynomial.Polynomial.fit(times, values, power + 1)
    return float((fitted.deriv() if power else fitted)(times[0]))


def _check_start(trial: Trial, column: str, simulated: FloatArray, units: Mapping[str, str]) -> None:
    """Speeds at the start: of a speed by its values, of an angle by its slope, which an offset does not change."""
    measured = trial.measured[column]
    unit = units.get(measured.channel, "")
    first = slice(0, FIRST)
    values = trial.columns[column][first]
    there = np.isfinite(values)
    if there.sum() < FIRST // 2 or trial.motions:
        return
    times = trial.times[first][there]
    if unit == "rad/s" and measured.offset == 0.0:
        power, scale = 0, 2.0 / np.sqrt(len(times))
    elif unit == "rad":
        power, scale = 1, 4.0 / float(np.sqrt(np.sum((times - times.mean()) ** 2)))
    else:
        return
    real, model = (_at_first(times, part[first][there], power) for part in (trial.columns[column], simulated))
    rates = np.diff(trial.columns[column][::FIRST]) / (FIRST * trial.every) if power else trial.columns[column]
    if abs(real - model) > max(START * measured.total * scale, SHARE * _range(rates)):
        raise RecordError(
            f"Record {trial.name!r} does not start like the scene: {column!r} begins at {real:.4g} rad/s, the nominal scene at"
            f" {model:.4g} rad/s. Give its start with Bench(speeds={{...}}, angles={{...}}), take record.between(start, end) from rest on,"
            " hold the drive to its measured motion (hm.smoothed_motion), or, of a sensor of unknown zero, Measured(..., offset=...)."
        )
