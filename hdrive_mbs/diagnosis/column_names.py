"""Columns of a record under the names that a bench has for them, where the record says what they are."""

from __future__ import annotations

from collections.abc import Iterator

from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.errors import RecordError
from hdrive_mbs.records.record import Record


def as_the_bench_names_them(bench: Bench, record: Record) -> Record:
    """The record with a column that is mapped to a column of the bench, or to what that measures, under its name.

    A record read with ``channels={"n_mot": "motor.speed", "M": "motor_torque"}`` then serves a bench that calls them otherwise.
    Raises RecordError where two columns are mapped to the same.
    """
    for name in (*bench.measured, *bench.inputs):
        meant = list(_meant(bench, record, name))
        if len(meant) > 1 or (meant and name in record.channels):
            both = " and ".join(map(repr, [*meant, *([name] if name in record.channels else [])]))
            raise RecordError(
                f"Record {record.name!r}: {both} would both be what the bench calls {name!r}; map one of them, or leave one out."
            )
        for old in meant:
            record = record.renamed({old: name})
            if record[name].quantity == name:
                record = record.mapped({name: None})
    return record


def _meant(bench: Bench, record: Record, name: str) -> Iterator[str]:
    """Columns of names that the bench does not know, mapped to one of its names, or to a channel that this one alone measures."""
    channels = [item.channel for other, item in bench.measured.items() if other not in record.channels or other == name]
    channel = bench.measured[name].channel if name in bench.measured else None
    for own, item in record.channels.items():
        if own in bench.measured or own in bench.inputs or item.quantity is None:
            continue
        if item.quantity == name or (item.quantity == channel and channels.count(channel) == 1):
            yield own
