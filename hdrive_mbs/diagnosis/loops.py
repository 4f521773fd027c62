"""Loops of torque over twist of the connection that a gap sits at, for the pictures of an answer."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.along import along
from hdrive_mbs.diagnosis.curves import loop_of
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.locate.latent_force import LatentForce
from hdrive_mbs.diagnosis.result import Loop
from hdrive_mbs.diagnosis.simulator import Simulator

FloatArray = npt.NDArray[np.float64]

TORSION = "torsion"
"""Way of an unknown torque between the ends of a connection."""


def loops(
    simulator: Simulator, refit: Fitted, effect: Fitted | None, places: Sequence[str], forces: Sequence[LatentForce]
) -> tuple[Loop, ...]:
    """One for each trial, that in which the models differ most first; none where no place is a connection.

    effect : with the claimed cause, None where none is claimed
    places : where causes are claimed.  A connection with an unknown torque comes first; of a rotor line, whose sections bend, no other
    forces : unknown torques of the refitted model
    """
    known = dict.fromkeys(force.at for force in forces if force.way == TORSION)
    bending = any(trial.scene.network().is_lateral for trial in simulator.trials)
    for at in dict.fromkeys([*(place for place in places if place in known), *known, *(() if bending else places)]):
        found = [loop for number in range(len(simulator.trials)) for loop in _loop(simulator, number, at, refit, effect, forces)]
        if found:
            return tuple(loop for _, loop in sorted(found, key=lambda item: -item[0]))
    return ()


def _loop(
    simulator: Simulator, number: int, at: str, refit: Fitted, effect: Fitted | None, forces: Sequence[LatentForce]
) -> list[tuple[float, Loop]]:
    """How far the torques differ, and the loop; nothing where the trial has no such connection."""
    trial, names = simulator.trials[number], (f"{at}.twist", f"{at}.torque")
    before = along(simulator, number, refit, names)
    if len(before) < len(names) or not np.ptp(before[names[0]]) > 0.0:
        return []
    after = along(simulator, number, effect, names) if effect is not None else {}
    pair = (after[names[0]], after[names[1]]) if len(after) == len(names) else None
    force = next((item.force for item in forces if (item.at, item.way, item.record) == (at, TORSION, trial.name)), None)
    changed = force if force is not None else pair[1] - before[names[1]] if pair is not None else np.zeros(1)
    loop = loop_of(trial.name, at, (before[names[0]], before[names[1]]), pair, force)
    return [(float(np.sqrt(np.mean(changed**2))), loop)]
