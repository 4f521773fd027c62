"""Times: in order, each once, none missing, even."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hdrive_mbs.records.finding import Finding

if TYPE_CHECKING:
    from hdrive_mbs.records.record import Record

MISSING = 1.5
"""A step of that many usual steps lacks a sample."""

SCATTERED = 0.2
"""Where a larger share of the steps would be gaps, the sampling is uneven by nature."""

JITTER = 0.02
"""Rms deviation of the steps, in usual steps, from which it is reported."""

READABLE = 1e9
"""Number of missing samples up to which all digits are told; a damaged time can be any number, up to infinitely many steps away."""

SHORTEST = 16
"""Samples below which no check or fit says anything."""


def uneven_times(record: Record) -> Iterator[Finding]:
    """Findings on the times of all channels."""
    times, step = record.times, record.step
    if len(times) < SHORTEST:
        yield Finding(
            kind="short",
            channel="",
            where="",
            blocks=len(times) < 2,
            text=f"{len(times)} samples are too few to check or fit anything; record longer",
        )
    finite = np.isfinite(times)
    if not finite.all():
        yield Finding(
            kind="not_finite",
            channel="",
            where=f"sample {int(np.argmin(finite)) + 1}",
            blocks=True,
            text=f"{int((~finite).sum())} times are no numbers; not_finite='drop' leaves these samples out",
        )
        times = times[finite]
    steps = np.diff(times)
    back = steps < 0.0
    if back.any():
        first = int(np.argmax(back))
        yield Finding(
            kind="order",
            channel="",
            where=f"t = {times[first]:.6g} s",
            blocks=True,
            text=(
                f"time runs backward {int(back.sum())} times, first from {times[first]:.9g} s to {times[first + 1]:.9g} s; "
                "order='sort' puts the samples in order (right only if they were written out of order, not if the clock was set back)"
            ),
        )
        times = np.sort(times)
    same = np.diff(times) == 0.0
    if same.any():
        yield _duplicates(times, same)
        times = np.unique(times)
    if np.isfinite(step):
        yield from _steps(times, np.diff(times), step)


def _duplicates(times: np.ndarray, same: np.ndarray) -> Finding:
    first = int(np.argmax(same))
    coarse = ""
    if same.mean() > 0.2:
        even = (times[-1] - times[0]) / (len(times) - 1)
        coarse = ". So many look like a time that was written with too few digits; if the sampling is even, "
        coarse += f"read with time={even:.6g} (step in s)"
    return Finding(
        kind="duplicates",
        channel="",
        where=f"t = {times[first]:.6g} s",
        blocks=True,
        text=(
            f"{int(same.sum())} samples have the time of the one before, first at {times[first]:.9g} s; "
            f"duplicates='first' or 'mean' leaves one{coarse}"
        ),
    )


def _steps(times: np.ndarray, steps: np.ndarray, step: float) -> Iterator[Finding]:
    long = steps > MISSING * step
    if long.any() and long.mean() <= SCATTERED:
        missing = float(np.sum(np.round(steps[long] / step) - 1.0))
        told = f"{missing:.0f}" if missing < READABLE else f"{missing:.3g}"
        worst = int(np.argmax(steps))
        start = float(times[worst])
        yield Finding(
            kind="gaps",
            channel="",
            where=f"t = {start:.6g} s to {start + steps[worst]:.6g} s",
            blocks=True,
            text=(
                f"{int(long.sum())} gaps, {told} samples missing, the longest {steps[worst]:.6g} s from t = {start:.6g} s "
                f"(usual step {step:.6g} s); gaps='interpolate' fills short ones with straight lines, gaps='keep' leaves the samples "
                "as they are, record.between(start, end) takes a part without"
            ),
        )
    usual = steps if long.mean() > SCATTERED else steps[~long]
    jitter = float(np.sqrt(np.mean((usual / step - 1.0) ** 2))) if len(usual) else 0.0
    if jitter > JITTER:
        yield Finding(
            kind="uneven",
            channel="",
            where="",
            text=(
                f"steps vary by {100.0 * jitter:.3g} % rms about {step:.6g} s ({usual.min():.6g} s to {usual.max():.6g} s); "
                f"record.resampled({step:.6g}) makes them even"
            ),
        )
