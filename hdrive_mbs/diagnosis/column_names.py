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
        if name in record.channels:
            continue
        meant = list(_meant(bench, record, name))
        if len(meant) > 1:
            raise RecordError(
                f"Record {record.name!r}: {' and '.join(map(repr, meant))} are both mapped to what the bench calls {name!r};"
                " map one of them."
            )
        for old in meant:
            record = record.renamed({old: name})
            if record[name].quantity == name:
                record = record.mapped({name: None})
    return record


def _meant(bench: Bench, record: Record, name: str) -> Iterator[str]:
    asked = {name, *((bench.measured[name].channel,) if name in bench.measured else ())}
    for own, item in record.channels.items():
        if item.quantity in asked and own not in bench.measured and own not in bench.inputs:
            yield own
