"""One moment of a network: time, angles, speeds and states, as numbers, arrays or expressions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from hdrive_mbs.expression import Expression, Value, variable


@dataclass(frozen=True, kw_only=True)
class Moment:
    """What a law may look at.

    time : s
    angles, speeds : forward angle [rad] and speed [rad/s] of each coordinate
    states : values of the additional first-order states
    """

    time: Value
    angles: Mapping[str, Value]
    speeds: Mapping[str, Value]
    states: Mapping[str, Value]

    def angle(self, coordinate: str) -> Value:
        """Forward angle [rad]."""
        return self.angles[coordinate]

    def speed(self, coordinate: str) -> Value:
        """Forward speed [rad/s]."""
        return self.speeds[coordinate]

    def state(self, name: str) -> Value:
        """Value of a first-order state."""
        return self.states[name]


class _Symbols(Mapping[str, Expression]):
    """A mapping that answers every name with the variable ``prefix:name``, always the same node."""

    def __init__(self, prefix: str) -> None:
        self._prefix = prefix
        self._made: dict[str, Expression] = {}

    def __getitem__(self, name: str) -> Expression:
        if name not in self._made:
            self._made[name] = variable(f"{self._prefix}:{name}")
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._made)

    def __len__(self) -> int:
        return len(self._made)


def recording_moment() -> Moment:
    """A moment of variables ``t``, ``angle:name``, ``speed:name`` and ``state:name``."""
    return Moment(time=variable("t"), angles=_Symbols("angle"), speeds=_Symbols("speed"), states=_Symbols("state"))
