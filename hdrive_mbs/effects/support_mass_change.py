"""One housing that is heavier or lighter than it should be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.quantities import parameter
from hdrive_mbs.tracked_arrays import scaled


@dataclass(frozen=True, kw_only=True)
class SupportMassChange(Effect):
    """The mass of one housing, scaled, in x and y alike and with its weight.

    m = (1 + e) m_h

    Source: none needed, a part of the foundation that moves along or a wrong value of the data sheet.  Leaves out that what
    moves along may do so in one direction more than in the other.
    """

    change: float = parameter("1", "e, mass more than in the model, as a share of it", low=-0.95, high=100.0, typical=(-0.7, 4.0))

    acts_on: ClassVar[str] = "support"
    kind: ClassVar[str] = "parametric"
    family: ClassVar[str] = "support_mass"
    signature: ClassVar[str] = "shifted upper resonances where this housing moves, smaller acceleration of the housing at high speed"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"change": (-0.3, 1e-4, 0.5)}

    def apply(self, draft: Draft, place: str, name: str) -> None:
        support = draft.support(place, "SupportMassChange")
        if self.change == 0.0:
            return
        for direction, factors in support.displacement.items():
            row = np.array(list(factors.values()))
            mass = scaled(self.change * support.mass, np.outer(row, row))
            zero = np.zeros(mass.shape)
            draft.add_element(MatrixElement(f"{name}.{direction}", tuple(factors), mass, zero, zero))
