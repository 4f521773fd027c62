"""Stiffness and damping of a bearing about its static position."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hdrive_mbs.bearings.gradients import FREE, at_rest, derivatives
from hdrive_mbs.bearings.law import BearingLaw
from hdrive_mbs.bearings.linear import LinearBearing
from hdrive_mbs.bearings.static_position import static_position


def linearised(law: BearingLaw, load: Sequence[float], speed: float, angle: float) -> LinearBearing:
    """See BearingLaw.linearised."""
    of = derivatives(law)
    position = static_position(law, of, load, speed, angle)
    _, stiffness, damping = of(at_rest(position[:FREE], speed, angle))
    whole = np.zeros((2, 6, 6))
    whole[:, :FREE, :FREE] = stiffness, damping
    return LinearBearing.from_matrices(stiffness=whole[0], damping=whole[1])
