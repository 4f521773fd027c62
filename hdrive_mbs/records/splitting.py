"""A part of a record to fit, and a part that the fit does not see."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError, RecordError, unknown_place

if TYPE_CHECKING:
    from hdrive_mbs.records.collection import Records
    from hdrive_mbs.records.record import Record

Mask = npt.NDArray[np.bool_]

KINDS = ("blocks", "end")


@dataclass(frozen=True, kw_only=True, eq=False)
class Split:
    """Two parts of one or several records that share no sample.

    fit, held_out : the pieces, each at its own times of the clock of its record
    fit_samples, held_out_samples : by record, True where a sample belongs to that part: a simulation runs
        through the whole record, because a state at the start of a piece is known only from what came before
    """

    fit: Records
    held_out: Records
    fit_samples: dict[str, Mask]
    held_out_samples: dict[str, Mask]


def split(record: Record, fit: float, by: str, *, blocks: int, guard: float) -> Split:
    """Split one record.  Raises ParameterError for a share that leaves one part empty, RecordError for too short a record."""
    from hdrive_mbs.records.collection import Records

    if not 0.0 < fit < 1.0:
        raise ParameterError(f"Record {record.name!r}: fit = {fit:g} must lie between 0 and 1, both parts need samples.")
    if not guard >= 0.0:
        raise ParameterError(f"Record {record.name!r}: guard = {guard:g} s must be at least 0 s.")
    if by not in KINDS:
        raise unknown_place("way to split", by, KINDS, "A record")
    record.in_order("splitting")
    held = _held_blocks(len(record), fit, blocks, record.name) if by == "blocks" else np.arange(len(record)) >= round(fit * len(record))
    keep = np.ones(len(record), dtype=bool)
    borders = np.flatnonzero(np.diff(held.astype(int)))
    for border in borders:
        middle = 0.5 * (record.times[border] + record.times[border + 1])
        keep &= np.abs(record.times - middle) >= guard
    parts = {"fit": ~held & keep, "held out": held & keep}
    for name, mask in parts.items():
        if mask.sum() < 2:
            raise RecordError(
                f"Record {record.name!r} is too short: {int(mask.sum())} samples are left {name} ({len(record)} in all, guard {guard:g} s)."
            )
    return Split(
        fit=Records(records=_pieces(record, parts["fit"], "fit")),
        held_out=Records(records=_pieces(record, parts["held out"], "held out")),
        fit_samples={record.name: parts["fit"]},
        held_out_samples={record.name: parts["held out"]},
    )


def _held_blocks(count: int, fit: float, blocks: int, name: str) -> Mask:
    """Equal blocks; the held-out ones are spread evenly, and neither the first nor (of several) the last."""
    if not 2 <= blocks <= count // 2:
        raise ParameterError(f"Record {name!r}: blocks = {blocks} must be from 2 to {count // 2}, half the number of samples.")
    number = min(max(round((1.0 - fit) * blocks), 1), blocks - 1)
    chosen = {int((index + 0.5) * blocks / number) for index in range(number)}
    block = np.arange(count) * blocks // count
    return np.isin(block, list(chosen))


def _pieces(record: Record, mask: Mask, part: str) -> tuple[Record, ...]:
    edges = np.flatnonzero(np.diff(np.concatenate(([False], mask, [False])).astype(int)))
    spans = list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
    return tuple(
        record.taking(np.arange(first, last)).replacing(name=f"{record.name} {part} {number}", run=record.run)
        for number, (first, last) in enumerate(spans, start=1)
        if last - first >= 2
    )
