"""What a reader is asked for: which channels of a file, in which units, over which time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from hdrive_mbs.errors import FileFormatError, unknown_place
from hdrive_mbs.records.formats.file_format import Column, Contents, Wanted, base_name, fits, format_of, is_time

Channels = Mapping[str, str | None] | Sequence[str]


@dataclass(frozen=True, kw_only=True)
class Request:
    """What the caller asked for, of one file.

    also : names that are read besides the chosen channels where the file has them
    """

    path: Path
    channels: Mapping[str, str | None] | None
    units: Mapping[str, str]
    time: str | float | None
    also: tuple[str, ...] = ()

    @classmethod
    def of(
        cls, path: Path, channels: Channels | None, units: Mapping[str, str], time: str | float | None, also: Sequence[str] = ()
    ) -> Request:
        if isinstance(channels, str):
            channels = [channels]
        chosen = None if channels is None else dict(channels) if isinstance(channels, Mapping) else dict.fromkeys(channels)
        return cls(path=path, channels=chosen, units=units, time=time, also=tuple(also))

    @property
    def wanted(self) -> Wanted:
        """Which columns the reader has to give: the chosen ones and the time."""
        if self.channels is None:
            return Wanted()
        return Wanted((*self.channels, *self.also, *([self.time] if isinstance(self.time, str) else [])))

    def selects(self, name: str) -> bool:
        """Whether a channel is chosen."""
        if self.channels is None or name in self.also:
            return True
        return any(fits(pattern, name) or fits(pattern, base_name(name)) for pattern in self.channels)

    def quantity(self, name: str) -> str | None:
        """The channel of the scene for a channel, if the caller said."""
        if self.channels is None:
            return None
        exact = self.channels.get(name)
        if exact is not None:
            return exact
        return next((quantity for pattern, quantity in self.channels.items() if quantity is not None and fits(pattern, name)), None)

    def unit(self, name: str, given: str | None) -> str | None:
        """The unit of a channel: said by the caller, else by the file."""
        for key in (name, base_name(name)):
            if key in self.units:
                return self.units[key]
        patterns = (
            unit for pattern, unit in self.units.items() if "*" in pattern and (fits(pattern, name) or fits(pattern, base_name(name)))
        )
        return next(patterns, given)

    def check_units(self, contents: Contents) -> None:
        """Raise PlaceError for a unit that was given for nothing: a slip in a name would leave another unit in force."""
        if self.channels is not None:  # what is not chosen need not have been read
            return
        columns = {column.name: column.values.ndim for column in contents.columns}
        for pattern in self.units:
            numbered = base_name(pattern) in columns and columns[base_name(pattern)] == 2
            if not numbered and not any(fits(pattern, name) for name in (*columns, *contents.skipped)):
                raise unknown_place("channel", pattern, list(columns)[:60], str(self.path))

    def check_selected(self, found: Iterable[Column], contents: Contents) -> None:
        """Raise PlaceError for a chosen channel that the file lacks, FileFormatError for one that cannot be read."""
        names = [*(column.name for column in found), *(column.name for column in contents.columns if column.clock or is_time(column.name))]
        for pattern in self.channels or ():
            if any(fits(pattern, name) or fits(pattern, base_name(name)) for name in names):
                continue
            reason = contents.skipped.get(pattern)
            if reason is not None:
                raise FileFormatError(f"{self.path}: {pattern!r} cannot be read as a channel: it is {reason}.")
            raise unknown_place("channel", pattern, self._all_names(), str(self.path))

    def _all_names(self) -> list[str]:
        everything = format_of(self.path).contents(self.path, Wanted())
        names = sorted(column.name for column in everything.columns)
        return names if len(names) <= 60 else [*names[:60], f"... ({len(names)} in all)"]


def first_names(names: Iterable[str]) -> str:
    listed = list(names)
    return ", ".join(listed[:8]) + (f", ... ({len(listed)} in all)" if len(listed) > 8 else "")
