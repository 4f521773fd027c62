"""A neighbour that shakes a body about its axis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.effects.places import torsional_bodies
from hdrive_mbs.expression import Value
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ExternalTorque(TorqueEffect):
    """A torque of a fixed frequency on a body.

    tau = A sin(f t + p)

    with the time t of the run, whatever the body does.

    Source: forced torsional vibration, e.g. Den Hartog, Mechanical Vibrations (1956); a process force or a machine
    beside the bench.  Leaves out how the neighbour starts and stops.
    """

    amplitude: float = parameter("N m", "A, 0-peak", low=0.0, high=1e6, typical=(1e-3, 100.0))
    frequency: float = parameter("rad/s", "f", above=0.0, high=1e5, typical=(1.0, 5e3))
    phase: float = parameter("rad", "p, phase at t = 0", default=0.0, typical=(-np.pi, np.pi))

    family: ClassVar[str] = "external_torque"
    periodic: ClassVar[Mapping[str, str]] = {"frequency": "time"}
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"),)
    signature: ClassVar[str] = "torsional vibration at one frequency that stays where it is when the speed changes"

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return self.amplitude * np.sin(self.frequency * time + self.phase)

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        return torsional_bodies(network)
