"""Measured files -> records in SI units, with everything that is wrong with them said."""

from __future__ import annotations

import hashlib
import os
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.errors import FileFormatError, RecordError, UnitError, unknown_place
from hdrive_mbs.records.collection import Records
from hdrive_mbs.records.file_clocks import by_clock, flattened
from hdrive_mbs.records.formats.file_format import Column, Contents, base_name, fits, format_of, formats
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record
from hdrive_mbs.records.repair import repaired
from hdrive_mbs.records.request import Channels, Request, first_names
from hdrive_mbs.records.si_units import conversion


def read_record(
    path: str | os.PathLike[str],
    *,
    channels: Channels | None = None,
    units: Mapping[str, str] | None = None,
    time: str | float | None = None,
    name: str | None = None,
    noise: Mapping[str, float] | None = None,
    resolution: Mapping[str, float] | None = None,
    repair: Mapping[str, Any] | None = None,
    refuse: bool = True,
) -> Record:
    """Read one record from a CSV or other text table, Parquet, MATLAB, MDF 4 or HDF5 file.

    channels : what to read: names, or {name in the file: channel of the scene, like "motor.speed", or None};
        ``*`` stands for any text; every channel if not given
    units : {name: unit} where the file says none or a wrong one; ``*`` stands for any text; a unit may have a
        size ("3.83e-4 rad" for one count of an encoder)
    time : name of the column with the time; or the step [s] (or text, "0.2 ms", "5 kHz") of an even sampling
        that the file does not hold
    noise, resolution : {name: size} in SI units
    repair : arguments of ``repaired``, like {"gaps": "interpolate"}
    refuse : raise RecordError for faults that would change results; False gives the record with its ``findings``

    Numbers are converted to SI; a matrix gives channels ``name[1]``, ``name[2]``, ... counted from 1.
    Raises FileFormatError for a file that cannot be read, UnitError for a missing or impossible unit,
    PlaceError for a missing channel, RecordError for faults, or for channels with several times (read
    these with ``read_records``).
    """
    records = _read(Path(path), channels, units or {}, time)
    if len(records) > 1:
        listed = "; ".join(f"{item.name} ({len(item)} samples: {first_names(item.channels)})" for item in records)
        raise RecordError(
            f"{path} holds channels with {len(records)} different times: {listed}. "
            "Read all with read_records(path), or some with channels=[...] or time='...'."
        )
    record = records[0].replacing(name=name or Path(path).stem, run="")
    return _finished(record, noise, resolution, repair, refuse)


def read_records(
    paths: str | os.PathLike[str] | Iterable[str | os.PathLike[str]],
    *,
    channels: Channels | None = None,
    units: Mapping[str, str] | None = None,
    time: str | float | None = None,
    noise: Mapping[str, float] | None = None,
    resolution: Mapping[str, float] | None = None,
    repair: Mapping[str, Any] | None = None,
    refuse: bool = True,
    also: Sequence[str] = (),
) -> Records:
    """Read every record of a file, of several files, or of a folder (its files of known formats, sorted by name).

    Each file is a run, named by its stem; channels of a file with different times become records
    ``run:group``.  With several records a channel that one of them lacks is left out there, and refused
    when all lack it; names of ``also`` are read besides ``channels`` where there are such.  Other arguments as
    in ``read_record``; names of ``noise`` and ``resolution`` that a record lacks are left out there.
    """
    files = record_files(paths)
    found: list[Record] = []
    for path in files:
        found.extend(_read(path, channels, units or {}, time, lenient=len(files) > 1, also=also))
    for pattern in Request.of(files[0], channels, {}, None).channels or ():
        if not any(fits(pattern, name) or fits(pattern, base_name(name)) for record in found for name in record.channels):
            known = sorted({name for record in found for name in record.channels})
            raise unknown_place("channel", pattern, known, "None of the files")
    for name in {**(noise or {}), **(resolution or {})}:
        if not any(name in record for record in found):
            raise unknown_place("channel", name, sorted({channel.name for record in found for channel in record}), "None of the files")
    names = _run_names(files)
    found = [item.replacing(name=f"{names[item.source]}{item.name.removeprefix(item.run)}", run=names[item.source]) for item in found]
    made = []
    for record in found:
        here = (
            {name: size for name, size in (noise or {}).items() if name in record},
            {name: size for name, size in (resolution or {}).items() if name in record},
        )
        made.append(_finished(record, *here, repair, refuse))
    records = Records(records=tuple(made))
    return records.checked() if refuse else records


def read_columns(
    path: str | os.PathLike[str], *, units: Mapping[str, str] | None = None, channels: Channels | None = None
) -> dict[str, Measurement]:
    """The columns of a table that has no time (amplitudes over speed, say), in SI units, by name."""
    file = Path(path)
    request = Request.of(file, channels, units or {}, None)
    contents = format_of(file).contents(file, request.wanted)
    flat = [one for column in contents.columns for one in flattened(file, column, max(column.values.shape)) if request.selects(one.name)]
    request.check_selected(flat, contents)
    return {item.name: item for item in _measured(flat, request)}


def _finished(
    record: Record,
    noise: Mapping[str, float] | None,
    resolution: Mapping[str, float] | None,
    repair: Mapping[str, Any] | None,
    refuse: bool,
) -> Record:
    if noise or resolution:
        record = record.annotated(noise=noise, resolution=resolution)
    if repair:
        record = repaired(record, **repair)
    return record.checked() if refuse else record


