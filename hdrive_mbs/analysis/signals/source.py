"""What signals are taken from: a response, a single history, or a measured record."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.records.record import Record
from hdrive_mbs.signals import FloatArray, TimeHistory

Source = Response | TimeHistory | Record


@dataclass(frozen=True, eq=False)
class MeasuredChannels:
    """A record with the names and histories of a response; its channels go by their names or by what they measure."""

    record: Record
    scene: None = None

    @property
    def channels(self) -> tuple[str, ...]:
        """What each channel measures, or its name where that is not said."""
        return tuple(item.quantity or item.name for item in self.record)

    @property
    def times(self) -> FloatArray:
        return self.record.times

    def __contains__(self, name: object) -> bool:
        return name in self.record

    def __getitem__(self, name: str) -> TimeHistory:
        return self.record.history(name)


def readable(source: Any) -> Response | TimeHistory | MeasuredChannels:
    """Something that has histories.  Raises ParameterError for anything else."""
    if isinstance(source, Record):
        return MeasuredChannels(source)
    if isinstance(source, Response | TimeHistory | MeasuredChannels):
        return source
    raise ParameterError(
        f"A {type(source).__name__} has no signals: give a response, a TimeHistory or a Record (of several that were read, one of them)."
    )
