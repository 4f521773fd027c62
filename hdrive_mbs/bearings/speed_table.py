"""Stiffness and damping coefficients from a table over speed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from hdrive_mbs.bearings.coefficients import check_cross, check_pair
from hdrive_mbs.bearings.law import BearingLaw, RelativeMotion
from hdrive_mbs.bearings.radial import RadialBearing
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import table
from hdrive_mbs.tables import check_table

_ENTRIES = ("xx", "xy", "yx", "yy")


@dataclass(frozen=True, kw_only=True)
class TableBearing(RadialBearing):
    """Radial coefficients that depend on the spin speed, straight lines between the points.

    F_x = k_xx(|w|) x + k_xy(|w|) y + d_xx(|w|) vx + d_xy(|w|) vy,  F_y alike

    Beyond the table the first and last values hold.  The table is for positive spin (about +z).  A
    machine that turns the other way is its mirror image, in which x and y couple with the other
    sign: for negative speed the xy and yx coefficients change sign, the direct ones do not.

    Source: the form in which film bearings are calculated and measured (seed M (6) at each speed).
    Leaves out the dependence on amplitude and on the frequency of vibration.  Coefficients of a film hold about the journal's
    position under its load: displacements count from there, and Gravity is left out beside them.  With cross-coupled
    values at the first speed the force jumps where the spin passes through zero.
    """

    speeds: tuple[float, ...] = table("rad/s", "spin speeds, rising", low=0.0)
    stiffness_xx: tuple[float, ...] = table("N/m", "k_xx at these speeds")
    stiffness_yy: tuple[float, ...] = table("N/m", "k_yy at these speeds")
    stiffness_xy: tuple[float, ...] | None = table("N/m", "k_xy at these speeds", default=None)
    stiffness_yx: tuple[float, ...] | None = table("N/m", "k_yx at these speeds", default=None)
    damping_xx: tuple[float, ...] | None = table("N s/m", "d_xx at these speeds", default=None)
    damping_yy: tuple[float, ...] | None = table("N s/m", "d_yy at these speeds", default=None)
    damping_xy: tuple[float, ...] | None = table("N s/m", "d_xy at these speeds", default=None)
    damping_yx: tuple[float, ...] | None = table("N s/m", "d_yx at these speeds", default=None)

    def check(self) -> None:
        for prefix in ("stiffness", "damping"):
            check_cross(self, prefix)
            check_pair(self, f"{prefix}_xx", f"{prefix}_yy", "equal values for a bearing that is alike in x and y")
            for entry in _ENTRIES:
                if getattr(self, f"{prefix}_{entry}") is not None:
                    check_table(self, "speeds", f"{prefix}_{entry}")

    @classmethod
    def tabulated(cls, law: BearingLaw, *, load: Sequence[float], speeds: Sequence[float], angle: float = 0.0, **fields: Any) -> Self:
        """The radial coefficients of another law about its static position, at each of these speeds.

        load : (Fx, Fy) [N] that the ring puts on the housing; fields : axial and tilt values
        """
        at = [law.linearised(load=load, speed=float(speed), angle=angle) for speed in speeds]
        for prefix, matrices in (("stiffness", [b.stiffness_matrix() for b in at]), ("damping", [b.damping_matrix() for b in at])):
            for entry, place in zip(_ENTRIES, ((0, 0), (0, 1), (1, 0), (1, 1)), strict=True):
                fields[f"{prefix}_{entry}"] = tuple(float(matrix[place]) for matrix in matrices)
        return cls(speeds=tuple(speeds), **fields)

    def forces(self, motion: RelativeMotion) -> Mapping[str, Value]:
        speed = np.abs(motion.speed)
        sense = np.where(motion.speed < 0.0, -1.0, 1.0)

        def force(row: str, column: str) -> Value:
            """Force in direction ``row``, where ``column`` is the other one."""
            total: Value = 0.0
            for prefix, values in (("stiffness", {"x": motion.x, "y": motion.y}), ("damping", {"x": motion.vx, "y": motion.vy})):
                direct, cross = getattr(self, f"{prefix}_{row}{row}"), getattr(self, f"{prefix}_{row}{column}")
                if direct is not None:
                    total = total + np.interp(speed, self.speeds, direct) * values[row]
                if cross is not None:
                    total = total + sense * np.interp(speed, self.speeds, cross) * values[column]
            return total

        return {"x": force("x", "y"), "y": force("y", "x")}
