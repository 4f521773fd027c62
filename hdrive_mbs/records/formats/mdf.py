"""MDF version 4 files (asammdf): the channels of every channel group, with the group's own time.

A conversion by a formula is text that would have to be run, so such channels are not read; attachments
are never opened.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.records.formats.file_format import Column, Contents, Format, Wanted, broken, check_width, real_numbers

PLAIN_CONVERSIONS = {0, 1, 2, 4, 5, 6}
"""Identity, linear, rational and the three tables of numbers (ASAM MDF 4, block CC); 3 is a formula, from 7 on text."""


def read(path: Path, wanted: Wanted) -> Contents:
    """All numeric channels.  A sample that its recorder marked as invalid becomes NaN."""
    import asammdf

    skipped: dict[str, str] = {}
    columns: list[Column] = []
    notes: list[str] = []
    try:
        with asammdf.MDF(str(path), process_bus_logging=False) as file:
            if not str(file.version).startswith("4"):
                raise ValueError(f"version {file.version}; version 4 can be read")
            several = len(file.groups) > 1
            for group, content in enumerate(file.groups):
                label = (f"group {group}",) if several else ()
                master = file.masters_db.get(group)
                for index, channel in enumerate(content.channels):
                    if not wanted(channel.name) and index != master:
                        continue
                    kind = 0 if channel.conversion is None else int(channel.conversion.conversion_type)
                    if kind not in PLAIN_CONVERSIONS:
                        what = "a formula, which is not run" if kind == 3 else "a table of text"
                        skipped[channel.name] = f"a channel that is converted by {what}"
                        continue
                    signal = file.get(group=group, index=index, ignore_invalidation_bits=True)
                    values, invalid = _numbers(signal)
                    problem = real_numbers(values)
                    if problem or values.ndim != 1:
                        skipped[channel.name] = problem or f"an array of shape {values.shape}"
                        continue
                    if invalid:
                        notes.append(f"channel {channel.name!r}: {invalid} samples are marked as invalid")
                    unit = signal.unit or ("s" if index == master else None)
                    columns.append(Column(name=channel.name, unit=unit, values=values, group=label, clock=index == master))
    except Exception as error:  # asammdf raises many kinds for a damaged file
        raise broken(path, "MDF 4", error) from error
    check_width(path, columns)
    return Contents(columns=tuple(columns), skipped=skipped, notes=tuple(notes))


def _numbers(signal: Any) -> tuple[np.ndarray, int]:
    """Values and how many are marked invalid; these are NaN."""
    values = np.asarray(signal.samples)
    bits = signal.invalidation_bits
    marked = None if bits is None else np.asarray(bits, dtype=bool)
    if marked is None or not marked.any():
        return values, 0
    values = values.astype(float)
    values[marked] = np.nan
    return values, int(marked.sum())


FORMAT = Format(
    name="MDF 4",
    suffixes=(".mf4", ".mdf"),
    recognises=lambda head: head.startswith(b"MDF     "),
    read=read,
    needs=("asammdf",),
    apart=True,
)
