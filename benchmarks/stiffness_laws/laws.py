"""The laws to compare, all fitted to the catalogue curve of Table 1 up to 137 N m."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import option, parameter
from models.harmonic_drive_train import catalogue

LARGEST_TORQUE = 137.0
"""N m: the last row of Table 1."""

CATALOGUE, CUBIC, JUMP, LITERAL, CONTINUOUS = "catalogue", "cubic", "jump, torque", "jump, literal", "continuous"


def laws() -> dict[str, hm.StiffnessLaw]:
    """(7)-(10); Fig. 6; (11)-(14) read as torque and literally as stiffness; (15)-(17)."""
    curve = catalogue()
    return {
        CATALOGUE: curve,
        CUBIC: hm.CubicStiffness.fitted_to(curve, largest_torque=LARGEST_TORQUE),
        JUMP: hm.JumpTorqueStiffness.fitted_to(curve, largest_torque=LARGEST_TORQUE),
        LITERAL: hm.JumpSecantStiffness.fitted_to(curve, largest_torque=LARGEST_TORQUE),
        CONTINUOUS: hm.ContinuousStiffness.fitted_to(curve, largest_torque=LARGEST_TORQUE),
    }


@dataclass(frozen=True, kw_only=True)
class SmoothedJump(hm.StiffnessLaw):
    """The jump law with its step drawn out to a ramp of a given width: what it tends to.

    M(phi) = M_jump(phi) * clip((|phi| - phi0/2) / width, 0, 1)

    It has a steady state at every torque; the motion of the jump law is compared with it.
    """

    jump: hm.StiffnessLaw = option("the law with a jump at the edge of its gap")
    width: float = parameter("rad", "width of the ramp", above=0.0)

    @property
    def half_gap(self) -> float:
        return self.jump.half_gap

    def torque(self, twist: Value) -> Value:
        size = np.abs(twist)
        outside = self.jump.torque(np.maximum(size, self.half_gap * (1.0 + 1e-12)))
        return np.sign(twist) * outside * np.clip((size - self.half_gap) / self.width, 0.0, 1.0)
