"""The pull of a magnet on the rotor of an electrical machine that does not run in the middle of its stator."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect, stretches_of
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.excitation import Excitation
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class MagneticPull(LateralEffect):
    """Unbalanced magnetic pull: a negative spring about the centre of the stator, and in two-pole machines a pull that turns.

    F = k z + b exp(i (f t + p)) z*,  F = F_x + i F_y,  z = x + i y - c_x - i c_y,  z* its conjugate

    with displacements from the line without load.  For a field of p pole pairs with the amplitude B in an air gap g, stator radius R and
    length l:  k = pi R l B^2/(2 mu_0 g),  b = k/2 for one pole pair and none for more,  f twice the angular frequency of the mains.
    The field B cos(p a - w t) (1 + Re(z exp(-i a))/g), a the angle around, squared over 2 mu_0, is the pressure; its first order in z
    integrates to this.  Static deflection and whirl know k alone.  ``<effect>.force_x`` and ``_y`` show the part with k,
    ``<effect>.throb_x`` and ``_y`` that with b.

    Source: Maxwell's stress in the air gap, integrated as above; compare Smith, Dorrell, IEE Proc. Electric Power Applications 143 (1996)
    193.  Leaves out saturation, the growth beyond a tenth of the gap, and what currents in the rotor and the slip do.
    """

    stiffness: float = parameter("N/m", "k", low=0.0, high=1e9, typical=(1e2, 1e6))
    centre_x: float = parameter("m", "c_x, centre of the stator", default=0.0, low=-1e-2, high=1e-2, typical=(-1e-4, 1e-4))
    centre_y: float = parameter("m", "c_y", default=0.0, low=-1e-2, high=1e-2, typical=(-1e-4, 1e-4))
    throb: float = parameter("N/m", "b", default=0.0, low=0.0, high=1e9, typical=(1e2, 1e6))
    frequency: float = parameter("rad/s", "f, twice that of the mains", default=200.0 * np.pi, above=0.0, high=1e5)
    phase: float = parameter("rad", "p, phase at t = 0", default=0.0, typical=(-np.pi, np.pi))

    acts_on: ClassVar[str] = "rotor"
    family: ClassVar[str] = "magnetic_pull"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"frequency": (200.0 * np.pi, 240.0 * np.pi)}
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("throb", "phase"),)
    signature: ClassVar[str] = (
        "lower resonances of a machine under voltage than without; in two-pole machines vibration at twice the frequency of the mains, with"
        " side bands as far away as the spin frequency"
    )

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        return self.stiffness * (x - self.centre_x), self.stiffness * (y - self.centre_y)

    def throbbing(self, time: Value, x: Value, y: Value) -> tuple[Value, Value]:
        """The part with b [N] in x and y."""
        turn = self.frequency * time + self.phase
        across, up = x - self.centre_x, y - self.centre_y
        cosine, sine = np.cos(turn), np.sin(turn)
        return self.throb * (cosine * across + sine * up), self.throb * (sine * across - cosine * up)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        super().apply(draft, place, name)
        if self.throb == 0.0:
            return

        def forces(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Mapping[str, Value]:
            return {key: -value for key, value in zip("xy", self.throbbing(moment.time, s["x"], s["y"]), strict=True)}

        whole = stretches_of(self, draft, place)
        element = Excitation(f"{name}.throb", {key: whole[key] for key in "xy"}, forces)
        draft.add_element(element)
        for key in "xy":

            def read(moment: Moment, key: str = key) -> Value:
                return -element.values(moment)[key] + 0.0 * moment.time

            draft.add_channel(f"{name}.throb_{key}", "N", f"throbbing part of the force of {name} in {key}", read)
