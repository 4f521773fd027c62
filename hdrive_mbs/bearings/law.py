"""What a bearing law is: forces from the motion of the inner ring relative to the housing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import LawError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import Described

if TYPE_CHECKING:
    from hdrive_mbs.bearings.linear import LinearBearing

FloatArray = npt.NDArray[np.float64]

DIRECTIONS = ("x", "y", "z", "psi", "theta", "phi")
"""Order of all 6-vectors and matrices: displacements [m], tilts psi about x and theta about y [rad], spin phi [rad]."""


@dataclass(frozen=True, kw_only=True)
class RelativeMotion:
    """Motion of the inner ring against the housing, seen from the fixed frame.

    x, y, z : displacement [m]; the housing moves in x and y only
    psi, theta : tilts about x and y [rad]
    vx, vy, vz, psi_rate, theta_rate : their rates [m/s, rad/s]
    angle, speed : spin angle [rad] and spin speed [rad/s] of the ring, true sense about z
    """

    x: Value
    y: Value
    z: Value
    psi: Value
    theta: Value
    vx: Value
    vy: Value
    vz: Value
    psi_rate: Value
    theta_rate: Value
    angle: Value
    speed: Value


@dataclass(frozen=True, kw_only=True)
class BearingLaw(Described):
    """Forces of a bearing.  A user's own law subclasses this and gives any of the three.

    Forces are counted as the ring puts them on the housing (F_B of seed M (5)), so a positive force
    resists a positive displacement; the opposite acts on the ring.
    """

    _kind: ClassVar[str] = "bearing law"
    _use: ClassVar[str] = "hm.Bearing(law={name}(...)) takes it"

    def stiffness_matrix(self) -> FloatArray:
        """Constant part K of F = K d + D d' + forces(), 6x6 over DIRECTIONS [N/m, N/rad, N m/m, N m/rad]."""
        return np.zeros((6, 6))

    def damping_matrix(self) -> FloatArray:
        """Constant part D, 6x6 [N s/m, ...]."""
        return np.zeros((6, 6))

    def forces(self, motion: RelativeMotion) -> Mapping[str, Value]:
        """What comes on top of the matrices: direction -> force [N] or moment [N m]; pure, written with numpy."""
        return {}

    def total_forces(self, motion: RelativeMotion) -> dict[str, Value]:
        """K d + D d' + forces(): what the ring puts on the housing, in all six directions [N, N m].

        Raises LawError where ``forces`` names something that is no direction.
        """
        own = self.forces(motion)
        unknown = set(own) - set(DIRECTIONS)
        if unknown:
            raise LawError(f"{type(self).__name__}.forces gives {', '.join(sorted(unknown))}; directions are {', '.join(DIRECTIONS)}.")
        displaced = (motion.x, motion.y, motion.z, motion.psi, motion.theta)
        rates = (motion.vx, motion.vy, motion.vz, motion.psi_rate, motion.theta_rate)
        total: dict[str, Value] = {}
        for direction, k_row, d_row in zip(DIRECTIONS, self.stiffness_matrix(), self.damping_matrix(), strict=True):
            total[direction] = own.get(direction, 0.0)
            for factors, values in ((k_row, displaced), (d_row, rates)):
                for factor, value in zip(factors, values):
                    if factor != 0.0:
                        total[direction] = total[direction] + float(factor) * value
        return total

    def static_position(self, *, load: Sequence[float], speed: float, angle: float = 0.0) -> FloatArray:
        """Displacement over DIRECTIONS [m, rad] at which the bearing carries a load, without vibration.

        load : (Fx, Fy) [N] that the ring puts on the housing: (0, -W) for a weight W
        speed, angle : spin speed [rad/s] and spin angle [rad]

        Raises AnalysisError where there is no such position.
        """
        from hdrive_mbs.bearings.gradients import derivatives
        from hdrive_mbs.bearings.static_position import static_position

        return static_position(self, derivatives(self), load, speed, angle)

    def linearised(self, *, load: Sequence[float], speed: float, angle: float = 0.0) -> LinearBearing:
        """Stiffness dF/dd and damping dF/dd' about the static position under a load, as a LinearBearing.

        load, speed, angle : as in ``static_position``

        Spin angle and speed are held, so row and column of phi are zero.  A law that depends on the
        angle (a ball bearing) is linearised at this one.  Motion of the result counts from the static
        position: give it the vibration, not the static load.
        """
        from hdrive_mbs.bearings.linearisation import linearised

        return linearised(self, load, speed, angle)
