"""A second clock among the channels: how far it drifts from the time of the record."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hdrive_mbs.records.finding import Finding

if TYPE_CHECKING:
    from hdrive_mbs.records.record import Record


def second_clocks(record: Record) -> Iterator[Finding]:
    """Each channel in seconds that rises with time is a clock: its drift and scatter against ``times``."""
    if len(record) < 16 or not np.all(np.isfinite(record.times)):
        return
    for channel in record:
        values = channel.values
        if channel.unit != "s" or not np.all(np.isfinite(values)) or not np.all(np.diff(values) >= 0.0) or np.ptp(values) == 0.0:
            continue
        centred = record.times - record.times.mean()
        spread = float(centred @ centred)
        if spread == 0.0:
            continue
        rate = float(centred @ (values - values.mean())) / spread
        scatter = float(np.std(values - values.mean() - rate * centred))
        error = scatter / np.sqrt(spread)
        if abs(rate - 1.0) > max(4.0 * error, 1e-9):
            apart = (rate - 1.0) * record.duration
            yield Finding(
                kind="clock",
                channel=channel.name,
                where="",
                text=(
                    f"this clock gains {1e6 * (rate - 1.0):.4g} us each second on the time of the record "
                    f"({apart:.4g} s over {record.duration:.4g} s, scatter {scatter:.3g} s); "
                    f"channels stamped by it belong in a record with time={channel.name!r}"
                ),
            )
