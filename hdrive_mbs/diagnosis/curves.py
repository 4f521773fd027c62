"""Curves for the pictures of an answer: loops of a connection, and orders in a residual over speed."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.signals.waterfall import waterfall
from hdrive_mbs.diagnosis.result import Loop, OrderMap
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.signals import TimeHistory

FloatArray = npt.NDArray[np.float64]
Pair = tuple[FloatArray, FloatArray]

POINTS = 3000
"""Most points of a loop."""
LOWEST, HIGHEST, REVOLUTIONS, PIECES = 0.25, 12.0, 8.0, 40
"""Orders of a map, revolutions of each of its pieces, and their number; below the lowest there is drift."""


def loop_of(record: str, at: str, refit: Pair, effect: Pair | None, force: FloatArray | None) -> Loop:
    """Torque against twist of a connection during a record.

    refit, effect : (twist, torque) along the runs of both models
    force : unknown torque beside that of the connection, which the refitted model lacks; with it the loop counts as measured
    """
    thin = slice(None, None, max(1, -(-len(refit[0]) // POINTS)))
    nothing = np.empty((2, 0))
    return Loop(
        record=record,
        at=at,
        measured=nothing if force is None else np.array([refit[0], refit[1] + force])[:, thin],
        refit=np.array(refit)[:, thin],
        effect=nothing if effect is None else np.array(effect)[:, thin],
    )


def order_map(
    record: str,
    column: str,
    unit: str,
    reference: str,
    times: FloatArray,
    angle: FloatArray,
    before: FloatArray,
    after: FloatArray | None = None,
) -> OrderMap | None:
    """Amplitudes of a residual over speed and order, on the longest stretch on which the shaft keeps turning one way.

    angle : of the reference shaft [rad] at the times;  before, after : residuals in the unit; gaps count as zero

    None where the shaft turns too little for it.
    """
    shaft = TimeHistory(f"{reference}.angle", "rad", times, angle)
    maps = []
    for residual in (before, before if after is None else after):
        history = TimeHistory(column, unit, times, np.nan_to_num(residual, nan=0.0))
        try:
            maps.append(waterfall(history, reference=shaft, axis="order", pieces=PIECES, length=REVOLUTIONS))
        except (AnalysisError, ParameterError):
            return None
    first = maps[0]
    shown = (first.lines >= LOWEST) & (first.lines <= HIGHEST)
    other = np.full((len(first.speeds), int(shown.sum())), np.nan) if after is None else maps[1].amplitude[:, shown]
    return OrderMap(
        record=record,
        column=column,
        unit=unit,
        reference=reference,
        speeds=first.speeds,
        orders=first.lines[shown],
        before=first.amplitude[:, shown],
        after=other,
    )
