"""An encoder whose disc sits off the axis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.harmonics import harmonics
from hdrive_mbs.effects.places import angle_sensors
from hdrive_mbs.effects.sensor_effect import SensorEffect
from hdrive_mbs.errors import PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class EncoderEccentricity(SensorEffect):
    """Reading of an angle with an error that repeats with the angle.

    seen = x + A sin(n x + p) + B sin(2 n x + q) + c

    with the true angle x; c = -A sin(p) - B sin(q) is an encoder that is set to zero at the start.  A
    disc off its axis by e, read at the radius R by one head, gives n = 1 and A = e/R; a bent disc or two heads leave n = 2.

    Source: geometry of graduated discs, in the first order of e/R.  Leaves out division errors of the disc and of
    the interpolation between its lines (high orders: further effects).
    """

    amplitude: float = parameter("rad", "A, 0-peak", low=0.0, high=0.5, typical=(1e-6, 0.02))
    order: float = parameter("1", "n, periods per turn", default=1.0, above=0.0, high=1e5)
    phase: float = parameter("rad", "p, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    second_amplitude: float = parameter("rad", "B, 0-peak", default=0.0, low=0.0, high=0.5, typical=(1e-7, 0.02))
    second_phase: float = parameter("rad", "q, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    offset: float = parameter("rad", "c, by which the zero is off", default=0.0, low=-10.0, high=10.0, typical=(-0.02, 0.02))

    family: ClassVar[str] = "encoder_eccentricity"
    signature: ClassVar[str] = "one angle off by a sine of itself at every speed, with no torque that belongs to it"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"), ("second_amplitude", "second_phase"))
    additive: ClassVar[tuple[str, ...]] = ("offset",)
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"order": (1.0, 2.0)}

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        """Sensors that read an angle."""
        return angle_sensors(network)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        quantity = draft.root_quantity(draft.sensor(place, type(self).__name__))
        if not quantity.endswith(".angle"):
            raise PlaceError(f"EncoderEccentricity needs a sensor that reads the angle of a place, but {place!r} reads {quantity!r}.")
        super().apply(draft, place, name)

    def reading(self, time: Value, value: Value) -> Value:
        return (
            value + harmonics(value, self.order, ((self.amplitude, self.phase), (self.second_amplitude, self.second_phase))) + self.offset
        )
