"""The shape of effects that are a property of a whole shaft: the same on each of its pieces."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.network.bearing_draft import ShaftPiece
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import option


@dataclass(frozen=True, kw_only=True)
class EveryPieceEffect(Effect):
    """Something that is added to each piece of shaft, wherever it is put."""

    alone: bool = option("whether it acts on the piece it is put at alone, not on all pieces of shaft", default=False)

    acts_on: ClassVar[str] = "shaft"
    kind: ClassVar[str] = "parametric"

    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:
        """The first piece: it acts on all, wherever it is put."""
        return network.members.get("shaft", ())[:1]

    @abstractmethod
    def add_to(self, draft: Draft, piece: ShaftPiece, name: str) -> None:
        """Add it to one piece, under a name of its own."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        chosen = draft.shaft(place, type(self).__name__)
        for piece in (chosen,) if self.alone else draft.shafts:
            self.add_to(draft, piece, f"{name}.{piece.name}")
