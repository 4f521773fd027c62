"""Angles that begin again at the end of a turn: an encoder that counts within one turn, or one of so many bits.

Such an angle falls by its whole period from one sample to the next while the shaft goes on turning.  A jump is believed to be that where
it goes against the motion before and after it, where all jumps are of one size, and where that size is what the channel spans.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hdrive_mbs.records.finding import Finding
from hdrive_mbs.signals import FloatArray

if TYPE_CHECKING:
    from hdrive_mbs.records.record import Record

JUMP, STEP = 0.5, 0.25
"""Shares of the span of a channel: a jump is at least the first, and every other step at most the second."""
AGAINST, BESIDE = 0.9, 20
"""Share of the seams at which the angle jumps against the motion beside them, and the samples to both sides that say how it moves."""
ALIKE, SPANNED = 0.8, (0.75, 1.1)
"""Smallest over largest jump, and the span of the channel over the period."""
TURN = 0.02
"""Relative deviation from 2 pi within which a period is a whole turn."""


@dataclass(frozen=True, eq=False)
class Seams:
    """Where an angle begins again: the period [rad], and the samples before its jumps."""

    period: float
    before: npt.NDArray[np.intp]


def wrapped_angles(record: Record) -> Iterator[Finding]:
    """Channels in rad that begin again."""
    if len(record) < 16 or not np.all(np.isfinite(record.times)) or not np.all(np.diff(record.times) > 0.0):
        return
    for channel in record:
        seams = seams_of(channel.values) if channel.unit == "rad" else None
        if seams is None:
            continue
        often = "once" if len(seams.before) == 1 else f"{len(seams.before)} times"
        text = (
            f"{channel.name} begins again {often}, by {seams.period:.6g} rad each time, while it goes on turning: an angle within one "
            "turn. Use wrapped='unwrap', or wrapped='keep' where it really jumps"
        )
        where = f"t = {record.times[seams.before[0]]:.6g} s"
        yield Finding(kind="wrapped", channel=channel.name, where=where, blocks=True, text=text)


def seams_of(values: FloatArray) -> Seams | None:
    """Where an angle begins again; None where it does not.  What is not finite is passed over."""
    where = np.flatnonzero(np.isfinite(values))
    finite = values[where]
    span = float(np.ptp(finite)) if len(finite) else 0.0
    if span == 0.0:
        return None
    steps = np.diff(finite)
    sizes = np.abs(steps)
    jumps = np.flatnonzero(sizes > JUMP * span)
    others = np.delete(sizes, jumps)
    if not len(jumps) or len(jumps) > 0.2 * len(steps) or others.max(initial=0.0) > STEP * span:
        return None
    if sizes[jumps].min() < ALIKE * sizes[jumps].max():
        return None
    groups = np.split(jumps, np.flatnonzero(np.diff(jumps) > BESIDE) + 1)
    motions = [_motion_at(seam, steps, jumps) for seam in groups]
    period = float(np.median([sizes[seam[0]] + abs(motion) for seam, motion in zip(groups, motions, strict=True)]))
    nets = [float(np.sum(np.sign(steps[seam]))) for seam in groups]  # noise may cross a seam several times; a spike goes there and back
    against = [net * motion < 0.0 for net, motion in zip(nets, motions, strict=True) if net]
    if not against or np.mean(against) < AGAINST or not SPANNED[0] <= span / period <= SPANNED[1]:
        return None
    return Seams(2.0 * math.pi if abs(period / (2.0 * math.pi) - 1.0) < TURN else period, where[jumps])


def _motion_at(seam: npt.NDArray[np.intp], steps: FloatArray, jumps: npt.NDArray[np.intp]) -> float:
    """Mean step of the samples beside a seam."""
    first, last = max(int(seam[0]) - BESIDE, 0), min(int(seam[-1]) + BESIDE + 1, len(steps))
    around = np.setdiff1d(np.arange(first, last), jumps)
    return float(np.mean(steps[around])) if len(around) else 0.0


def unwrapped(values: FloatArray, period: float) -> FloatArray:
    """The angle that goes on; what is not finite stays so."""
    found = values.copy()
    finite = np.isfinite(values)
    found[finite] = np.unwrap(values[finite], period=period)
    return found
