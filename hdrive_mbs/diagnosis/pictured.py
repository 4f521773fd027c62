"""A located force as the report shows it: thinned, and told apart by what it acts on."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.diagnosis import result
from hdrive_mbs.diagnosis.locate.latent_force import LatentForce

POINTS = 3000
"""Most points of a picture."""


def pictured(force: LatentForce) -> result.LatentForce:
    """The force over time, and over speed and angle of its place or, for a connection, over its twist and torque."""
    thin = slice(None, None, max(1, -(-len(force.times) // POINTS)))
    between = bool(np.isfinite(force.torque).any())
    nothing = np.empty(0)
    return result.LatentForce(
        at=force.at,
        way=force.way,
        unit=force.unit,
        record=force.record,
        times=force.times[thin],
        force=force.force[thin],
        speed=force.speed[thin],
        angle=nothing if between else force.angle[thin],
        twist=force.angle[thin] if between else nothing,
        torque=force.torque[thin] if between else nothing,
    )
