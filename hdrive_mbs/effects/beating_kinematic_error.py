"""Kinematic error of a gear that grows and shrinks once per turn of the output."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.harmonic_kinematic_error import HarmonicKinematicError
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.connection_draft import ConnectionDraft
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class BeatingKinematicError(HarmonicKinematicError):
    """Kinematic error of the wave generator with three harmonics, as a whole larger and smaller once per turn of the output.

    twist = phi_wg/u - phi_fs + e,  e = (1 + m sin(a/u + q)) sum(A_k sin(k n a + p_k)) + c,  k = 1, 2, 3

    with the true angle a of the wave generator, counted from the circular spline, and u the absolute value of the ratio: a/u is a turn of
    the output, but for the twist.  Signs, place and reaction as in KinematicError.  Each order k n has side bands 1/u to both sides.

    Source: Jia et al., Mechanism and Machine Theory 155 (2021) 104122, who find beats in the error of drives with errors of machining and
    assembly; that one factor stands before all harmonics is our own.  Leaves out that each may beat with its own depth and phase.
    """

    modulation: float = parameter("1", "m, change of the size in a turn of the output", default=0.0, low=0.0, high=1.0, typical=(1e-2, 0.5))
    modulation_phase: float = parameter("rad", "q, phase at angle 0", default=0.0, typical=(-np.pi, np.pi))

    signature: ClassVar[str] = "vibration and position error at multiples of an order, beating once per turn of the output"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (*HarmonicKinematicError.vectors, ("modulation", "modulation_phase"))
    starts: ClassVar[Mapping[str, tuple[float | str, ...]]] = {"order": (1.0, 2.0, 3.0, 4.0, 6.0)}

    def check(self) -> None:
        if self.follows != "wave_generator":
            raise ParameterError(
                f"{type(self).__name__}.follows = {self.follows!r}: must be 'wave_generator'; an error that follows the flexspline and "
                "changes once in its turn is one of other orders, see HarmonicKinematicError."
            )

    def law(self, gear: ConnectionDraft) -> Callable[[Value], Value]:
        inverse = abs(gear.factors[gear.bodies["wave_generator"]])

        def beating(angle: Value) -> Value:
            size = 1.0 + self.modulation * np.sin(inverse * angle + self.modulation_phase)
            return size * (self.error(angle) - self.offset) + self.offset

        return beating
