"""Columns that are a factor of a unit away from what the nominal model does.

A column y and its simulation s, both without their mean, are compared by least squares: y = c s.  Where they go together and c
is 180/pi, 1000 or the like or one over it, the column was read in the wrong unit: gains of sensors are some per cent off.

A column that turns against its simulation was read with the wrong sign, or the model's gear reverses where the real one does not.

Where a cause is missing the model may do something else, and then a column is held against another one: how far two places turn
against each other is a matter of ratios, which friction does not change.  What that shows is no refusal but a warning.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.errors import RecordError

FloatArray = npt.NDArray[np.float64]

OTHERS: Mapping[str, Mapping[str, float]] = {
    "rad": {"deg": math.pi / 180.0, "revolution": math.tau},
    "rad/s": {"rpm": math.pi / 30.0, "deg/s": math.pi / 180.0, "revolution/s": math.tau},
    "N m": {"mN*m": 1e-3, "kN*m": 1e3},
    "m": {"mm": 1e-3, "um": 1e-6},
    "m/s": {"mm/s": 1e-3},
    "m/s^2": {"g_0": 9.80665, "mm/s^2": 1e-3},
    "N": {"kN": 1e3},
}
"""Unit of a scene -> units that a log may be in instead, with their size."""
CLEAR = 0.98
"""Squared correlation from which a factor is believed."""
LIKELY = 0.9
"""The same from which one is worth a warning."""
OPPOSED = 0.5
"""Squared correlation from which the sense of a motion is taken for clear: with the wrong sign, the model goes quite another way."""
TIED = 0.999
"""Squared correlation of two columns of the model from which one follows from the other."""
NEAR = 0.1
"""Relative deviation from a known factor: a nominal model is wrong by some per cent."""


def check_scale(trial: Trial, column: str, simulated: FloatArray, unit: str) -> None:
    """Raise RecordError where a column goes with its simulation [unit] but by the factor of another unit."""
    pair = _together(trial.columns[column], simulated, CLEAR) if unit in OTHERS else None
    if pair is None:
        return
    y, s = pair
    ratio = float(y @ s) / float(s @ s)
    causes = list(_causes(ratio, unit))
    if causes:
        raise RecordError(
            f"Record {trial.name!r}: {column!r} is {ratio:.4g} times what {trial.measured[column].channel} of the nominal scene"
            f" does, as if {' or '.join(causes)}. Give the unit of the numbers when reading, units={{{column!r}: ...}},"
            " or the column the channel that it measures."
        )


def looks_scaled(simulator: Simulator, factors: Sequence[Factor]) -> tuple[str, ...]:
    """Columns that look as if they were in another unit, by their simulation or by another column, in words; one line for each."""
    hypothesis = Hypothesis(factors=tuple(factors))
    simulated = simulator.columns(hypothesis, np.zeros(hypothesis.size))
    found: dict[str, str] = {}
    for trial, own in zip(simulator.trials, simulated, strict=True):
        if not own:
            continue
        network = trial.scene.network()
        units = {channel.name: channel.unit for channel in network.channels}
        of = {column: units.get(item.channel, "") for column, item in trial.measured.items()}
        for column, why in (*_by_itself(trial, own, of), *_by_another(trial, own, of)):
            way_out = f"Give its unit when reading: --unit {column}=... (under its name in the file)."
            found.setdefault(column, f"Record {trial.name!r}: column {column!r} looks {why} {way_out}")
        for column in () if network.is_lateral else _turned(trial, own, of):
            found.setdefault(
                column,
                f"Record {trial.name!r}: column {column!r} runs against what {trial.measured[column].channel} of the nominal model does."
                f" Turn its sign round when reading, like --unit {column}='-1 {of[column]}' (its name and its unit in the file), or the"
                " sense of the model, like HarmonicDrive.output_sense.",
            )
    return tuple(found.values())


def _turned(trial: Trial, simulated: Mapping[str, FloatArray], units: Mapping[str, str]) -> Iterator[str]:
    """Columns that move as the model does, but the other way round, where another one moves the same way."""
    senses = {column: _sense(values, simulated[column]) for column, values in trial.columns.items() if units[column] in ("rad", "rad/s")}
    if any(sense > 0.0 for sense in senses.values()):
        yield from (column for column, sense in senses.items() if sense < 0.0)


def _sense(values: FloatArray, reference: FloatArray) -> float:
    """1 or -1 where two courses go together or against each other, 0 where neither is clear."""
    pair = _together(values, reference, OPPOSED)
    return 0.0 if pair is None else math.copysign(1.0, float(pair[0] @ pair[1]))


def _by_itself(trial: Trial, simulated: Mapping[str, FloatArray], units: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    for column, values in trial.columns.items():
        ratio = _ratio(values, simulated[column], LIKELY) if units[column] in OTHERS else None
        causes = list(_causes(ratio, units[column])) if ratio is not None else []
        if causes:
            yield column, f"as if {' or '.join(causes)}: it is {ratio:.3g} times what the nominal model does."


def _by_another(trial: Trial, simulated: Mapping[str, FloatArray], units: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Angles, or speeds summed up, of which one follows from the other in the model."""
    turning = [column for column in trial.columns if units[column] in ("rad", "rad/s") and trial.measured[column].offset == 0.0]
    for k, first in enumerate(turning):
        for second in turning[k + 1 :]:
            measured, model = (
                [_angle(of[name], units[name], trial.every) for name in (first, second)] for of in (trial.columns, simulated)
            )
            real, nominal = _ratio(measured[1], measured[0], CLEAR), _ratio(model[1], model[0], TIED)
            if real is None or nominal is None or nominal == 0.0:
                continue
            off = [abs(math.log(float(np.std(y)) / float(np.std(s)))) for y, s in zip(measured, model, strict=True)]
            column, other, ratio = (second, first, real / nominal) if off[1] >= off[0] else (first, second, nominal / real)
            causes = list(_causes(ratio, units[column]))
            if causes:
                yield column, f"as if {' or '.join(causes)}: beside {other!r} it moves {ratio:.3g} times as much as in the nominal model."


