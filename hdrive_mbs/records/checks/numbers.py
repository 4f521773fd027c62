"""Values that are no finite numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hdrive_mbs.records.finding import Finding

if TYPE_CHECKING:
    from hdrive_mbs.records.record import Record


def not_finite(record: Record) -> Iterator[Finding]:
    """One finding for each channel with NaN or infinite values."""
    for channel in record:
        bad = ~np.isfinite(channel.values)
        if not bad.any():
            continue
        edges = np.flatnonzero(np.diff(np.concatenate(([False], bad, [False])).astype(int)))
        starts, lengths = edges[::2], edges[1::2] - edges[::2]
        longest = int(np.argmax(lengths))
        infinite = int(np.isinf(channel.values).sum())
        what = f"{int(bad.sum())} of {len(bad)} values are missing or no numbers" + (f" ({infinite} infinite)" if infinite else "")
        way = (
            "leave the channel out"
            if bad.all()
            else "not_finite='interpolate' bridges short runs, not_finite='drop' leaves these samples out of all channels"
        )
        yield Finding(
            kind="not_finite",
            channel=channel.name,
            where=f"t = {record.times[starts[longest]]:.6g} s",
            blocks=True,
            text=f"{what}, the longest run {int(lengths[longest])} samples from t = {record.times[starts[longest]]:.6g} s; {way}",
        )
