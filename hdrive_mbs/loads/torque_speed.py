"""Load torque from a table over speed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.loads.law import LoadLaw
from hdrive_mbs.quantities import option, table
from hdrive_mbs.tables import check_table


@dataclass(frozen=True, kw_only=True)
class TorqueSpeedLoad(LoadLaw):
    """Straight lines between (speed, torque); beyond the table the end values hold.

    symmetry = 'none': the table is over all forward speeds, both signs.
    symmetry = 'odd':  the table is over w >= 0 and M(-w) = -M(w): a load that always resists; with a
        torque at w = 0 it jumps there like dry friction, without sticking.
    symmetry = 'even': M(-w) = M(w): the torque keeps its sense, as a weight on a drum does.

    Leaves out the time a machine takes to follow its own curve.
    """

    speeds: tuple[float, ...] = table("rad/s", "forward speeds, rising")
    torques: tuple[float, ...] = table("N m", "torques at these speeds")
    symmetry: str = option("'none', 'odd' or 'even': what holds for negative speed")

    def check(self) -> None:
        if self.symmetry not in ("none", "odd", "even"):
            raise ParameterError(f"TorqueSpeedLoad.symmetry = {self.symmetry!r}: must be 'none', 'odd' or 'even'.")
        check_table(self, "speeds", "torques")
        if self.symmetry != "none" and self.speeds[0] < 0.0:
            raise ParameterError(
                f"TorqueSpeedLoad.speeds[0] = {self.speeds[0]:g} rad/s: with symmetry={self.symmetry!r} the table is over speeds from "
                "0 rad/s upwards; remove the negative ones or take symmetry='none'."
            )

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        if self.symmetry == "none":
            return np.interp(speed, self.speeds, self.torques)
        value = np.interp(np.abs(speed), self.speeds, self.torques)
        return np.sign(speed) * value if self.symmetry == "odd" else value
