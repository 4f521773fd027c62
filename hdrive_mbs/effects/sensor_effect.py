"""The shapes of effects that change what a sensor shows and leave the motion alone."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect, _Memory
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment


@dataclass(frozen=True, kw_only=True)
class SensorEffect(Effect):
    """A change of what a Sensor part sees, before its own gain, offset and rounding.

    The sensor's channel is then the changed reading, ``<sensor>.true`` what it would show undisturbed; the quantity
    that it reads stays true.  The motion changes only where a controller reads the sensor.
    """

    acts_on: ClassVar[str] = "sensor"
    kind: ClassVar[str] = "sensor"

    @abstractmethod
    def reading(self, time: Value, value: Value) -> Value:
        """What is seen of a value of the quantity, in its unit."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        sensor = draft.sensor(place, type(self).__name__)
        draft.keep_true_reading(sensor)
        before = sensor.seen
        sensor.seen = lambda moment: self.reading(moment.time, before(moment))


@dataclass(frozen=True, kw_only=True)
class MemorySensorEffect(_Memory):
    """A SensorEffect that depends on the past through first-order states.

    All states start at zero: a quantity that starts elsewhere settles first.
    """

    acts_on: ClassVar[str] = "sensor"
    kind: ClassVar[str] = "sensor"

    @abstractmethod
    def reading(self, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        """What is seen of a value of the quantity, in its unit."""

    @abstractmethod
    def state_rate(self, name: str, time: Value, value: Value, state: Mapping[str, Value]) -> Value:
        """Rate of the state of that name [its unit/s]."""

    def apply(self, draft: Draft, place: str, name: str) -> None:
        sensor = draft.sensor(place, type(self).__name__)
        draft.keep_true_reading(sensor)
        before = sensor.seen
        read = self._add_states(draft, name, lambda own, moment, state: self.state_rate(own, moment.time, before(moment), state))

        def seen(moment: Moment) -> Value:
            return self.reading(moment.time, before(moment), read(moment))

        sensor.seen = seen
