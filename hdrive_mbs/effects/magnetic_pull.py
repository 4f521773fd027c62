"""The pull of a magnet on the rotor of an electrical machine that does not run in the middle of its stator."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.lateral_effect import LateralEffect
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class MagneticPull(LateralEffect):
    """Unbalanced magnetic pull: a negative spring about the centre of the stator, which throbs with twice the frequency of the mains.

    F = (k + b cos(f t + p)) (r - c),  r = (x, y),  c = (c_x, c_y)

    with displacements from the line without load.  For a machine with the flux density B in an air gap g, stator radius R and length l
    k = pi R l B^2/(2 mu_0 g).

    Source: linear pull of a small eccentricity, e.g. Childs, Turbomachinery Rotordynamics (Wiley 1993), or any textbook of electrical
    machines.  Leaves out saturation, the growth beyond a tenth of the gap, damping by the cage and the pull by slip.
    """

    stiffness: float = parameter("N/m", "k", low=0.0, high=1e9, typical=(1e2, 1e6))
    centre_x: float = parameter("m", "c_x, centre of the stator", default=0.0, low=-1e-2, high=1e-2, typical=(-1e-4, 1e-4))
    centre_y: float = parameter("m", "c_y", default=0.0, low=-1e-2, high=1e-2, typical=(-1e-4, 1e-4))
    throb: float = parameter("N/m", "b, what throbs", default=0.0, low=0.0, high=1e9, typical=(1e2, 1e6))
    frequency: float = parameter("rad/s", "f, twice that of the mains", default=200.0 * np.pi, above=0.0, high=1e5)
    phase: float = parameter("rad", "p", default=0.0, typical=(-np.pi, np.pi))

    acts_on: ClassVar[str] = "rotor"
    family: ClassVar[str] = "magnetic_pull"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"frequency": (200.0 * np.pi, 240.0 * np.pi)}
    vectors: ClassVar[tuple[tuple[str, str], ...]] = (("throb", "phase"),)
    signature: ClassVar[str] = (
        "lower resonances of a machine under voltage than without; vibration at twice the frequency of the mains, with side bands as far"
        " away as the spin frequency"
    )

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        size: Value = self.stiffness
        if self.throb != 0.0:
            size = size + self.throb * np.cos(self.frequency * time + self.phase)
        return size * (x - self.centre_x), size * (y - self.centre_y)
