"""The shaft whose turns are counted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hdrive_mbs.network.network import Network

if TYPE_CHECKING:  # which itself imports this
    from hdrive_mbs.diagnosis.locate.motion import Motion

FloatArray = npt.NDArray[np.float64]


def reference_place(network: Network) -> tuple[str, int] | None:
    """Name and sense of the coordinate that turns with the motor; None where nothing turns."""
    turning = [(body.name, body.sense, body.ratio) for body in network.bodies if not body.lateral]
    given = [(item.name, item.sense, item.ratio) for item in network.motions if item.name != "ground"]
    return next(((name, sense) for name, sense, ratio in (*given, *turning) if abs(ratio) == 1.0), None)


def reference_shaft(motion: Motion) -> tuple[FloatArray, FloatArray]:
    """Speed [rad/s] and angle [rad] of the shaft of the motor along a run, in its true sense; zeros where nothing turns."""
    network, times = motion.network, motion.trial.times
    found = reference_place(network)
    if found is None:
        return np.zeros(len(times)), np.zeros(len(times))
    name, sense = found
    if f"speed:{name}" in motion.values:
        return sense * motion.values[f"speed:{name}"], sense * motion.values[f"angle:{name}"]
    moment, shape = network.moment(times, {}, {}, {}), times.shape
    speed, angle = (np.broadcast_to(np.asarray(v, float), shape) for v in (moment.speed(name), moment.angle(name)))
    return sense * speed, sense * angle
