"""Friction of a bearing, on top of any bearing law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.bearings.law import BearingLaw, FloatArray, RelativeMotion
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import option, parameter

_SMALL_FORCE = 1e-6
"""N; keeps the derivative of the radial load finite where it is zero."""


@dataclass(frozen=True, kw_only=True)
class WithFriction(BearingLaw):
    """Another law with dry friction along and about the axis.

    F_z = mu N tanh(z'/v_0),  M_phi = mu_t (d_B/2) N tanh((d_B/2) phi'/v_0),  N = sqrt(F_Bx^2 + F_By^2)

    added to the forces F_B of the inner law, matrices included; the opposite acts on the ring.

    Source: seed M (7), which gives the force on the ring, with sign(v) made smooth.  Leaves out
    sticking (below v_0 it creeps), drag without load, and that sliding along and about the axis
    share one friction force.  Linearised at rest in z it is a strong damper, mu N/v_0.
    """

    law: BearingLaw = option("the bearing law that carries the load")
    bore: float = parameter("m", "diameter d_B of the inner race", above=0.0)
    friction: float = parameter("1", "axial friction coefficient mu", default=0.0, low=0.0, high=2.0)
    turning_friction: float = parameter("1", "friction coefficient mu_t of turning", default=0.0, low=0.0, high=2.0)
    smoothing_speed: float = parameter("m/s", "sliding speed v_0 of the smooth step through zero", default=1e-4, above=0.0)

    def check(self) -> None:
        if not isinstance(self.law, BearingLaw):
            raise ParameterError(f"WithFriction.law = {self.law!r}: must be a bearing law, like LinearBearing(...).")

    def stiffness_matrix(self) -> FloatArray:
        return self.law.stiffness_matrix()

    def damping_matrix(self) -> FloatArray:
        return self.law.damping_matrix()

    def forces(self, motion: RelativeMotion) -> Mapping[str, Value]:
        inner = dict(self.law.forces(motion))
        total = self.law.total_forces(motion)
        load = np.sqrt(total["x"] * total["x"] + total["y"] * total["y"] + _SMALL_FORCE**2)
        radius = 0.5 * self.bore
        along = self.friction * load * np.tanh(motion.vz / self.smoothing_speed)
        about = self.turning_friction * radius * load * np.tanh(radius * motion.speed / self.smoothing_speed)
        return {**inner, "z": inner.get("z", 0.0) + along, "phi": inner.get("phi", 0.0) + about}
