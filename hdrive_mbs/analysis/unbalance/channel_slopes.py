"""Slopes of quantities of a line: what a small motion of the coordinates changes in a displacement or a force."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.whirl.rotor_point import RotorPoint
from hdrive_mbs.expression import Expression, TraceError, Value, derivative, evaluate, trace, variables
from hdrive_mbs.network.moment import Moment, recording_moment
from hdrive_mbs.network.network import Channel, Network

FloatArray = npt.NDArray[np.float64]


class ChannelSlopes:
    """d(channel)/d(coordinate) and d(channel)/d(speed of coordinate), recorded once and evaluated at many states."""

    def __init__(self, network: Network, channels: Sequence[str], coordinates: Sequence[str]) -> None:
        known = {channel.name: channel for channel in network.channels}
        self.network = network
        self.channels = tuple(channels)
        self._index = {name: k for k, name in enumerate(coordinates)}
        self._constant = np.zeros((2, len(channels), len(coordinates)))
        self._varying: list[tuple[int, int, int, Expression]] = []
        self._plain: list[tuple[int, Channel]] = []
        for row, name in enumerate(channels):
            self._add(row, known[name])

    def _add(self, row: int, channel: Channel) -> None:
        try:
            recorded = trace(channel.read, recording_moment())
        except TraceError:
            self._plain.append((row, channel))
            return
        for name in variables(recorded):
            kind, _, owner = name.partition(":")
            if kind not in ("angle", "speed") or owner not in self._index:
                continue
            slope, which, column = derivative(recorded, name), int(kind == "speed"), self._index[owner]
            if variables(slope):
                self._varying.append((which, row, column, slope))
            else:
                self._constant[which, row, column] = float(np.asarray(evaluate(slope, {})))

    @property
    def is_constant(self) -> bool:
        """Whether the slopes are the same at every state."""
        return not self._varying and not self._plain

    def linear(self) -> FloatArray:
        """Slopes per displacement of channels that are linear, (channels, coordinates)."""
        assert self.is_constant
        return np.asarray(self._constant[0])

    def at(self, point: RotorPoint) -> FloatArray:
        """Slopes at a steady rotation, shape (2, channels, coordinates): per displacement, then per velocity."""
        slopes = self._constant.copy()
        moment = self.network.moment(np.float64(0.0), point.angles, point.speeds, point.states)
        known: dict[str, Value] = {"t": moment.time}
        for kind, values in (("angle", moment.angles), ("speed", moment.speeds), ("state", moment.states)):
            known |= {f"{kind}:{name}": value for name, value in values.items()}
        for which, row, column, slope in self._varying:
            slopes[which, row, column] = float(np.asarray(evaluate(slope, known)))
        for row, channel in self._plain:
            self._difference(row, channel, moment, slopes)
        return slopes

    def _difference(self, row: int, channel: Channel, moment: Moment, slopes: FloatArray) -> None:
        """Central differences for a law that cannot be recorded."""
        for which, kind in enumerate(("angles", "speeds")):
            values = dict(getattr(moment, kind))
            for name, column in self._index.items():
                h = 1e-7 * max(1e-2, abs(float(values[name])))
                ends = []
                for sign in (1.0, -1.0):
                    state = {"angles": moment.angles, "speeds": moment.speeds, kind: {**values, name: values[name] + sign * h}}
                    ends.append(float(channel.read(Moment(time=moment.time, states=moment.states, **state))))
                slopes[which, row, column] = (ends[0] - ends[1]) / (2.0 * h)
