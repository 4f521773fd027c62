"""Torque ripple of a motor with many harmonics."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect, add_body_torque, moving_body
from hdrive_mbs.effects.harmonics import harmonics
from hdrive_mbs.effects.torque_ripple import TorqueRipple
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class RippleSpectrum(Effect):
    """Ripple and cogging of a motor as six multiples of one order, growing with the torque alike.

    tau = (1 + g T_m) sum(A_k sin(k n a + p_k)),  k = 1..6

    with the true angle a of the body and the motor's air-gap torque T_m; positive tau drives forward.  Ripple of a
    three-phase motor comes at 6, 12, 18... times the pole pairs, cogging at the least common multiple of slots and poles:
    with n at their common divisor one spectrum holds both.

    Source: Jahns, Soong, IEEE Trans. Industrial Electronics 43 (1996) 321.  Leaves out that cogging does not grow with the
    torque where ripple does, and the change of amplitude with speed.
    """

    first_amplitude: float = parameter("N m", "A_1 at order n, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    first_phase: float = parameter("rad", "p_1, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    second_amplitude: float = parameter("N m", "A_2 at order 2 n, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    second_phase: float = parameter("rad", "p_2, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    third_amplitude: float = parameter("N m", "A_3 at order 3 n, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    third_phase: float = parameter("rad", "p_3, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    fourth_amplitude: float = parameter("N m", "A_4 at order 4 n, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    fourth_phase: float = parameter("rad", "p_4, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    fifth_amplitude: float = parameter("N m", "A_5 at order 5 n, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    fifth_phase: float = parameter("rad", "p_5, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    sixth_amplitude: float = parameter("N m", "A_6 at order 6 n, 0-peak", default=0.0, low=0.0, high=1e3, typical=(1e-4, 5.0))
    sixth_phase: float = parameter("rad", "p_6, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    growth: float = parameter("1/(N m)", "g, growth with the motor torque", default=0.0, low=-10.0, high=10.0, typical=(-0.5, 0.5))
    order: float = parameter("1", "n, periods of the first harmonic per turn", above=0.0, high=1e3)

    acts_on: ClassVar[str] = "motor"
    family: ClassVar[str] = "torque_ripple"
    signature: ClassVar[str] = "torque and speed vibration at several fixed orders of the motor"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (
        ("first_amplitude", "first_phase"),
        ("second_amplitude", "second_phase"),
        ("third_amplitude", "third_phase"),
        ("fourth_amplitude", "fourth_phase"),
        ("fifth_amplitude", "fifth_phase"),
        ("sixth_amplitude", "sixth_phase"),
    )
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"order": (1.0, 2.0, 4.0, 6.0, 12.0)}

    @property
    def parts(self) -> tuple[tuple[float, float], ...]:
        """Amplitude [N m] and phase [rad] of each harmonic."""
        return tuple((getattr(self, amplitude), getattr(self, phase)) for amplitude, phase in self.vectors)

    def telling(self, other: Effect) -> tuple[RippleSpectrum, ...]:
        """Of a ripple of one order and its double the spectra that have both: cogging of order 36 may be the third of order 12."""
        if not isinstance(other, TorqueRipple):
            return ()
        found = []
        for order in self.starts["order"]:
            k = round(other.order / order)
            parts = {k: (other.amplitude, other.phase), 2 * k: (other.second_amplitude, other.second_phase)}
            if 1 <= k <= len(self.vectors) and math.isclose(k * order, other.order):
                named = [(self.vectors[j - 1], part) for j, part in parts.items() if j <= len(self.vectors)]
                found.append(self.replacing(order=order, **{name: value for pair in named for name, value in zip(*pair, strict=True)}))
        return tuple(found)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        body = moving_body(self, draft, place)
        motor = draft.motor_torque(place, "RippleSpectrum.growth") if self.growth != 0.0 else None

        def torque(moment: Moment) -> Value:
            size = 1.0 if motor is None else 1.0 + self.growth * motor(moment)
            return size * harmonics(body.sense * moment.angle(body.name), self.order, self.parts)

        add_body_torque(self, draft, body.name, name, torque)
