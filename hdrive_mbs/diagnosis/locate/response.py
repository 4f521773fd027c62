"""What an unknown force at each place does to the columns of a trial."""

from __future__ import annotations

import copy
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.locate.line import Line, of_windows
from hdrive_mbs.diagnosis.locate.linear import Transfers
from hdrive_mbs.diagnosis.locate.motion import Motion
from hdrive_mbs.diagnosis.locate.sources import Source
from hdrive_mbs.diagnosis.locate.spectra import Spectra

ComplexArray = npt.NDArray[np.complex128]

SLOWEST = 0.25
"""Of the distance of two bins: the frequency that stands for zero."""


KEPT = 8
"""Sources of a trial whose transfers are kept: those of all at once take about a gigabyte on a rotor line."""


class _Worked:
    """How the transfers of a trial are worked out."""

    def __init__(self, line: Line, spectra: Spectra) -> None:
        self._whitening, self._windows = spectra.whitening, len(spectra.values)
        rates = np.maximum(spectra.frequencies, SLOWEST * spectra.frequencies[1])
        late = np.array([item.late * spectra.trial.every for item in spectra.trial.measured.values()])
        self._delay = np.exp(1j * spectra.frequencies[:, None] * late)[..., None]
        self._transfers = Transfers(line.linear, 1j * rates)
        self._seen = None if line.observer is None else line.observer.noise_transfer(rates)

    def acting(self, at: Sequence[int]) -> ComplexArray:
        """Of forces of the line, shape (windows, bins, columns, forces)."""
        transfer = self._transfers.of(at) * self._delay
        if self._seen is not None:
            transfer = of_windows(self._seen @ transfer, self._windows)
        return np.asarray(self._whitening @ transfer)

    def errors(self, at: Sequence[int]) -> ComplexArray:
        """Of columns that err, shape (windows, bins, columns, those)."""
        own = list(at)
        if self._seen is None:
            return np.ascontiguousarray(self._whitening[..., own])
        return np.asarray(self._whitening @ of_windows(self._seen[..., own], self._windows))


class OfSources(Mapping[str, ComplexArray]):
    """Source -> whitened transfer, shape (windows, bins, columns, d), worked out when it is asked for.

    columns : of a source that acts, where its forces stand among those of the line
    errors : of sensors, where their columns stand;  rotating : sources whose force turns with the shaft
    """

    def __init__(
        self,
        line: Line,
        spectra: Spectra,
        columns: Mapping[str, Sequence[int]],
        errors: Mapping[str, Sequence[int]],
        rotating: Collection[str],
    ) -> None:
        self._columns = {name: at for name, at in columns.items() if name not in errors}
        self._errors, self._rotating = dict(errors), frozenset(rotating)
        self._worked: _Worked | None = _Worked(line, spectra)
        self._kept: dict[str, ComplexArray] = {}

    def __getitem__(self, name: str) -> ComplexArray:
        if name not in self:
            raise KeyError(name)
        if name in self._errors and name not in self._kept and self._worked is not None:
            return self._worked.errors(self._errors[name])
        if name not in self._kept:
            self.fetch([name])
        return self._kept[name]

    def __contains__(self, name: object) -> bool:
        return name in self._errors or name in self._columns

    def __iter__(self) -> Iterator[str]:
        return iter((*self._columns, *self._errors))

    def __len__(self) -> int:
        return len(self._columns) + len(self._errors)

    def fetch(self, names: Sequence[str]) -> None:
        """Work out several together, at most KEPT, which is quicker than one by one; those that were asked for longest ago are dropped."""
        wanted = [name for name in names if name in self._columns and name not in self._kept]
        if not wanted or self._worked is None:
            return
        transfer = self._worked.acting([k for name in wanted for k in self._columns[name]])
        first = 0
        for name in wanted:
            own = transfer[..., first : first + len(self._columns[name])]
            first += own.shape[-1]
            self._kept[name] = np.ascontiguousarray(own[..., 0::2] - 1j * own[..., 1::2] if name in self._rotating else own)
        while len(self._kept) > KEPT:
            self._kept.pop(next(iter(self._kept)))

    def forget(self) -> None:
        """Drop what is kept, to be worked out again when it is asked for."""
        if self._worked is not None:
            self._kept.clear()

    def narrowed(self, name: str) -> OfSources:
        """One source alone, without anything with which others are worked out."""
        made = copy.copy(self)
        made._kept = {name: self[name]} if name in self else {}
        made._columns = {key: at for key, at in self._columns.items() if key == name}
        made._errors = {key: at for key, at in self._errors.items() if key == name}
        made._worked = None
        return made


@dataclass(frozen=True, eq=False)
class Response:
    """Transfers of one trial.

    sources : what may act in this trial, by name;  of : their whitened transfers
    """

    sources: Mapping[str, Source]
    of: OfSources


def response(motion: Motion, line: Line, spectra: Spectra) -> Response:
    """Of all places of a trial: bodies, connections and the like, and sensors.

    A column that measures a channel without a sensor in the scene is a place by its own name.
    """
    trial, network = motion.trial, motion.network
    acting = {source.name: [k for k, (name, _) in enumerate(line.states) if name == source.name] for source in line.sources}
    known = {channel.name: channel for channel in network.channels}
    readers, errors = {}, {}
    for k, (column, item) in enumerate(trial.measured.items()):
        channel = known.get(item.channel)
        sensor = channel is not None and channel.reads is not None
        if not sensor and item.channel.endswith((".torque", ".command")):
            continue  # a command: what is wrong with it is a force at the motor
        name = item.channel if sensor else column
        errors[name] = [k]
        readers[name] = Source(name, {}, channel.unit if channel is not None else "")
    for at, columns in line.sensors.items():
        errors[at] = [list(trial.measured).index(column) for column in columns]
        readers[at] = Source(at, {}, known[trial.measured[columns[0]].channel].unit, columns=columns)
    rotating = [source.name for source in line.sources if source.rotating]
    return Response({source.name: source for source in line.sources} | readers, OfSources(line, spectra, acting, errors, rotating))
