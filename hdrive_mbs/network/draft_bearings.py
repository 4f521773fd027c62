"""Bearings, supports and pieces of shaft that effects can find while a network is being built."""

from __future__ import annotations

from collections.abc import Mapping

from hdrive_mbs.errors import PlaceError, unknown_place
from hdrive_mbs.network.bearing_draft import BearingDraft, BearingForces, ShaftPiece, SupportDraft
from hdrive_mbs.network.draft_rotor_line import DraftRotorLine
from hdrive_mbs.network.node import Node


class DraftBearings(DraftRotorLine):
    """Bearings, their supports and pieces of shaft by name."""

    def __init__(self, nodes: dict[str, Node], flanges: dict[str, str], offsets: dict[str, float] | None = None) -> None:
        super().__init__(nodes, flanges, offsets)
        self._bearings: dict[str, BearingDraft] = {}
        self._supports: dict[str, SupportDraft] = {}
        self._shafts: dict[str, ShaftPiece] = {}

    def add_bearing(self, bearing: BearingDraft, support: SupportDraft | None = None) -> None:
        """Make a bearing, and its housing if it has one, known to effects."""
        self._bearings[bearing.name] = bearing
        if support is not None:
            self._supports[support.name] = support

    def add_bearing_force(self, bearing: BearingDraft, name: str, forces: BearingForces, *, dissipative: bool = False) -> None:
        """A force between ring and housing beside that of the law; the channels of the bearing's force show it too."""
        bearing.added.append(forces)
        self.add_coupling(
            name, {key: dict(item) for key, item in bearing.stretches.items()}, lambda m, s, v: forces(s, v), dissipative=dissipative
        )

    def add_shaft(self, piece: ShaftPiece) -> None:
        """Make a beam element known to effects."""
        self._shafts[piece.name] = piece

    def bearing(self, place: str, asked_by: str = "This") -> BearingDraft:
        """The bearing of that name.  Raises PlaceError where there is none with a ring of its own."""
        if place in self._bearings:
            return self._bearings[place]
        raise self._no_such("a bearing", "Bearings", place, self._bearings, asked_by)

    def support(self, place: str, asked_by: str = "This") -> SupportDraft:
        """The support of the bearing of that name.  Raises PlaceError where there is no housing."""
        if place in self._supports:
            return self._supports[place]
        raise self._no_such("a bearing with a housing", "Such bearings", place, self._supports, asked_by)

    def shaft(self, place: str, asked_by: str = "This") -> ShaftPiece:
        """The piece of shaft of that name.  Raises PlaceError where there is none that bends."""
        if place in self._shafts:
            return self._shafts[place]
        raise self._no_such("a piece of shaft that bends", "Such pieces", place, self._shafts, asked_by)

    @property
    def bearings(self) -> tuple[BearingDraft, ...]:
        """All bearings with a ring of their own."""
        return tuple(self._bearings.values())

    @property
    def shafts(self) -> tuple[ShaftPiece, ...]:
        """All pieces of shaft that bend."""
        return tuple(self._shafts.values())

    def _no_such(self, kind: str, words: str, place: str, known: Mapping[str, object], asked_by: str) -> PlaceError:
        if place in self._flanges or place in self._connections or place in self._aliases:
            return PlaceError(f"{asked_by} acts on {kind}, and {place!r} is none. {words}: {', '.join(known) or 'none'}.")
        return unknown_place(kind.removeprefix("a "), place, known)
