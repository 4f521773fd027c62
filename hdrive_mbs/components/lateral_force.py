"""A force across the axis as a table over time: a hammer, a shaker."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.errors import ParameterError, SceneError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import option, table
from hdrive_mbs.tables import check_table, held


@dataclass(frozen=True, kw_only=True)
class LateralForce(Component):
    """F_x(t) and F_y(t) on the place that it is connected to, through the axis there, fixed in direction.

    Straight lines between the points, or each value held until the next time (a sampled command); before the first
    and after the last point constant.  Leaves out the mass of whatever pushes, and the length of the place it hits.
    """

    times: tuple[float, ...] = table("s", "times, rising")
    forces_x: tuple[float, ...] = table("N", "force in x at these times; none: no force in x", default=())
    forces_y: tuple[float, ...] = table("N", "force in y at these times; none: no force in y", default=())
    held: bool = option("whether each value is held until the next time", default=False)

    def check(self) -> None:
        for field in self._given():
            check_table(self, "times", field)
        if not self._given():
            raise ParameterError("LateralForce has neither forces_x nor forces_y; give at least one, in N.")

    def _given(self) -> tuple[str, ...]:
        return tuple(field for field in ("forces_x", "forces_y") if getattr(self, field))

    def force(self, direction: str, time: Value) -> Value:
        """Force [N] in "x" or "y" at a time [s]."""
        values = getattr(self, f"forces_{direction}")
        if not values:
            return 0.0 * time
        return held(time, self.times, values) if self.held else np.interp(time, self.times, values)

    def flanges(self) -> tuple[Flange, ...]:
        return (Flange(name="", lateral=True),)

    def build(self, name: str, draft: Draft) -> None:
        station = draft.station(name, f"LateralForce {name!r}")
        if station.held:
            raise SceneError(f"LateralForce {name!r} pushes the ground and does nothing; connect it to a place that can move.")
        for field in self._given():
            direction = field[-1]

            def push(moment: Moment, direction: str = direction) -> Value:
                return self.force(direction, moment.time)

            for coordinate, factor in station.stretch(direction).items():
                draft.add_torque(f"{name}.{direction} on {coordinate}", coordinate, lambda m, f=factor, push=push: f * push(m))  # type: ignore[misc]
            draft.add_channel(f"{name}.force_{direction}", "N", f"force of {name} in {direction}", push)