def _run_names(files: Sequence[Path]) -> dict[str, str]:
    """File -> name of its run: the stem, with the folder or suffix where stems repeat."""
    ways = (lambda path: path.stem, lambda path: f"{path.parent.name}/{path.stem}", lambda path: path.name, str)
    for way in ways:
        names = [way(path) for path in files]
        if len(set(names)) == len(names):
            break
    return {str(path): name for path, name in zip(files, names, strict=True)}


def record_files(paths: str | os.PathLike[str] | Iterable[str | os.PathLike[str]]) -> list[Path]:
    """The files themselves; of a folder those whose suffix is that of a known format, by name.

    Raises FileFormatError for a folder without any.
    """
    given = [Path(paths)] if isinstance(paths, (str, os.PathLike)) else [Path(item) for item in paths]
    suffixes = {suffix for item in formats() for suffix in item.suffixes}
    files: list[Path] = []
    for path in given:
        if path.is_dir():
            inside = sorted(item for item in path.iterdir() if item.is_file() and item.suffix.lower() in suffixes)
            if not inside:
                raise FileFormatError(f"{path} holds no file with one of the suffixes {', '.join(sorted(suffixes))}.")
            files.extend(inside)
        else:
            files.append(path)
    if not files:
        raise FileFormatError("No file was given to read.")
    return files


def _read(
    path: Path,
    channels: Channels | None,
    units: Mapping[str, str],
    time: str | float | None,
    lenient: bool = False,
    also: Sequence[str] = (),
) -> list[Record]:
    """All records of one file: channels by the time that they share."""
    request = Request.of(path, channels, units, time, also)
    file_format = format_of(path)
    contents = file_format.contents(path, request.wanted)
    request.check_units(contents)
    if not contents.columns and channels is None:
        skipped = "; ".join(f"{name}: {reason}" for name, reason in list(contents.skipped.items())[:10])
        raise FileFormatError(f"{path} ({file_format.name}) holds no column of numbers{f' ({skipped})' if skipped else ''}.")
    clocks, left = by_clock(request, contents)
    chosen = [(clock, [column for column in members if request.selects(column.name)]) for clock, members in clocks]
    chosen = [(clock, members) for clock, members in chosen if members]
    timeless = [name for name in left if request.channels is not None and request.selects(name)]
    if timeless:
        raise RecordError(
            f"{path}: {timeless[0]!r} has no time of its own length beside it; "
            "name its time with time='...' or give the step of an even sampling, time=1e-3 (s)."
        )
    if not lenient:
        request.check_selected([column for _, members in chosen for column in members], contents)
        if not chosen:
            raise RecordError(_no_time(path, contents, left))
    elif not chosen and channels is None:
        raise RecordError(_no_time(path, contents, left))
    digest = _digest(path)
    notes = contents.notes
    if request.channels is None:
        notes += tuple(f"{name} was not read: {reason}" for name, reason in contents.skipped.items())
        notes += tuple(f"{name} was not read: no time of its length beside it" for name in left)
    read = [clock.times(request) for clock, _ in chosen]
    first = min((origin for _, origin, _ in read), default=0.0)
    made = []
    for (clock, members), (times, origin, note) in zip(chosen, read, strict=True):
        measured = _measured(members, request)
        made.append(
            Record(
                name=f"{path.stem}{f':{clock.label}' if len(chosen) > 1 else ''}",
                run=path.stem,
                times=times + (origin - first),  # clocks of one file keep their common origin
                channels={item.name: item for item in measured},
                origin=first,
                notes=_shortened((*note, *notes)),
                source=str(path),
                sha256=digest,
            )
        )
    return made


def _digest(path: Path) -> str:
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()


def _shortened(notes: tuple[str, ...]) -> tuple[str, ...]:
    return notes if len(notes) <= 20 else (*notes[:20], f"... and {len(notes) - 20} notes more")


def _no_time(path: Path, contents: Contents, left: Sequence[str]) -> str:
    names = ", ".join(left[:20]) or ", ".join(column.name for column in contents.columns[:20]) or "none"
    return (
        f"{path}: no column is the time. It has: {names}. Name it with time='...', or give the step of an even sampling, time=2e-4 (s); "
        "a table over something else is read by read_columns."
    )


def _measured(columns: Sequence[Column], request: Request) -> list[Measurement]:
    """Channels in SI units.  Raises UnitError that names every channel without a unit."""
    names = [column.name for column in columns]
    twice = sorted(name for name, count in Counter(names).items() if count > 1)
    if twice:
        raise FileFormatError(
            f"{request.path}: {twice[0]!r} occurs {names.count(twice[0])} times over one time; such a name cannot be told apart."
        )
    units = {column.name: request.unit(column.name, column.unit) for column in columns}
    missing = [name for name, unit in units.items() if unit is None or not unit.strip()]
    if missing:
        some = ", ".join(f"{name!r}: '...'" for name in missing[:6])
        raise UnitError(
            f"{request.path}: no unit for {first_names(missing)}; the file names none. "
            f"Give it with units={{{some}{', ...' if len(missing) > 6 else ''}}}, "
            "'1' for a plain number, or leave the channel out with channels=[...]."
        )
    made = []
    for column in columns:
        unit = str(units[column.name])
        try:
            scale = conversion(unit, f"{request.path}, channel {column.name!r}")
        except UnitError as error:
            raise UnitError(
                f"{error} Give another with units={{{column.name!r}: '...'}}, or leave the channel out with channels=[...]."
            ) from None
        values = scale.apply(np.asarray(column.values, dtype=float))
        quantity = request.quantity(column.name)
        made.append(Measurement(name=column.name, unit=scale.unit, values=values, quantity=quantity, given=unit.strip()))
    return made
