"""Load torque from a table over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.loads.law import LoadLaw
from hdrive_mbs.quantities import option, table
from hdrive_mbs.tables import check_table


@dataclass(frozen=True, kw_only=True)
class TableTorque(LoadLaw):
    """Straight lines between (time, torque); before the first and after the last point constant.

    With ``periodic`` the table repeats for all times, and must end with the torque it starts with.
    """

    times: tuple[float, ...] = table("s", "times, rising")
    torques: tuple[float, ...] = table("N m", "torques at these times")
    periodic: bool = option("whether the table repeats", default=False)

    def check(self) -> None:
        check_table(self, "times", "torques")
        torques = self.torques
        if self.periodic and torques[0] != torques[-1]:
            raise ParameterError(
                f"TableTorque repeats but ends with {torques[-1]:g} N m and starts with {torques[0]:g} N m; "
                "make both ends equal (add a point at the end of the period)."
            )

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        if self.periodic:
            time = self.times[0] + np.mod(time - self.times[0], self.times[-1] - self.times[0])
        return np.interp(time, self.times, self.torques)
