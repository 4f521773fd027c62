"""The shape of hysteresis whose sliders follow from a few numbers."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import MemoryTwistEffect
from hdrive_mbs.effects.maxwell_slip_hysteresis import MaxwellSlipHysteresis
from hdrive_mbs.expression import Value

ELEMENTS = 4
"""Sliders in parallel: as many as the engine runs without a Python callback."""


@dataclass(frozen=True, kw_only=True)
class SliderHysteresis(MemoryTwistEffect):
    """ELEMENTS Maxwell-slip elements; a law says how stiffness and limit are spread over them."""

    family: ClassVar[str] = "hysteresis"
    dissipative: ClassVar[bool] = True

    @property
    @abstractmethod
    def elements(self) -> MaxwellSlipHysteresis:
        """The law with its elements written out."""

    def states(self) -> Mapping[str, str]:
        return self.elements.states()

    def state_rate(self, name: str, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        return self.elements.state_rate(name, time, twist, rate, state)

    def torque(self, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        return self.elements.torque(time, twist, rate, state)

    def stored(self, state: Mapping[str, Value]) -> Value:
        return self.elements.stored(state)
