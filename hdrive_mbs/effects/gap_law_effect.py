"""Changes of the law of a connection that begin where its own gap ends."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

from hdrive_mbs.effects.effect import LawEffect
from hdrive_mbs.expression import Value


@dataclass(frozen=True, kw_only=True)
class GapLawEffect(LawEffect):
    """A change that counts from the edges of the gap that the law has, which is none of zero width."""

    def changed(self, law: Callable[[Value, Value], Value]) -> Callable[[Value, Value], Value]:
        return self.changed_beyond(law, 0.0)

    @abstractmethod
    def changed_beyond(self, law: Callable[[Value, Value], Value], gap: float) -> Callable[[Value, Value], Value]:
        """The new torque(twist, rate) made from the old one, which has no elastic torque in a gap of this full width [rad]."""
