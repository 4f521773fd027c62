"""Kinematic error of a gear with several harmonics."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.harmonics import harmonics
from hdrive_mbs.effects.kinematic_error import KinematicError
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter

LEADING = 2.0
"""Size of a harmonic over that of the first one from which the error may be one of its order."""


@dataclass(frozen=True, kw_only=True)
class HarmonicKinematicError(KinematicError):
    """Kinematic error with three harmonics of one order: n, 2 n and 3 n.

    twist = phi_wg/u - phi_fs + e,  e = sum(A_k sin(k n a + p_k)) + c,  k = 1, 2, 3

    with signs, place and reaction as in KinematicError.  With n = 2 on the wave generator these are its orders
    2, 4 and 6, with n = 1 on the flexspline the orders 1, 2 and 3 of the output; use one effect for each.

    Source: Tuttle, Seering, IEEE Trans. Robotics and Automation 12 (1996) 368, whose drives show errors at the first
    even orders of the wave generator.  Leaves out that the error changes with load and assembly.
    """

    second_amplitude: float = parameter("rad", "A_2 at order 2 n, 0-peak", default=0.0, low=0.0, high=0.01, typical=(1e-6, 1e-3))
    second_phase: float = parameter("rad", "p_2, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))
    third_amplitude: float = parameter("rad", "A_3 at order 3 n, 0-peak", default=0.0, low=0.0, high=0.01, typical=(1e-6, 1e-3))
    third_phase: float = parameter("rad", "p_3, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))

    signature: ClassVar[str] = "vibration and position error at several multiples of an order, resonant where each meets a mode"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (
        ("amplitude", "phase"),
        ("second_amplitude", "second_phase"),
        ("third_amplitude", "third_phase"),
    )
    starts: ClassVar[Mapping[str, tuple[float | str, ...]]] = {
        "order": (1.0, 2.0, 3.0, 4.0, 6.0),
        "follows": ("wave_generator", "flexspline"),
    }

    def error(self, angle: Value) -> Value:
        parts = (self.amplitude, self.phase), (self.second_amplitude, self.second_phase), (self.third_amplitude, self.third_phase)
        return harmonics(angle, self.order, parts) + self.offset

    def elsewhere(self) -> tuple[HarmonicKinematicError, ...]:
        """With a harmonic that is larger than the first one as the first: an error of order 6 with harmonics of its own shows as the third
        one of order 2 too, and leaves these harmonics."""
        found = []
        for times, size, phase in ((2.0, self.second_amplitude, self.second_phase), (3.0, self.third_amplitude, self.third_phase)):
            if size > LEADING * self.amplitude:
                with contextlib.suppress(ParameterError):  # an order beyond all
                    found.append(
                        self.replacing(order=times * self.order, amplitude=size, phase=phase, second_amplitude=0.0, third_amplitude=0.0)
                    )
        return tuple(found)
