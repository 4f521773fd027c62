"""A surface under displacement probes that is not round."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.lateral_effect import moving_station
from hdrive_mbs.errors import PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.sensor_draft import SensorDraft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ProbeRunout(Effect):
    """Runout that all displacement sensors of a place read with the motion of its centre.

    seen = x + sum(A_n cos(n (f - d) + p_n)),  n = 1, 2, 3

    with the twisted spin angle f of the place and the direction d of the sensor, 0 for x, a quarter turn for y, or the angle of a
    ``Probe``: the y sensor sees each spot a quarter turn later.  Mechanical (an eccentric or oval surface) or electrical (of the material).

    Source: API Standard 670, runout; slow-roll compensation, Bently, Hatch, Fundamentals of Rotating Machinery
    Diagnostics (2002), ch. 11.  Leaves out scratches (high orders) and that the surface passes the probe at a
    slope while the shaft vibrates.
    """

    once: float = parameter("m", "A_1 once per turn, 0-peak", low=0.0, high=1e-2, typical=(1e-9, 1e-4))
    once_phase: float = parameter("rad", "p_1, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    twice: float = parameter("m", "A_2 twice per turn, 0-peak", default=0.0, low=0.0, high=1e-2, typical=(1e-9, 1e-4))
    twice_phase: float = parameter("rad", "p_2, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    thrice: float = parameter("m", "A_3 three times per turn, 0-peak", default=0.0, low=0.0, high=1e-2, typical=(1e-9, 1e-4))
    thrice_phase: float = parameter("rad", "p_3, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))

    acts_on: ClassVar[str] = "surface"
    kind: ClassVar[str] = "sensor"
    family: ClassVar[str] = "probe_runout"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("once", "once_phase"), ("twice", "twice_phase"), ("thrice", "thrice_phase"))
    signature: ClassVar[str] = "the same circle once per turn at every speed, at one place, with no force that belongs to it"

    def runout(self, angle: Value) -> Value:
        """Surface [m] beyond its mean, at a spin angle of the place less that of the sensor [rad]."""
        parts = ((1, self.once, self.once_phase), (2, self.twice, self.twice_phase), (3, self.thrice, self.thrice_phase))
        return sum((size * np.cos(order * angle + phase) for order, size, phase in parts if size != 0.0), 0.0 * angle)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        spin = moving_station(self, draft, place).stretch("phi")
        looking = [(sensor, draft.probed(sensor.source.quantity)) for sensor in draft.sensors]
        known = list(dict.fromkeys(seen.place for _, seen in looking if seen is not None))
        if place not in known:
            places = ", ".join(known) or "none"
            raise PlaceError(
                f"ProbeRunout at {place!r} needs a Sensor that reads {place}.x or {place}.y, or a Probe there. Places with one: {places}."
            )
        for sensor, seen in looking:
            if seen is not None and seen.place == place:
                draft.keep_true_reading(sensor)
                sensor.seen = self._seen(sensor, seen.direction, spin)

    def _seen(self, sensor: SensorDraft, direction: float, spin: dict[str, float]) -> Callable[[Moment], Value]:
        before = sensor.seen

        def seen(moment: Moment) -> Value:
            angle = sum(factor * moment.angle(coordinate) for coordinate, factor in spin.items())
            return before(moment) + self.runout(angle - direction)

        return seen
