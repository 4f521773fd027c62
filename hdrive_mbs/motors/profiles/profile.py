"""What every speed profile offers, and profiles given as plain functions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.errors import LawError
from hdrive_mbs.expression import Value, gradient
from hdrive_mbs.quantities import Described, option


@dataclass(frozen=True, kw_only=True)
class SpeedProfile(Described):
    """A speed over time with its exact integral, the angle.

    A subclass writes ``angle`` in closed form; the engine takes the speed of a prescribed motion
    by differentiation of it, so ``speed`` must be its derivative.
    """

    _kind: ClassVar[str] = "speed profile"

    def angle(self, time: Value) -> Value:
        """Angle [rad] turned since t = 0."""
        raise NotImplementedError

    def speed(self, time: Value) -> Value:
        """Speed [rad/s]."""
        return gradient(self.angle)(time) + 0.0 * time


@dataclass(frozen=True, kw_only=True)
class AngleFunction(SpeedProfile):
    """A plain Python function angle(time) [rad].  A scene file cannot hold it."""

    function: Callable[[Value], Value] = option("angle [rad] as a function of time [s]", called_with=(("time",),))

    def angle(self, time: Value) -> Value:
        return self.function(time)


@dataclass(frozen=True, kw_only=True)
class SpeedFunction(SpeedProfile):
    """A plain Python function speed(time) [rad/s], without an angle.  A scene file cannot hold it."""

    function: Callable[[Value], Value] = option("speed [rad/s] as a function of time [s]", called_with=(("time",),))

    def speed(self, time: Value) -> Value:
        return self.function(time)

    def angle(self, time: Value) -> Value:
        raise LawError("A speed given as a plain function has no closed-form angle; give the angle itself, AngleFunction(function=...).")
