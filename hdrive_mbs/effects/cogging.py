"""Cogging of a motor: torque that depends on its angle alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect, add_body_torque, moving_body
from hdrive_mbs.effects.harmonics import MOTOR_ORDERS, harmonics, potential
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class Cogging(Effect):
    """Torque between the teeth of the stator and the magnets, with up to three harmonics.

    tau = sum(A_k sin(k n a + p_k)),  k = 1, 2, 3

    with the true angle a of the body; positive tau drives forward.  It comes from a potential, the sum of
    A_k cos(k n a + p_k)/(k n), so no energy is made over a turn.  n is the least common multiple of
    slots and poles; unequal magnets or slots bring lower orders, each as a further effect.

    Source: Zhu, Howe, IEEE Trans. Energy Conversion 15 (2000) 407.  Leaves out the part that grows with the current
    (TorqueRipple) and the loss in the iron.
    """

    amplitude: float = parameter("N m", "A_1, amplitude of the first harmonic, 0-peak", low=0.0, high=1e3, typical=(1e-4, 5.0))
    order: float = parameter("1", "n, periods of the first harmonic per turn", above=0.0, high=1e3)
    phase: float = parameter("rad", "p_1, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    second_amplitude: float = parameter("N m", "A_2 at order 2 n, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    second_phase: float = parameter("rad", "p_2, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    third_amplitude: float = parameter("N m", "A_3 at order 3 n, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    third_phase: float = parameter("rad", "p_3, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))

    acts_on: ClassVar[str] = "motor"
    family: ClassVar[str] = "torque_ripple"
    signature: ClassVar[str] = "torque and speed vibration at fixed orders of the motor, the same at every load; detents at standstill"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (
        ("amplitude", "phase"),
        ("second_amplitude", "second_phase"),
        ("third_amplitude", "third_phase"),
    )
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"order": MOTOR_ORDERS}

    @property
    def parts(self) -> tuple[tuple[float, float], ...]:
        """Amplitude [N m] and phase [rad] of each harmonic."""
        return (self.amplitude, self.phase), (self.second_amplitude, self.second_phase), (self.third_amplitude, self.third_phase)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place)

        def angle(moment: Moment) -> Value:
            return body.sense * moment.angle(body.name)

        def torque(moment: Moment) -> Value:
            return harmonics(angle(moment), self.order, self.parts)

        add_body_torque(self, draft, body.name, name, torque, lambda m: body.sense * potential(angle(m), self.order, self.parts))
