"""A foot that plays between its base and the head of its bolt."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from hdrive_mbs.effects.looseness import Looseness
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class LooseBolt(Looseness):
    """Looseness whose foot the head of the bolt holds again after a way that is searched for.

    F = S(y) - a (S(b) - S(y_0)),  b = min(max(y, y_0), y_0 + g)

    Source: as for Looseness, which a search tries without the bolt's head.  Leaves out what that leaves out, and the bolt's own stiffness.
    """

    play: float = parameter("m", "g, way until the bolt's head holds it", above=0.0, high=0.1, typical=(3e-7, 1e-4))

    signature: ClassVar[str] = "even harmonics and a mean shift in the direction of lifting that stop growing with the amplitude"
    starts: ClassVar[Mapping[str, tuple[Any, ...]]] = {"share": (0.1, 0.5), "lift_off": (-5e-6, 0.0), "play": (2e-6, 8e-6)}
