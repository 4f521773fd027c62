"""Something that swings on a housing: a pipe, a guard, a neighbour."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.quantities import parameter

ASIDE = (0.56, 0.75, 0.87, 1.15, 1.33, 1.8)
"""Quotients of a frequency and that of a neighbouring hollow of the misfit: fits ended at 0.55 (our own tenth rotor set, c02) and at
0.87 of one of the two (a record of 0.8 s in our tests)."""


@dataclass(frozen=True, kw_only=True)
class HiddenModeSupport(Effect):
    """A mass on two springs at right angles, attached to the housing of one bearing.

    m q'' + C (q' - h') + K (q - h) = m g
    K = m T diag(f_1^2, f_2^2) T^T,   C = 2 z m f_1 E

    with the displacement h of the housing, that of the mass q (both in x and y) and T, which turns the springs by an angle from
    x towards y.  The housing carries its weight too, m g_y/k lower.  Tuned to a resonance it splits it in two.
    Channels ``<effect>.x``, ``.y`` and their rates.

    Source: J. Ormondroyd, J. P. Den Hartog, Trans. ASME 50 (1928) 9, the damped vibration absorber, in two directions.  Leaves
    out further modes of what is attached, its tilt, and damping unlike along the two springs.
    """

    mass: float = parameter("kg", "m", low=0.0, high=1e4, typical=(0.02, 10.0))
    natural_frequency: float = parameter("rad/s", "f_1, along the first spring with the housing held", above=0.0, typical=(100.0, 1500.0))
    ratio: float = parameter("1", "f_2/f_1", default=1.0, above=0.0, high=20.0, typical=(0.5, 2.0))
    damping_ratio: float = parameter("1", "z", default=0.02, low=0.0, high=2.0, typical=(0.002, 0.1))
    angle: float = parameter(
        "rad",
        "direction of the first spring from x towards y",
        default=0.0,
        low=-math.pi,
        high=math.pi,
        typical=(-0.5 * math.pi, 0.5 * math.pi),
    )

    acts_on: ClassVar[str] = "support"
    kind: ClassVar[str] = "hidden state"
    family: ClassVar[str] = "hidden_mode_support"
    signature: ClassVar[str] = (
        "one resonance more or one that is split, and a notch of this housing where the attached mass swings against it"
    )
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {
        "natural_frequency": (160.0, 240.0, 360.0, 500.0, 680.0, 900.0, 1200.0),
        "damping_ratio": (0.05,),
    }
    decisive: ClassVar[tuple[str, ...]] = ("natural_frequency",)
    half_turn: ClassVar[frozenset[str]] = frozenset({"angle"})

    def elsewhere(self) -> tuple[HiddenModeSupport, ...]:
        """With one of its two frequencies aside, the other as it is: it shows where one of them is right, and little beside it."""
        found = []
        for part in ASIDE:
            for changes in ({"ratio": self.ratio * part}, {"natural_frequency": self.natural_frequency * part, "ratio": self.ratio / part}):
                try:
                    found.append(self.replacing(**changes))
                except ParameterError:
                    continue
        return tuple(found)

    def apply(self, draft: Draft, place: str, name: str) -> None:
        support = draft.support(place, "HiddenModeSupport")
        if self.mass == 0.0:
            return
        own = [
            draft.add_coordinate(f"{name}.{key}", inertia=self.mass, unit="m", doc=f"displacement of {name} in {key}", group=name)
            for key in "xy"
        ]
        c, s = math.cos(self.angle), math.sin(self.angle)
        turn = np.array([[c, -s], [s, c]])
        first = self.mass * self.natural_frequency**2
        stiffness = turn @ np.diag([first, first * self.ratio**2]) @ turn.T
        damping = 2.0 * self.damping_ratio * self.mass * self.natural_frequency * np.eye(2)
        names = tuple(dict.fromkeys([*own, *(c for factors in support.displacement.values() for c in factors)]))
        rows = np.zeros((2, len(names)))
        for k, key in enumerate("xy"):
            rows[k, names.index(own[k])] = 1.0
            for coordinate, factor in support.displacement[key].items():
                rows[k, names.index(coordinate)] -= factor
        draft.add_coordinate_matrix(f"{name}.springs", names, stiffness=rows.T @ stiffness @ rows, damping=rows.T @ damping @ rows)
