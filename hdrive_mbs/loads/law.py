"""What every load law offers."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import Described, option


@dataclass(frozen=True, kw_only=True)
class LoadLaw(Described):
    """Torque M_MR that a machine takes from the train: positive when it resists forward rotation.

    *Forward* is the sense in which the place turns when the motor turns positively, whatever the
    gears in between do to the sense.
    """

    _kind: ClassVar[str] = "load"
    _use: ClassVar[str] = "hm.Load(torque={name}(...)) takes it; a drive of 60 N m at every speed is characteristic=lambda speed: 60.0"

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        """Resisting torque [N m] at a time [s], forward angle [rad] and forward speed [rad/s]."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class LoadFunction(LoadLaw):
    """A plain Python function of (time) or (time, angle, speed).  A scene file cannot hold it."""

    function: Callable[..., Value] = option(
        "torque [N m] as function of time, or of time, angle and speed", called_with=(("time",), ("time", "angle", "speed"))
    )

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        if _argument_count(self.function) == 1:
            return self.function(time)
        return self.function(time, angle, speed)


def _argument_count(function: Callable[..., Value]) -> int:
    needed = [
        item
        for item in inspect.signature(function).parameters.values()
        if item.default is item.empty and item.kind in (item.POSITIONAL_ONLY, item.POSITIONAL_OR_KEYWORD)
    ]
    return len(needed)
