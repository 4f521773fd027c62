"""Balls that pass a flaw, as a sum of harmonics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.harmonics import harmonics
from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.effects.speed_growth import grown
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class BallPassHarmonics(LateralEffect):
    """Force between ring and housing in one direction, at an order of the spin and its first two multiples.

    F = g(w) sum(A_k sin(k n f + p_k)),  k = 1, 2, 3,  g = (|w|/w_0)^m

    on the ring along the direction d, with the spin angle f of the ring and its speed w.  It makes no claim about the
    form of the pulse, which may ring or double; BallPass has the order n of a bearing.

    Source: Fourier series of any periodic force.  Leaves out harmonics beyond the third, slip that wanders, and sidebands.
    """

    amplitude: float = parameter("N", "A_1, 0-peak, at the reference speed", low=0.0, high=1e6, typical=(0.05, 500.0))
    phase: float = parameter("rad", "p_1, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    second_amplitude: float = parameter("N", "A_2 at order 2 n, 0-peak", default=0.0, low=0.0, high=1e6, typical=(0.05, 500.0))
    second_phase: float = parameter("rad", "p_2, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    third_amplitude: float = parameter("N", "A_3 at order 3 n, 0-peak", default=0.0, low=0.0, high=1e6, typical=(0.05, 500.0))
    third_phase: float = parameter("rad", "p_3, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    order: float = parameter("1", "n, pulses per turn of the shaft", above=0.0, high=100.0, typical=(2.0, 12.0))
    direction: float = parameter("rad", "d, from x towards y", default=-0.5 * np.pi, typical=(-np.pi, np.pi))
    growth: float = parameter("1", "m, power of the speed with which it grows", default=0.0, low=0.0, high=4.0, typical=(0.0, 2.0))
    reference_speed: float = parameter("rad/s", "w_0, where it has the amplitudes A_k", default=500.0, above=0.0)

    acts_on: ClassVar[str] = "bearing"
    family: ClassVar[str] = "ball_pass"
    excites: ClassVar[bool] = True
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"direction": (0.0, 0.5 * np.pi)}
    decisive: ClassVar[tuple[str, ...]] = ("direction",)
    periodic: ClassVar[Mapping[str, str]] = {"order": "turn"}
    leads: ClassVar[bool] = True
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (
        ("amplitude", "phase"),
        ("second_amplitude", "second_phase"),
        ("third_amplitude", "third_phase"),
    )
    signature: ClassVar[str] = "vibration at an order of the spin that is no whole number, and at twice and three times it, at one housing"

    @property
    def parts(self) -> tuple[tuple[float, float], ...]:
        """Amplitude [N] and phase [rad] of each harmonic."""
        return (self.amplitude, self.phase), (self.second_amplitude, self.second_phase), (self.third_amplitude, self.third_phase)

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        size = grown(speed, self.reference_speed, self.growth) * harmonics(angle, self.order, self.parts)
        return np.cos(self.direction) * size, np.sin(self.direction) * size