def _angle(values: FloatArray, unit: str, every: float) -> FloatArray:
    """An angle, or the one that a speed sums up to, without its straight line, in which an unknown start or drift would show [rad]."""
    finite = np.where(np.isfinite(values), values, np.nanmean(values) if np.isfinite(values).any() else 0.0)
    angle = np.cumsum(finite) * every if unit == "rad/s" else finite
    at = np.arange(len(angle))
    return np.asarray(angle - np.polyval(np.polyfit(at, angle, 1), at))


def _ratio(values: FloatArray, reference: FloatArray, together: float) -> float | None:
    """Ratio through zero of what both leave of their means, by least absolute differences; None where they do not go together.

    together : least squared correlation
    """
    pair = _together(values, reference, together)
    if pair is None:
        return None
    y, s = pair
    moves = s != 0.0
    ratios, weights = y[moves] / s[moves], np.abs(s[moves])
    order = np.argsort(ratios)
    passed = np.cumsum(weights[order])
    return float(ratios[order][np.searchsorted(passed, 0.5 * passed[-1])])


def _together(values: FloatArray, reference: FloatArray, least: float) -> tuple[FloatArray, FloatArray] | None:
    """What both leave of their means where both are known; None where their squared correlation is less than ``least``."""
    there = np.isfinite(values) & np.isfinite(reference)
    if there.sum() < 2:
        return None
    y, s = (item[there] - np.mean(item[there]) for item in (values, reference))
    power, own, both = float(s @ s), float(y @ y), float(y @ s)
    return None if power == 0.0 or own == 0.0 or both * both < least * power * own else (y, s)


def _causes(ratio: float, unit: str) -> Iterator[str]:
    for other, size in OTHERS[unit].items():
        if abs(ratio * size - 1.0) < NEAR:
            yield f"its numbers were in {other} and had been read as {unit}"
        if abs(ratio / size - 1.0) < NEAR:
            yield f"its numbers were in {unit} and had been read as {other}"
