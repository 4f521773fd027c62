"""A measured record: channels in SI units over one time, with what is wrong with it."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hdrive_mbs.errors import ParameterError, PlaceError, RecordError, UnitError, unknown_place
from hdrive_mbs.records.finding import Finding
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.signals import FloatArray, TimeHistory
from hdrive_mbs.writing import write_text

if TYPE_CHECKING:
    from hdrive_mbs.records.splitting import Split


@dataclass(frozen=True, kw_only=True, eq=False)
class Record:
    """Channels that were sampled together.

    name : of the record
    times : s, shape (n,), as recorded (not necessarily in order; see ``findings``)
    channels : by name
    run : the experiment; records of other sensors of the same run bear the same; the name if not given
    origin : what the clock showed at time 0 [s]
    notes : what was done on the way here, in words
    repairs : faults that were repaired, each saying how
    kept : (kind, channel) of faults that the user decided to keep; an empty channel stands for all
    source, sha256 : the file that it was read from
    """

    name: str
    times: FloatArray
    channels: Mapping[str, Measurement]
    run: str = ""
    origin: float = 0.0
    notes: tuple[str, ...] = ()
    repairs: tuple[Finding, ...] = ()
    kept: frozenset[tuple[str, str]] = frozenset()
    source: str = ""
    sha256: str = ""

    def __post_init__(self) -> None:
        times = np.array(self.times, dtype=float)
        if times.ndim != 1:
            raise ParameterError(f"Record {self.name!r}: times of shape {times.shape} must be flat.")
        times.flags.writeable = False
        for name, channel in self.channels.items():
            if name != channel.name:
                raise ParameterError(f"Record {self.name!r}: channel {channel.name!r} is filed under the name {name!r}.")
            if len(channel) != len(times):
                raise ParameterError(f"Record {self.name!r}: channel {name!r} has {len(channel)} values at {len(times)} times.")
        quantities = [channel.quantity for channel in self.channels.values() if channel.quantity is not None]
        twice = sorted({item for item in quantities if quantities.count(item) > 1})
        if twice:
            raise ParameterError(f"Record {self.name!r}: two channels measure {twice[0]!r}; map one of them, or put them into two records.")
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "channels", dict(self.channels))
        object.__setattr__(self, "run", self.run or self.name)

    @classmethod
    def of(cls, name: str, histories: Iterable[TimeHistory]) -> Record:
        """A record of time histories (simulated ones, say) that share their times; each keeps its name as quantity."""
        given = tuple(histories)
        if not given:
            raise ParameterError(f"Record {name!r} needs at least one time history.")
        for history in given[1:]:
            if not np.array_equal(history.times, given[0].times):
                raise ParameterError(f"Record {name!r}: {history.name} and {given[0].name} have other times; resample one of them.")
        made = (Measurement(name=item.name, unit=item.unit, values=item.values, quantity=item.name) for item in given)
        return cls(name=name, times=given[0].times, channels={item.name: item for item in made})

    def __len__(self) -> int:
        return len(self.times)

    def __iter__(self) -> Iterator[Measurement]:
        return iter(self.channels.values())

    def __contains__(self, name: object) -> bool:
        return name in self.channels or any(name == channel.quantity for channel in self)

    def __getitem__(self, name: str) -> Measurement:
        """A channel by its name, or by the quantity of the scene that it measures."""
        if name in self.channels:
            return self.channels[name]
        for channel in self:
            if channel.quantity == name:
                return channel
        known = [item.name if item.quantity is None else f"{item.name} ({item.quantity})" for item in self]
        raise unknown_place("channel", name, known, f"Record {self.name!r}")

    def history(self, name: str) -> TimeHistory:
        """A channel with its times, for spectra and plots.  Raises RecordError for times that do not rise or values that are not finite."""
        channel = self[name]
        self.in_order(f"the history of {name!r}")
        if not np.all(np.isfinite(channel.values)):
            raise RecordError(
                f"Record {self.name!r}: {name!r} holds values that are not finite; use repaired(record, not_finite='interpolate')."
            )
        return TimeHistory(channel.name, channel.unit, self.times, channel.values)

    @property
    def duration(self) -> float:
        """From the earliest to the latest sample [s]."""
        finite = self.times[np.isfinite(self.times)]
        return float(np.ptp(finite)) if len(finite) else 0.0

    @cached_property
    def step(self) -> float:
        """Usual distance of two samples: the median of the positive ones [s]; NaN for fewer than two samples."""
        with np.errstate(over="ignore", invalid="ignore"):  # times of a damaged file may be of any size
            steps = np.diff(self.times)
        rising = steps[steps > 0.0]
        return float(np.median(rising)) if len(rising) else float("nan")

    @cached_property
    def findings(self) -> tuple[Finding, ...]:
        """What is wrong with the record: what was repaired, then what is not."""
        from hdrive_mbs.records.checking import check

        return (*self.repairs, *(self._decided(finding) for finding in check(self)))

    def _decided(self, finding: Finding) -> Finding:
        if not finding.blocks or not {(finding.kind, finding.channel), (finding.kind, "")} & self.kept:
            return finding
        return dataclasses.replace(finding, blocks=False, text=f"{finding.text} (kept as it is, as asked)")

    @property
    def blocking(self) -> tuple[Finding, ...]:
        """What has to be repaired, or kept on purpose, before the record is used."""
        return tuple(finding for finding in self.findings if finding.blocks)

    def checked(self) -> Record:
        """The record itself.  Raises RecordError when something in it would change results unnoticed."""
        if self.blocking:
            lines = "\n".join(
                f"  {finding.kind}{f' in {finding.channel!r}' if finding.channel else ''}: {finding.text}" for finding in self.blocking
            )
            raise RecordError(f"Record {self.name!r}{f' ({self.source})' if self.source else ''} cannot be used as it is:\n{lines}")
        return self

    def in_order(self, what: str) -> Record:
        """The record itself.  Raises RecordError when its times do not rise, which ``what`` needs."""
        if len(self) < 2 or not np.all(np.diff(self.times) > 0.0):
            reason = f"has {len(self)} samples" if len(self) < 2 else "has times that do not rise"
            raise RecordError(
                f"Record {self.name!r} {reason}; {what} needs at least two samples in order. "
                "Use repaired(record, order='sort', duplicates='first')."
            )
        return self

    def require(self, *names: str, duration: float = 0.0, samples: int = 0) -> Record:
        """The record itself, if it has these channels (or quantities), length [s] and number of samples.

        Raises PlaceError for a missing channel, RecordError for a record that is too short.
        """
        for name in names:
            self[name]
        if self.duration < duration * (1.0 - 1e-12) or len(self) < samples:
            raise RecordError(
                f"Record {self.name!r} has {len(self)} samples over {self.duration:g} s; needed are {samples} samples over {duration:g} s. "
                "Record longer, or ask for less."
            )
        return self

    def fits(self, known: Mapping[str, str], owner: str = "The scene") -> Record:
        """The record itself, if each quantity that it is mapped to is among ``known`` (name -> unit).

        Raises PlaceError for a quantity that the scene does not have, UnitError for one of another unit.
        """
        for channel in self:
            if channel.quantity is None:
                continue
            if channel.quantity not in known:
                place = channel.quantity.partition(".")[0]
                near = [name for name in known if name.partition(".")[0] == place] or sorted({name.partition(".")[0] for name in known})
                raise PlaceError(
                    f"Record {self.name!r} maps {channel.name!r} to {channel.quantity!r}, which is no channel of it. "
                    f"{owner} has: {', '.join(near)}."
                )
            unit = known[channel.quantity]
            if channel.unit != unit:
                raise UnitError(
                    f"Record {self.name!r}: {channel.name!r} is in {channel.unit}, but {channel.quantity} is in {unit}; "
                    f"map it to another quantity or give its unit, like units={{{channel.name!r}: {unit!r}}}."
                )
        return self

    def replacing(self, **changes: object) -> Record:
        """A copy with fields changed."""
        return dataclasses.replace(self, **changes)  # type: ignore[arg-type]

    def with_channels(self, channels: Iterable[Measurement]) -> Record:
        """A copy with other channels."""
        return self.replacing(channels={channel.name: channel for channel in channels})

    def selecting(self, *names: str) -> Record:
        """A copy with these channels only."""
        return self.with_channels(self[name] for name in names)

    def without(self, *names: str) -> Record:
        """A copy without these channels."""
        gone = {self[name].name for name in names}
        return self.with_channels(channel for channel in self if channel.name not in gone)

    def renamed(self, names: Mapping[str, str]) -> Record:
        """A copy with channels renamed: {old: new}."""
        new = {self[old].name: name for old, name in names.items()}
        result = [channel.replacing(name=new.get(channel.name, channel.name)) for channel in self]
        if len({channel.name for channel in result}) < len(result):
            raise ParameterError(f"Record {self.name!r}: renaming gives two channels one name.")
        kept = frozenset((kind, new.get(channel, channel)) for kind, channel in self.kept)
        return self.replacing(kept=kept).with_channels(result)

    def mapped(self, quantities: Mapping[str, str | None]) -> Record:
        """A copy whose channels measure quantities of a scene: ``{"motor_speed": "motor.speed"}``."""
        wanted = {self[name].name: quantity for name, quantity in quantities.items()}
        return self.with_channels(channel.replacing(quantity=wanted.get(channel.name, channel.quantity)) for channel in self)

    def annotated(self, *, noise: Mapping[str, float] | None = None, resolution: Mapping[str, float] | None = None) -> Record:
        """A copy whose channels know their noise (1 sigma) and resolution, in their SI units."""
        changes: dict[str, dict[str, float]] = {}
        for field, sizes in (("noise", noise or {}), ("resolution", resolution or {})):
            for name, size in sizes.items():
                changes.setdefault(self[name].name, {})[field] = size
        return self.with_channels(channel.replacing(**changes.get(channel.name, {})) for channel in self)

    def between(self, start: float, end: float) -> Record:
        """The part with start <= t <= end [s], at its own times.  Raises RecordError when it is empty."""
        inside = np.asarray((self.times >= start) & (self.times <= end))
        if not inside.any():
            raise RecordError(
                f"Record {self.name!r} has no sample between {start:g} s and {end:g} s; "
                f"it goes from {np.nanmin(self.times):g} s to {np.nanmax(self.times):g} s."
            )
        return self.taking(inside)

    def with_origin(self, origin: float) -> Record:
        """The same samples with times that count from another reading of the clock [s]."""
        return self if origin == self.origin else self.replacing(times=self.times + (self.origin - origin), origin=origin)

    def taking(self, chosen: np.ndarray) -> Record:
        """The samples with these indices, or with True in a mask."""
        return self.replacing(
            times=self.times[chosen], channels={channel.name: channel.replacing(values=channel.values[chosen]) for channel in self}
        )

    def resampled(self, step: float) -> Record:
        """The record at even times, ``step`` [s] apart; see hdrive_mbs.records.resampling for the filter against aliases."""
        from hdrive_mbs.records.resampling import resampled

        return resampled(self, step)

    def split(self, fit: float = 0.7, by: str = "blocks", *, blocks: int = 10, guard: float = 0.0) -> Split:
        """A part to fit and a part held out; see hdrive_mbs.records.splitting.

        fit : share of the samples to fit
        by : "blocks" (held-out blocks spread over the record) or "end" (the last part is held out)
        guard : time [s] left out on either side of a border, so that the parts share no transient or coloured noise
        """
        from hdrive_mbs.records.splitting import split

        return split(self, fit, by, blocks=blocks, guard=guard)

    def columns(self) -> dict[str, FloatArray]:
        """Columns for a table, headed ``name [unit]``."""
        return {"time [s]": self.times} | {f"{channel.name} [{channel.unit}]": channel.values for channel in self}

    def to_csv(self, path: str | Path) -> Path:
        """Write times and channels with units in the header; ``read_record`` reads it back."""
        columns = self.columns()
        head = ",".join(f'"{name}"' if "," in name else name for name in columns)
        rows = (",".join(f"{value:.12g}" for value in row) for row in zip(*columns.values(), strict=True))
        return write_text(path, "\n".join((head, *rows, "")))

    def describe(self) -> str:
        """Lines on times, channels, notes and findings."""
        step = f"{self.step:.6g} s apart" if np.isfinite(self.step) else "no usual step"
        times = f"{len(self)} samples, {step}, over {self.duration:.6g} s"
        source = f"  source {self.source} (sha256 {self.sha256[:12]}...)" if self.source else ""
        lines = [f"Record {self.name!r}: {times}{f', run {self.run!r}' if self.run != self.name else ''}", source]
        lines += [f"  {channel!r}" for channel in self]
        lines += [f"  note: {note}" for note in self.notes]
        lines += [f"  {finding}" for finding in self.findings]
        return "\n".join(line for line in lines if line)

    def __repr__(self) -> str:
        return self.describe()
