"""The shape of effects by which a magnet pulls a rotor away from the middle of its stator."""

from __future__ import annotations

from abc import abstractmethod
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
class PullEffect(LateralEffect):
    """A negative spring about the centre of the stator, and a part that throbs.

    F = k z + T(t, z),  F = F_x + i F_y,  z = x + i y - c_x - i c_y

    with displacements from the line without load.  Static deflection and whirl know k alone.  ``<effect>.force_x`` and ``_y`` show the
    part with k, ``<effect>.throb_x`` and ``_y`` the part T, if one of the amplitudes in ``vectors`` is not zero.
    """

    stiffness: float = parameter("N/m", "k", low=0.0, high=1e9, typical=(1e2, 1e6))
    centre_x: float = parameter("m", "c_x, centre of the stator", default=0.0, low=-1e-2, high=1e-2, typical=(-1e-4, 1e-4))
    centre_y: float = parameter("m", "c_y", default=0.0, low=-1e-2, high=1e-2, typical=(-1e-4, 1e-4))
    frequency: float = parameter("rad/s", "f of T, twice that of the mains", default=200.0 * np.pi, above=0.0, high=1e5)
    phase: float = parameter("rad", "p of T at t = 0", default=0.0, typical=(-np.pi, np.pi))

    acts_on: ClassVar[str] = "rotor"
    family: ClassVar[str] = "magnetic_pull"
    starts: ClassVar[Mapping[str, tuple[float, ...]]] = {"frequency": (200.0 * np.pi, 240.0 * np.pi)}

    @abstractmethod
    def throbbing(self, time: Value, x: Value, y: Value) -> tuple[Value, Value]:
        """The part T [N] in x and y at displacements [m] of the rotor."""

    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        return self.stiffness * (x - self.centre_x), self.stiffness * (y - self.centre_y)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        super().apply(draft, place, name)
        if all(getattr(self, size) == 0.0 for size, _ in self.vectors):
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
