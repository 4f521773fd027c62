"""What reading and repairing did to the records of a diagnosis, and what their checks found, for its report."""

from __future__ import annotations

from collections.abc import Sequence

from hdrive_mbs.records.collection import Records
from hdrive_mbs.records.record import Record


def record_words(records: Sequence[Record]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Warnings, of what was changed in the measured values, and notes, of what was found and left."""
    found = Records(records=tuple(records)).findings
    changed = [f"Record {name!r}, {finding}" for name, finding in found if finding.repaired]
    left = [f"Record {name!r}, {finding}" for name, finding in found if not finding.repaired]
    return tuple(dict.fromkeys(changed)), tuple(dict.fromkeys(left))
