"""Places of a network while it is being built: bodies, and the connections between them."""

from __future__ import annotations

from hdrive_mbs.errors import PlaceError, unknown_place
from hdrive_mbs.network.connection_draft import ConnectionDraft
from hdrive_mbs.network.elements import Element
from hdrive_mbs.network.node import Node


class DraftPlaces:
    """Nodes by place, connections by name, and all elements so far."""

    def __init__(self, nodes: dict[str, Node], flanges: dict[str, str]) -> None:
        self._nodes = nodes
        self._flanges = flanges  # flange path -> node name
        self._connections: dict[str, ConnectionDraft] = {}
        self._aliases: dict[str, str] = {}  # other names of a connection
        self._elements: list[Element] = []

    def body(self, place: str, asked_by: str = "This") -> Node:
        """The rotating place of that name: coordinate name, inertia, sense and ratio.

        Raises PlaceError when the place does not exist or is not a body.
        """
        if place in self._flanges:
            return self._nodes[self._flanges[place]]
        known = [name for name in self._flanges if self._flanges[name] != "ground"]
        if place in self._connections or place in self._aliases:
            raise PlaceError(f"{asked_by} acts on a rotating body, but {place!r} is a connection. Bodies: {', '.join(known)}.")
        raise unknown_place("body", place, known)

    def has_body(self, place: str) -> bool:
        """Whether there is a rotating place of that name."""
        return place in self._flanges

    def connection(self, place: str, asked_by: str = "This", flanges: tuple[str, ...] = ()) -> ConnectionDraft:
        """The connection of that name (a shaft, the mesh of a gear), which must have these flanges.

        Raises PlaceError when the place does not exist, is not a connection or lacks a flange.
        """

        def fits(draft: ConnectionDraft) -> bool:
            return set(flanges) <= set(draft.bodies)

        name = self._aliases.get(place, place)
        aliases = [alias for alias, owner in self._aliases.items() if fits(self._connections[owner])]
        known = [*(key for key, draft in self._connections.items() if fits(draft)), *aliases]
        if name in self._connections:
            found = self._connections[name]
            if fits(found):
                return found
            raise PlaceError(
                f"{asked_by} needs a connection with the flanges {', '.join(flanges)}, but {place!r} has "
                f"{', '.join(found.bodies) or 'none'}. Such connections: {', '.join(known) or 'none'}."
            )
        if place in self._flanges:
            raise PlaceError(f"{asked_by} acts on a connection, but {place!r} is a body. Connections: {', '.join(known)}.")
        raise unknown_place("connection", place, known)

    def add_element(self, element: Element) -> None:
        """Any element: something with a name and contribution(moment)."""
        self._elements.append(element)
