"""Which of the six directions the forces of a bearing law have to do with."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.bearings.gradients import NAMES
from hdrive_mbs.bearings.law import DIRECTIONS, BearingLaw, RelativeMotion
from hdrive_mbs.expression import TraceError, Value, record, trace, variable, variables

_DIRECTION_OF = {name: name.removesuffix("_rate").removeprefix("v") for name in NAMES} | {"angle": "phi", "speed": "phi"}


def directions_looked_at(law: BearingLaw) -> tuple[str, ...]:
    """Directions that ``forces()`` acts along or looks at, and those that its matrices couple unsymmetrically.

    All six for a law that cannot be recorded.  Empty for a law of symmetric constant matrices.
    """
    symbols = RelativeMotion(**{name: variable(name) for name in NAMES})
    recorded: dict[str, Value] = {}

    def total(motion: RelativeMotion) -> Value:
        recorded.update(law.forces(motion))
        return 0.0

    try:
        trace(total, symbols)
        names = variables(*(record(force) for force in recorded.values()))
    except TraceError:
        return DIRECTIONS
    found = set(recorded) | {_DIRECTION_OF[name] for name in names}
    for matrix in (law.stiffness_matrix(), law.damping_matrix()):
        skew = np.asarray(matrix, float) - np.asarray(matrix, float).T
        found |= {DIRECTIONS[k] for k in np.flatnonzero(np.any(skew != 0.0, axis=1))}
    return tuple(direction for direction in DIRECTIONS if direction in found)
