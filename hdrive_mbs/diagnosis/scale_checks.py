"""Columns that are a factor of a unit away from what the nominal model does.

A column y and its simulation s, both without their mean, are compared by least squares: y = c s.  Where they go together and c
is 180/pi, 1000 or the like or one over it, the column was read in the wrong unit: gains of sensors are some per cent off.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import RecordError
from hdrive_mbs.units import factor

FloatArray = npt.NDArray[np.float64]

OTHERS = {
    "rad": ("deg", "revolution"),
    "rad/s": ("rpm", "deg/s", "revolution/s"),
    "N m": ("mN*m", "kN*m"),
    "m": ("mm", "um"),
    "m/s": ("mm/s",),
    "m/s^2": ("g_0", "mm/s^2"),
    "N": ("kN",),
}
"""Unit of a scene -> units that a log may be in instead."""
CLEAR = 0.98
"""Squared correlation from which a factor is believed."""
NEAR = 0.1
"""Relative deviation from a known factor: a nominal model is wrong by some per cent."""


def check_scale(trial: Trial, column: str, simulated: FloatArray, unit: str) -> None:
    """Raise RecordError where a column goes with its simulation [unit] but by the factor of another unit."""
    values = trial.columns[column]
    there = np.isfinite(values) & np.isfinite(simulated)
    if there.sum() < 2 or unit not in OTHERS:
        return
    y, s = (item[there] - np.mean(item[there]) for item in (values, simulated))
    power, own, both = float(s @ s), float(y @ y), float(y @ s)
    if power == 0.0 or own == 0.0 or both * both < CLEAR * power * own:
        return
    causes = list(_causes(both / power, unit))
    if causes:
        raise RecordError(
            f"Record {trial.name!r}: {column!r} is {both / power:.4g} times what {trial.measured[column].channel} of the nominal scene"
            f" does, as if {' or '.join(causes)}. Give the unit of the numbers when reading, units={{{column!r}: ...}},"
            " or the column the channel that it measures."
        )


def _causes(ratio: float, unit: str) -> Iterator[str]:
    for other in OTHERS[unit]:
        size = factor(other, unit, "scale check")
        if abs(ratio * size - 1.0) < NEAR:
            yield f"its numbers were in {other} and had been read as {unit}"
        if abs(ratio / size - 1.0) < NEAR:
            yield f"its numbers were in {unit} and had been read as {other}"
