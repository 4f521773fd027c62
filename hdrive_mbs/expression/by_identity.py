"""What is made from long tuples, kept by the tuples themselves: these cannot change, and need not be read to be known again."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

Made = TypeVar("Made")


class ByIdentity(Generic[Made]):
    """The last things that were made from two sequences, as long as both are tuples."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._known: dict[tuple[int, int], tuple[object, object, Made]] = {}

    def of(self, first: object, second: object, make: Callable[[], Made]) -> Made:
        """What was made from these very two before, or what is made now."""
        if type(first) is not tuple or type(second) is not tuple:
            return make()
        key = id(first), id(second)
        kept = self._known.pop(key, None) or (first, second, make())  # both are held, so that their numbers stay theirs
        self._known[key] = kept
        if len(self._known) > self._most:
            del self._known[next(iter(self._known))]
        return kept[2]
