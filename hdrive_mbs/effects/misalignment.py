"""A coupling or bearing that is not in line with the shaft."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class Misalignment(LateralEffect):
    """Forces once, twice and three times per turn at a coupling or bearing out of line, the same at every speed.

    F = sum(exp(i d) (A_n cos(n f + p_n) + i e A_n sin(n f + p_n))),  F = F_x + i F_y,  n = 1, 2, 3

    with the twisted spin angle f of the place: ellipses with the half axis A_n along d and the share e of it
    across, one way round for e > 0, a fixed line for e = 0, the other way round for e < 0.  With a lever l the force acts
    at the distance l beyond the place along +z: moments M_x = -l F_y and M_y = l F_x, those of angular misalignment.

    Source: Gibbons, Coupling misalignment forces, Turbomachinery Symposium 5 (1976) 111; orders 1 and 2: Sekhar,
    Prabhu, J. Sound and Vibration 185 (1995) 655.  Leaves out the stiffness of the coupling between the shafts, the
    torque that makes the forces grow (LoadedMisalignment), and a constant preload.
    """

    once: float = parameter("N", "A_1 at order 1, 0-peak", default=0.0, low=0.0, high=1e6, typical=(0.01, 1e3))
    once_phase: float = parameter("rad", "p_1, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    twice: float = parameter("N", "A_2 at order 2, 0-peak", low=0.0, high=1e6, typical=(0.01, 1e3))
    twice_phase: float = parameter("rad", "p_2, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    thrice: float = parameter("N", "A_3 at order 3, 0-peak", default=0.0, low=0.0, high=1e6, typical=(0.01, 1e3))
    thrice_phase: float = parameter("rad", "p_3, phase at spin angle 0", default=0.0, typical=(-np.pi, np.pi))
    roundness: float = parameter(
        "1", "e, half axis across d over the one along d, negative against the spin", default=1.0, low=-2.0, high=2.0, typical=(-1.0, 1.0)
    )
    direction: float = parameter("rad", "d, of the major axis, from x towards y", default=0.0, typical=(-0.5 * np.pi, 0.5 * np.pi))
    lever: float = parameter("m", "l, how far beyond the place the force acts along +z", default=0.0)

    acts_on: ClassVar[str] = "drive end"
    family: ClassVar[str] = "misalignment"
    excites: ClassVar[bool] = True
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("once", "once_phase"), ("twice", "twice_phase"), ("thrice", "thrice_phase"))
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"roundness": (0.0, 1.0), "direction": (0.0, 0.5 * np.pi)}
    signature: ClassVar[str] = (
        "vibration twice per turn, with some once and three times, that resonates at half a critical speed and does not grow with speed"
    )

    @property
    def parts(self) -> tuple[tuple[int, float, float], ...]:
        """Order, amplitude [N] and phase [rad]."""
        return (1, self.once, self.once_phase), (2, self.twice, self.twice_phase), (3, self.thrice, self.thrice_phase)

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        return self._turned(angle)

    def moments(
        self, time: Value, angle: Value, speed: Value, psi: Value, theta: Value, psi_rate: Value, theta_rate: Value
    ) -> tuple[Value, Value] | None:
        if self.lever == 0.0:
            return None
        x, y = self._turned(angle)
        return -self.lever * y, self.lever * x

    def _turned(self, angle: Value) -> tuple[Value, Value]:
        along: Value = 0.0 * angle
        across: Value = 0.0 * angle
        for order, amplitude, phase in self.parts:
            if amplitude != 0.0:
                along = along + amplitude * np.cos(order * angle + phase)
                across = across + self.roundness * amplitude * np.sin(order * angle + phase)
        c, s = np.cos(self.direction), np.sin(self.direction)
        return c * along - s * across, s * along + c * across
