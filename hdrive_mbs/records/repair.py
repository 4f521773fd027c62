"""Repairs of a record: only what is asked for, and each one listed."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from hdrive_mbs.errors import ParameterError, RecordError, UnitError, unknown_place
from hdrive_mbs.records.checks.wrapped import seams_of, unwrapped
from hdrive_mbs.records.finding import Finding
from hdrive_mbs.records.record import Record
from hdrive_mbs.records.si_units import conversion
from hdrive_mbs.signals import FloatArray

WAYS = {
    "not_finite": ("interpolate", "drop", "keep"),
    "order": ("sort",),
    "duplicates": ("first", "mean"),
    "gaps": ("interpolate", "keep"),
    "uneven": ("resample",),
    "wrapped": ("unwrap", "keep"),
    "saturated": ("drop", "keep"),
    "stuck": ("drop", "keep"),
}
"""What can be done about each kind of finding, in the order in which it is done; units take a mapping or "keep"."""

LONGEST_RUN = 10
"""Samples in a row that may be interpolated unless ``longest`` says otherwise."""


def repaired(
    record: Record,
    *,
    not_finite: str | None = None,
    order: str | None = None,
    duplicates: str | None = None,
    gaps: str | None = None,
    uneven: str | None = None,
    units: Mapping[str, str] | str | None = None,
    wrapped: str | None = None,
    saturated: str | None = None,
    stuck: str | None = None,
    longest: int = LONGEST_RUN,
) -> Record:
    """A record with faults repaired; ``findings`` lists each repair and what is still wrong.

    not_finite : "interpolate" (straight lines over NaN), "drop" (leave these samples out of all channels), "keep"
    order : "sort" samples by time
    duplicates : of samples at one time take the "first", or the "mean"
    gaps : "interpolate" (samples at the usual step on straight lines), "keep"
    uneven : "resample" at the usual step
    units : {channel: the unit its numbers are really in}, or "keep"
    wrapped : "unwrap" angles that begin again after each turn, "keep"
    saturated, stuck : "drop" the channel, "keep"
    longest : samples in a row that may be interpolated

    Raises RecordError when a run to be interpolated is longer than ``longest``.
    """
    asked = {
        "not_finite": not_finite,
        "order": order,
        "duplicates": duplicates,
        "gaps": gaps,
        "uneven": uneven,
        "wrapped": wrapped,
        "saturated": saturated,
        "stuck": stuck,
    }
    for kind, way in asked.items():
        if way is not None and way not in WAYS[kind]:
            raise unknown_place(f"repair of {kind}", way, WAYS[kind], "repaired()")
    if not longest >= 0:
        raise ParameterError(f"longest = {longest} samples must be at least 0.")
    kept = {(kind, "") for kind, way in asked.items() if way == "keep"} | ({("units", "")} if units == "keep" else set())
    record = record.replacing(kept=record.kept | kept) if kept else record
    if units is not None:
        record = _with_units(record, units)
    if wrapped == "unwrap":
        record = _unwrapped(record)  # before anything is interpolated
    if not_finite is not None:
        record = _finite(record, not_finite, longest)
    if order is not None:
        record = _sorted(record)
    if duplicates is not None:
        record = _single(record, duplicates)
    if wrapped == "unwrap":
        record = _unwrapped(record)  # what shows once the samples are in order
    if gaps == "interpolate":
        record = _filled(record, longest)
    if uneven is not None and any(finding.kind == "uneven" and not finding.repaired for finding in record.findings):
        step = _without_seams(record).step
        record = _listed(record.resampled(step), "uneven", "", f"brought to even steps of {step:.6g} s (monotone cubic)")
    for kind, way in (("saturated", saturated), ("stuck", stuck)):
        if way == "drop":
            for name in [finding.channel for finding in record.blocking if finding.kind == kind]:
                record = _listed(record.without(name), kind, name, "the channel was left out")
    return record


def _listed(record: Record, kind: str, channel: str, text: str, where: str = "") -> Record:
    finding = Finding(kind=kind, channel=channel, where=where, text=text, repaired=True)
    return record.replacing(repairs=(*record.repairs, finding))


def _with_units(record: Record, units: Mapping[str, str] | str) -> Record:
    if isinstance(units, str):
        if units != "keep":
            raise unknown_place("repair of units", units, ("keep", "{channel: unit}"), "repaired()")
        return record
    for name, given in units.items():
        channel = record[name]
        where = f"Record {record.name!r}, channel {channel.name!r}"
        real = conversion(given, where)
        if real.unit != channel.unit:
            raise UnitError(
                f"{where}: it is in {channel.unit}, so its numbers cannot be in {given!r}; "
                f"read the file again with units={{{name!r}: {given!r}}}."
            )
        factor = real.factor
        new = channel.replacing(
            values=real.apply(channel.values),
            noise=None if channel.noise is None else channel.noise * factor,
            resolution=None if channel.resolution is None else channel.resolution * factor,
        )
        record = record.with_channels(new if item is channel else item for item in record)
        record = _listed(
            record, "units", channel.name, f"its numbers were taken for {given} and converted to {channel.unit} (times {factor:.6g})"
        )
    return record


def _unwrapped(record: Record) -> Record:
    for name in [finding.channel for finding in record.blocking if finding.kind == "wrapped"]:
        channel = record[name]
        seams = seams_of(channel.values)
        assert seams is not None
        new = channel.replacing(values=unwrapped(channel.values, seams.period))
        record = record.with_channels(new if item is channel else item for item in record)
        record = _listed(record, "wrapped", channel.name, f"goes on where it began again, by {seams.period:.6g} rad each time")
    return record


def _without_seams(record: Record) -> Record:
    """The record itself.  Raises RecordError where what is interpolated would lie between the end of a turn and its beginning."""
    for finding in record.blocking:
        if finding.kind == "wrapped":
            raise RecordError(
                f"Record {record.name!r}: {finding.channel!r} begins again after each turn, and a line from the end of a turn to its "
                "beginning is no measurement; add wrapped='unwrap', or wrapped='keep' where it really jumps."
            )
    return record


def _finite(record: Record, way: str, longest: int) -> Record:
    if way == "keep":
        return record
    if way == "drop":
        good = np.isfinite(record.times)
        for channel in record:
            good = good & np.isfinite(channel.values)
        lost = int((~good).sum())
        if not lost:
            return record
        if not good.any():
            raise RecordError(f"Record {record.name!r}: no sample is finite in all channels; leave out the channel that has no values.")
        return _listed(record.taking(good), "not_finite", "", f"{lost} samples were left out of all channels")
    for channel in _without_seams(record):
        bad = ~np.isfinite(channel.values)
        if not bad.any():
            continue
        run = _longest_run(bad)
        if run > longest or bad[0] or bad[-1]:
            reason = (
                f"a run of {run} samples (allowed: longest = {longest})"
                if run > longest
                else "the first or last sample, which has only one neighbour"
            )
            raise RecordError(
                f"Record {record.name!r}: {channel.name!r} is not finite over {reason}; "
                f"use not_finite='drop', record.between(start, end), or longest={run}."
            )
        values = channel.values.copy()
        values[bad] = np.interp(record.times[bad], record.times[~bad], values[~bad])
        new = channel.replacing(values=values)
        text = f"{int(bad.sum())} values replaced by straight lines between their neighbours, at most {run} in a row"
        record = _listed(record.with_channels(new if item is channel else item for item in record), "not_finite", channel.name, text)
    return record


def _longest_run(mask: np.ndarray) -> int:
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(int)))
    return int(np.max(edges[1::2] - edges[::2], initial=0))


def _sorted(record: Record) -> Record:
    order = np.argsort(record.times, kind="stable")
    moved = int(np.sum(order != np.arange(len(order))))
    return _listed(record.taking(order), "order", "", f"{moved} samples put into the order of time") if moved else record


def _single(record: Record, way: str) -> Record:
    order = np.argsort(record.times, kind="stable")
    if np.any(order != np.arange(len(order))):
        raise RecordError(f"Record {record.name!r}: samples at one time can be found only in order; add order='sort'.")
    times, first, counts = np.unique(record.times, return_index=True, return_counts=True)
    lost = len(record) - len(times)
    if not lost:
        return record
    differ = sum(
        not np.array_equal(channel.values[first][np.repeat(np.arange(len(times)), counts)], channel.values, equal_nan=True)
        for channel in record
    )
    if way == "first":
        new = record.taking(first)
    else:
        sums = {channel.name: np.add.reduceat(channel.values, first) / counts for channel in record}
        new = record.replacing(times=times, channels={channel.name: channel.replacing(values=sums[channel.name]) for channel in record})
    return _listed(
        new,
        "duplicates",
        "",
        f"{lost} samples at a time that was there already: the {way} was taken ({differ} channels had different values there)",
    )


def _filled(record: Record, longest: int) -> Record:
    """Samples at the usual step in every gap."""
    _without_seams(record.in_order("filling gaps"))
    steps = np.diff(record.times)
    missing = np.maximum(np.round(steps / record.step).astype(int) - 1, 0) * (steps > 1.5 * record.step)
    if not missing.any():
        return record
    if missing.max() > longest:
        at = float(record.times[int(np.argmax(missing))])
        raise RecordError(
            f"Record {record.name!r}: the gap at t = {at:.6g} s lacks {int(missing.max())} samples, more than longest = {longest}; "
            f"a straight line there is no measurement. "
            f"Take parts with record.between(start, end), gaps='keep', or longest={int(missing.max())}."
        )
    pieces = [np.linspace(record.times[i], record.times[i + 1], missing[i] + 2)[1:-1] for i in np.flatnonzero(missing)]
    added = np.concatenate(pieces)
    times = np.sort(np.concatenate((record.times, added)))

    def on_lines(values: FloatArray) -> FloatArray:
        return np.asarray(np.interp(times, record.times, values), float)

    channels = {channel.name: channel.replacing(values=on_lines(channel.values)) for channel in record}
    text = f"{int(missing.sum())} missing samples in {len(pieces)} gaps put on straight lines, at most {int(missing.max())} in a row"
    return _listed(record.replacing(times=times, channels=channels), "gaps", "", text)
