"""Several records: of several runs, and of several sensor sets with clocks and samplings of their own."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hdrive_mbs.errors import ParameterError, RecordError, unknown_place
from hdrive_mbs.records.alignment import clock_finding
from hdrive_mbs.records.finding import Finding
from hdrive_mbs.records.record import Record
from hdrive_mbs.records.splitting import Split


@dataclass(frozen=True, kw_only=True, eq=False)
class Records:
    """Records with different names; those of one ``run`` are sensor sets of one experiment."""

    records: tuple[Record, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "records", tuple(self.records))
        names = [record.name for record in self.records]
        for name in names:
            if names.count(name) > 1:
                raise ParameterError(f"Two records are named {name!r}; give each its own, like record.replacing(name='...').")

    @classmethod
    def of(cls, *records: Record) -> Records:
        """Records(records=(...)), written shorter."""
        return cls(records=records)

    def __len__(self) -> int:
        return len(self.records)

    def __iter__(self) -> Iterator[Record]:
        return iter(self.records)

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def __getitem__(self, name: str) -> Record:
        for record in self.records:
            if record.name == name:
                return record
        raise unknown_place("record", name, self.names, "This collection")

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(record.name for record in self.records)

    @property
    def runs(self) -> dict[str, tuple[Record, ...]]:
        """Sensor sets by run."""
        found: dict[str, list[Record]] = {}
        for record in self.records:
            found.setdefault(record.run, []).append(record)
        return {run: tuple(sets) for run, sets in found.items()}

    @cached_property
    def findings(self) -> tuple[tuple[str, Finding], ...]:
        """(record, finding) of all records, and of clocks of one run that differ (in a channel that two sets have in common)."""
        own = [(record.name, finding) for record in self.records for finding in record.findings]
        clocks = []
        for sets in self.runs.values():
            for one, other in itertools.combinations(_one_origin(sets), 2):
                finding = clock_finding(one, other)
                if finding is not None:
                    clocks.append((other.name, finding))
        return (*own, *clocks)

    def checked(self) -> Records:
        """The records themselves.  Raises RecordError when something in one would change results unnoticed."""
        blocking = [f"  {name}: {finding.text}" for name, finding in self.findings if finding.blocks]
        if blocking:
            raise RecordError("The records cannot be used as they are:\n" + "\n".join(blocking))
        return self

    def each(self, change: Callable[[Record], Record]) -> Records:
        """A copy with every record changed: ``records.each(lambda record: record.resampled(1e-3))``."""
        return Records(records=tuple(change(record) for record in self.records))

    def mapped(self, quantities: Mapping[str, str | None]) -> Records:
        """A copy whose channels measure quantities of a scene; a record without one of the channels goes without it.

        Raises PlaceError for a channel that no record has.
        """
        for name in quantities:
            if not any(name in record for record in self.records):
                known = sorted({channel.name for record in self.records for channel in record})
                raise unknown_place("channel", name, known, "None of the records")
        return self.each(lambda record: record.mapped({name: quantity for name, quantity in quantities.items() if name in record}))

    def split(self, fit: float = 0.7, by: str = "blocks", *, blocks: int = 10, guard: float = 0.0) -> Split:
        """A part to fit and a part held out: blocks of every record, the end of every record, or whole runs (by="runs")."""
        if by == "runs":
            return self._split_runs(fit)
        parts = [record.split(fit, by, blocks=blocks, guard=guard) for record in self.records]
        return Split(
            fit=Records(records=tuple(piece for part in parts for piece in part.fit)),
            held_out=Records(records=tuple(piece for part in parts for piece in part.held_out)),
            fit_samples={name: mask for part in parts for name, mask in part.fit_samples.items()},
            held_out_samples={name: mask for part in parts for name, mask in part.held_out_samples.items()},
        )

    def _split_runs(self, fit: float) -> Split:
        runs = list(self.runs)
        if not 0.0 < fit < 1.0 or len(runs) < 2:
            raise ParameterError(
                f"fit = {fit:g} of {len(runs)} runs: to hold out whole runs take at least two, and a share between 0 and 1."
            )
        first_held = min(max(round(fit * len(runs)), 1), len(runs) - 1)
        fitted = [record for record in self.records if record.run in runs[:first_held]]
        held = [record for record in self.records if record.run in runs[first_held:]]
        return Split(
            fit=Records(records=tuple(fitted)),
            held_out=Records(records=tuple(held)),
            fit_samples={record.name: np.full(len(record), record in fitted) for record in self.records},
            held_out_samples={record.name: np.full(len(record), record in held) for record in self.records},
        )

    def together(self, run: str, step: float) -> Record:
        """All sensor sets of a run as one record at even times, ``step`` [s] apart, over the time that all cover.

        Channels that several sets have are told apart by the name of the set.  Coarser steps pass the
        filter of ``Record.resampled``.  The clocks must have been brought together before (``aligned``).
        """
        if run not in self.runs:
            raise unknown_place("run", run, self.runs, "This collection")
        sets = _one_origin(self.runs[run])
        for _, finding in Records(records=sets).findings:
            if finding.kind == "clock" and finding.blocks:
                raise RecordError(f"Run {run!r}: {finding.text}.")
        start, end = max(float(item.times[0]) for item in sets), min(float(item.times[-1]) for item in sets)
        if not end - start >= step:
            raise RecordError(f"Run {run!r}: its sensor sets have no time in common ({start:g} s to {end:g} s).")
        times = np.minimum(start + step * np.arange(int(np.floor((end - start) / step * (1.0 + 1e-12))) + 1), end)
        names = [channel.name for item in sets for channel in item]
        quantities = [channel.quantity for item in sets for channel in item if channel.quantity is not None]
        channels = []
        for item in sets:
            even = item.resampled(step)
            for channel in even:
                values = even.history(channel.name).at(np.clip(times, even.times[0], even.times[-1]))
                name = channel.name if names.count(channel.name) == 1 else f"{item.name}.{channel.name}"
                twice = channel.quantity is not None and quantities.count(channel.quantity) > 1
                quantity = None if twice and item is not next(one for one in sets if channel.quantity in one) else channel.quantity
                channels.append(channel.replacing(name=name, values=values, quantity=quantity))
        note = f"{', '.join(item.name for item in sets)} brought to even times, {step:.6g} s apart"
        first = sets[0].replacing(
            name=run, run=run, times=times, channels={channel.name: channel for channel in channels}, notes=(*sets[0].notes, note)
        )
        return first.replacing(
            repairs=tuple(finding for item in sets for finding in item.repairs),
            source=", ".join(item.source for item in sets if item.source),
        )

    def describe(self) -> str:
        """Lines on every record, and on clocks that differ."""
        own = {id(finding) for record in self.records for finding in record.findings}
        lines = [record.describe() for record in self.records]
        lines += [f"{name}: {finding}" for name, finding in self.findings if id(finding) not in own]
        return "\n".join(lines)

    def __repr__(self) -> str:
        return self.describe()


def _one_origin(sets: tuple[Record, ...]) -> tuple[Record, ...]:
    """Sensor sets whose times count from the same reading of the clock, that of the first."""
    return tuple(record.with_origin(sets[0].origin) for record in sets)
