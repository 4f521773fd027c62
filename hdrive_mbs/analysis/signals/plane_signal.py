"""A channel, or the motion of a place in the plane as one complex signal x + i y."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.signals.source import MeasuredChannels, Source, readable
from hdrive_mbs.analysis.signals.spectrum import chosen_history, chosen_span, values_at
from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.analysis.whirl.rotor_places import reference_shaft
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.scene import Scene
from hdrive_mbs.signals import TimeHistory

Signal = npt.NDArray[np.float64] | npt.NDArray[np.complex128]

PAIRS = (("{}.x", "{}.y"), ("{}_x", "{}_y"))
"""How the two channels of a place are named: rotor_1 and a housing; a bearing force, columns of a record."""


@dataclass(frozen=True, eq=False)
class PlaneSignal:
    """One history, or two that make x + i y.

    name, unit : of the channel or place
    plane : whether it is x + i y
    """

    source: Response | TimeHistory | MeasuredChannels
    histories: tuple[TimeHistory, ...]
    name: str
    scene: Scene | None

    @classmethod
    def of(cls, given: Source, name: str | tuple[str, str] | None) -> PlaneSignal:
        """A channel by its name, a place (``rotor_1``, ``bearing_a.housing``, ``bearing_a.force``) in x and y, or two channels (x, y)."""
        source = readable(given)
        if name is not None and not isinstance(name, str):
            x, y = _two(name)
            pair = chosen_history(source, x)[0], chosen_history(source, y)[0]
            if pair[0].unit != pair[1].unit:
                raise ParameterError(f"{x} is in {pair[0].unit} and {y} in {pair[1].unit}; both have to be of one unit to make x + i y.")
            return cls(source, pair, f"{x}, {y}", None if isinstance(source, TimeHistory) else source.scene)
        if not isinstance(source, TimeHistory) and name is not None and name not in source:
            for form_x, form_y in PAIRS:
                x, y = form_x.format(name), form_y.format(name)
                if x in source and y in source:
                    return cls(source, (source[x], source[y]), name, source.scene)
        history, scene = chosen_history(source, name)
        return cls(source, (history,), history.name, scene)

    @property
    def plane(self) -> bool:
        return len(self.histories) == 2

    @property
    def unit(self) -> str:
        return self.histories[0].unit

    @property
    def times(self) -> npt.NDArray[np.float64]:
        return self.histories[0].times

    def span(self, start: float | None, end: float | None) -> tuple[float, float]:
        """Start and end of the part to analyse [s], checked against the record."""
        return chosen_span(self.histories[0], start, end)

    def at(self, times: npt.NDArray[np.float64]) -> Signal:
        """Values, complex for a place; interpolated as ``Response.at`` does it."""
        values = [values_at(self.source, history, times) for history in self.histories]
        return values[0] + 1j * values[1] if self.plane else values[0]


def _two(names: object) -> tuple[str, str]:
    if not isinstance(names, tuple | list) or len(names) != 2 or not all(isinstance(name, str) for name in names):
        raise ParameterError(
            f"channel = {names!r}: must be a channel, a place, or the two channels of a plane, like ('probe_x', 'probe_y')."
        )
    return names[0], names[1]


def turning_place(given: Source | MeasuredChannels, name: str, reference: str | TimeHistory | None) -> str | TimeHistory:
    """The shaft that orders and speeds count from: as given, else the place of the channel, else the reference shaft."""
    if reference is not None:
        return reference
    source = readable(given)
    if isinstance(source, TimeHistory):
        raise ParameterError("reference: a single time history has no shaft; give its angle as a TimeHistory.")
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        place = ".".join(parts[:count])
        if f"{place}.angle" in source:
            return place
    if source.scene is not None:
        return reference_shaft(source.scene)
    angles = [channel.removesuffix(".angle") for channel in source.channels if channel.endswith(".angle")]
    if not angles and isinstance(source, MeasuredChannels):
        raise ParameterError(
            f"Record {source.record.name!r} has no channel that is known to be the angle of a shaft: give reference=, the name of one [rad]"
            " or a TimeHistory."
        )
    if not angles:
        raise AnalysisError(f"Nothing turns in this response, so {name} has no orders.")
    return angles[0]
