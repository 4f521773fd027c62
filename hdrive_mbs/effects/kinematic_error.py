"""Kinematic (transmission) error of a gear."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.connection_draft import ConnectionDraft
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.elements import KinematicTerm
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class KinematicError(Effect):
    """One order of the kinematic error of a gear.

    twist = phi_wg/u - phi_fs + e,  e = A sin(n a + p) + c

    where a is the true angle of the flange that the error follows, counted from the circular spline.
    Unloaded, the twist is zero and the output runs ahead of its ideal angle by e in its forward
    sense (in true sense: e times the sense of the output).  The torque of the gear acts back on the
    followed flange by T de/da, so no energy is made.  At e(0) != 0 a run from rest starts wound up by e(0);
    c = -A sin(p) lets it start unwound, as where the encoders are set to zero after the gear has come to rest.

    Source: Ghorbel, Gandhi, Alpeter, ASME J. Mechanical Design 123 (2001) 90; Nye, Kraml, 25th Aerospace
    Mechanisms Symposium, NASA CP-3113 (1991).  Harmonic drives err mostly twice per turn of the wave
    generator and at multiples of it, and once and twice per turn of the output.  Leaves out that
    the error changes with load and assembly; other orders are further effects.
    """

    amplitude: float = parameter("rad", "amplitude A at the output, 0-peak", low=0.0, high=0.01, typical=(1e-6, 1e-3))
    order: float = parameter("1", "periods n per turn of the flange it follows", default=2.0, above=0.0, high=1e3)
    phase: float = parameter("rad", "phase p at angle 0", default=0.0, typical=(-np.pi, np.pi))
    offset: float = parameter("rad", "constant part c at the output", default=0.0, low=-0.01, high=0.01, typical=(-1e-3, 1e-3))
    follows: str = option("'wave_generator' or 'flexspline': the flange whose angle counts", default="wave_generator")

    acts_on: ClassVar[str] = "gear"
    kind: ClassVar[str] = "kinematic"
    family: ClassVar[str] = "kinematic_error"
    signature: ClassVar[str] = "vibration and position error at a fixed order of a shaft, resonant where the order meets a mode"
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("amplitude", "phase"),)
    additive: ClassVar[tuple[str, ...]] = ("offset",)
    starts: ClassVar[Mapping[str, tuple[float | str, ...]]] = {
        "order": (1.0, 2.0, 3.0, 4.0, 6.0),
        "follows": ("wave_generator", "flexspline"),
    }

    def check(self) -> None:
        if self.follows not in ("wave_generator", "flexspline"):
            raise ParameterError(f"{type(self).__name__}.follows = {self.follows!r}: must be 'wave_generator' or 'flexspline'.")

    def error(self, angle: Value) -> Value:
        """e [rad] at a true angle [rad] of the flange."""
        return self.amplitude * np.sin(self.order * angle + self.phase) + self.offset

    def law(self, gear: ConnectionDraft) -> Callable[[Value], Value]:
        """e [rad] of a true angle [rad] of the flange, in a gear."""
        return self.error

    def apply(self, draft: Draft, place: str, name: str) -> None:
        gear = draft.connection(place, type(self).__name__, flanges=(self.follows, "circular_spline"))
        flange, ring = draft.body(gear.bodies[self.follows]), draft.body(gear.bodies["circular_spline"])
        term = KinematicTerm({flange.name: float(flange.sense), ring.name: -float(ring.sense)}, self.law(gear))
        gear.terms.append(term)
        draft.add_channel(f"{name}.error", "rad", f"kinematic error of {name}, positive when the output runs ahead", term.value)
