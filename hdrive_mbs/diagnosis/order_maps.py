"""Orders in what is left of the records over speed, for the pictures of an answer."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.along import along, network_of
from hdrive_mbs.diagnosis.bench import units_of
from hdrive_mbs.diagnosis.curves import order_map
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.result import OrderMap
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.turning import reference_place

FloatArray = npt.NDArray[np.float64]


def order_maps(simulator: Simulator, refit: Fitted, effect: Fitted | None) -> tuple[OrderMap, ...]:
    """One for each trial in which the shaft of the motor runs through speeds: of the column with most left, the worst trial first.

    effect : with the claimed cause, None where none is claimed
    """
    models = [simulator.columns(item.hypothesis, item.z) for item in (refit, effect) if item is not None]
    found = []
    for number, trial in enumerate(simulator.trials):
        shaft = _shaft(simulator, number, effect or refit)
        left = [_left(trial, model[number]) for model in models]
        if shaft is None or not left[0]:
            continue
        sizes = {column: float(np.nanstd(values)) / trial.measured[column].total for column, values in left[0].items()}
        worst = max(sizes, key=lambda column: sizes[column])
        unit = units_of(trial.scene.network()).get(trial.measured[worst].channel, "")
        after = left[1].get(worst) if len(left) > 1 else None
        made = order_map(trial.name, worst, unit, shaft[0], trial.times, shaft[1], left[0][worst], after)
        if made is not None:
            found.append((sizes[worst], made))
    return tuple(item for _, item in sorted(found, key=lambda item: -item[0]))


def _shaft(simulator: Simulator, number: int, fitted: Fitted) -> tuple[str, FloatArray] | None:
    """Name and angle of the shaft whose turns are counted."""
    network = network_of(simulator, number, fitted)
    found = None if network is None else reference_place(network)
    if found is None:
        return None
    angle = along(simulator, number, fitted, [f"{found[0]}.angle"]).get(f"{found[0]}.angle")
    return None if angle is None else (found[0], angle)


def _left(trial: Trial, simulated: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    """Measured minus simulated without its mean, of columns that have some."""
    left = {column: values - simulated[column] for column, values in trial.columns.items() if column in simulated}
    return {column: values - np.nanmean(values) for column, values in left.items() if np.isfinite(values).any()}
