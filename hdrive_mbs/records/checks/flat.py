"""Sensors that stand still: constant, stuck or saturated.

Whether a flat stretch is a fault depends on what a channel is.  A command of straight pieces may rest
at its extremes, and an encoder at rest shows one number; so "saturated" needs a signal that would have
gone on well beyond the extreme, and "stuck" one that either was noisy before or follows another channel that
moves on.  A channel that is constant from end to end may be right and is only reported.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from hdrive_mbs.records.finding import Finding
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.signals import FloatArray

if TYPE_CHECKING:
    from hdrive_mbs.records.record import Record

LONGEST_USUAL = 10.0
"""A stuck stretch is that many times longer than the 99 % of the other stretches of one value."""

STUCK_SAMPLES, STUCK_SHARE = 50, 0.05
"""Least length of a stuck stretch: samples, and share of the record."""

FOLLOWS = 0.9
"""Correlation of the increments of two channels from which one tells what the other should do."""

SHOULD_MOVE = 0.05
"""Share of its range by which a stuck channel should have moved according to another one."""

CLIPPED_SAMPLES, CLIPPED_SHARE = 5, 0.002
"""Least length of a flat top, and share of the record on flat tops."""

LONGER = 3.0
"""A flat top is that many times longer than 95 % of the stretches of one value below it."""

CUT_SHARE, CUT_STEPS = 0.01, 6.0
"""Least height that a flat top cuts off: share of the range, and steps of rounding."""


CLEAR_MOVE = 40.0
"""Multiple of the noise by which a signal must move before a flat top for its slope there to be known to 20 %."""

AT_SPEED = 0.6
"""Slope at the edge of a flat top, as a share of that of the chord, from which the signal was cut off."""


def flat_channels(record: Record) -> Iterator[Finding]:
    """Constant, stuck and saturated channels."""
    if len(record) < 2 * STUCK_SAMPLES or not np.all(np.diff(record.times) > 0.0):
        return
    for channel in record:
        if not np.all(np.isfinite(channel.values)):
            continue
        if np.ptp(channel.values) == 0.0:
            yield Finding(
                kind="constant",
                channel=channel.name,
                where="",
                text=f"constant at {channel.values[0]:.6g} {channel.unit} over the whole record: it excites nothing and shows nothing",
            )
        else:
            runs = _runs(channel.values)
            yield from _stuck(record, channel, *runs)
            yield from _saturated(record, channel, *runs)


def _runs(values: FloatArray) -> tuple[np.ndarray, np.ndarray]:
    """Starts and lengths of the stretches of one value."""
    starts = np.concatenate(([0], np.flatnonzero(np.diff(values)) + 1))
    return starts, np.diff(np.concatenate((starts, [len(values)])))


def _stuck(record: Record, channel: Measurement, starts: np.ndarray, lengths: np.ndarray) -> Iterator[Finding]:
    longest = int(np.argmax(lengths))
    length = int(lengths[longest])
    others = np.delete(lengths, longest)
    if length < max(STUCK_SAMPLES, STUCK_SHARE * len(record)) or not len(others) or length < LONGEST_USUAL * np.percentile(others, 99):
        return
    begin = int(starts[longest])
    if _straight(np.concatenate((channel.values[:begin], channel.values[begin + length :]))):
        return
    inside = slice(begin, begin + length)
    outside = np.ones(len(record), dtype=bool)
    outside[inside] = False
    reason = ""
    near = 4 * STUCK_SAMPLES
    if _noisy(channel.values[max(0, begin - near) : begin]) or _noisy(channel.values[begin + length : begin + length + near]):
        reason = "its noise is gone"
    else:
        for other in record:
            if other.name != channel.name and _should_move(channel.values, other.values, inside, outside):
                reason = f"{other.name}, which it follows elsewhere, moves on"
                break
    if reason:
        yield Finding(
            kind="stuck",
            channel=channel.name,
            where=f"t = {record.times[begin]:.6g} s to {record.times[begin + length - 1]:.6g} s",
            blocks=True,
            text=(
                f"stands at {channel.values[begin]:.6g} {channel.unit} for {length} samples "
                f"from t = {record.times[begin]:.6g} s while {reason}; "
                "stuck='drop' leaves the channel out, stuck='keep' keeps it, record.between(start, end) takes a part without"
            ),
        )


def _noisy(values: FloatArray) -> bool:
    """Whether values scatter by more than one step of rounding, so that they would not stand still at rest.

    Second differences of noise change their sign two times out of three, and have sqrt(6) times its
    standard deviation; rounding alone scatters by 0.29 steps.
    """
    if len(values) < STUCK_SAMPLES:
        return False
    steps = np.diff(values)
    second = np.diff(steps)
    moved = np.abs(steps[steps != 0.0])
    if len(moved) < 0.5 * len(steps):
        return False
    noise = float(np.std(second)) / np.sqrt(6.0)
    return bool(noise > moved.min() and np.mean(second[1:] * second[:-1] < 0.0) > 0.4)


def _should_move(values: FloatArray, other: FloatArray, inside: slice, outside: np.ndarray) -> bool:
    """Whether another channel, by which this one can be told elsewhere, says that this one moves inside."""
    if not np.all(np.isfinite(other)) or np.ptp(other) == 0.0:
        return False
    block = max(1, len(values) // 200)
    edges = np.arange(0, len(values), block)
    whole = np.array([outside[a : a + block + 1].all() for a in edges[:-1]], dtype=bool)
    if whole.sum() < 10:
        return False
    mine, theirs = np.diff(values[edges])[whole], np.diff(other[edges])[whole]
    scale = float(np.sqrt((mine @ mine) * (theirs @ theirs)))
    if scale == 0.0 or abs(float(mine @ theirs)) < FOLLOWS * scale:
        return False
    slope = float(mine @ theirs) / float(theirs @ theirs)
    return bool(abs(slope) * np.ptp(other[inside]) > SHOULD_MOVE * np.ptp(values))


def _straight(values: FloatArray) -> bool:
    """Whether most of what moves lies on straight lines: a command, not a sensor.

    Steps over ten samples that stay alike, to two steps of rounding, over thirty samples and more are a straight
    line; those of a curve drift away however slowly it bends.
    """
    single = np.abs(np.diff(values))
    rounding = float(single[single > 0.0].min(initial=np.inf))
    tolerance = max(2.0 * rounding, 1e-9 * float(np.ptp(values))) if np.isfinite(rounding) else 0.0
    steps = np.diff(values[::10])
    moving = np.abs(steps) > 4.0 * tolerance
    alike = (np.abs(np.diff(steps)) <= tolerance) & moving[1:] & moving[:-1]
    if not len(alike):
        return False
    starts, lengths = _runs(alike.astype(float))
    on_lines = 0
    for start, length in zip(starts.tolist(), lengths.tolist(), strict=True):
        line = steps[start : start + length + 1]
        if alike[start] and length >= 2 and np.ptp(line) <= 2.0 * tolerance:
            on_lines += length + 1
    return bool(on_lines > 0.5 * np.sum(moving))


def _saturated(record: Record, channel: Measurement, starts: np.ndarray, lengths: np.ndarray) -> Iterator[Finding]:
    values = channel.values
    if _straight(values):
        return
    steps = np.abs(np.diff(values))
    rounding = float(steps[steps > 0.0].min())
    least = max(CUT_SHARE * float(np.ptp(values)), CUT_STEPS * rounding)
    for extreme, word in ((values.max(), "largest"), (values.min(), "smallest")):
        top = values[starts] == extreme
        usual = float(np.percentile(lengths[~top], 95)) if np.any(~top) else 0.0
        flat = np.flatnonzero(top & (lengths >= max(CLIPPED_SAMPLES, LONGER * usual)))
        heights = {int(run): _cut_heights(values, int(starts[run]), int(lengths[run])) for run in flat}
        cut = [run for run, both in heights.items() if both.max() > least]
        count = int(lengths[cut].sum()) if cut else 0
        if count >= max(CLIPPED_SAMPLES, CLIPPED_SHARE * len(values)):
            begin = int(starts[cut[0]])
            yield Finding(
                kind="saturated",
                channel=channel.name,
                where=f"t = {record.times[begin]:.6g} s",
                blocks=sum(int(np.sum(heights[run] > 0.0)) for run in cut) > 1,  # one edge may be the start or end of a motion
                text=(
                    f"cut off at its {word} value {extreme:.6g} {channel.unit} in {len(cut)} stretches, {count} samples, "
                    f"first at t = {record.times[begin]:.6g} s; "
                    "saturated='drop' leaves the channel out, saturated='keep' keeps it (right for a command that is limited)"
                ),
            )


def _cut_heights(values: FloatArray, begin: int, length: int) -> FloatArray:
    """How far the signal would have gone on with the slope that it had at the edge of a flat stretch, at both edges.

    Before (or after) the stretch a parabola is laid through three points: the edge, where the signal is CLEAR_MOVE
    times its noise away from it, and half-way.  Of a signal that was cut off the slope at the edge is that of
    the chord; of one that comes to rest there it is 0; of the rounded top of a maximum it is well below.
    It goes on with that slope for a quarter of the stretch, as a parabola with both its edges does.
    """
    heights = np.zeros(2)
    longest = len(values) // 10
    for edge, part in enumerate((values[max(0, begin - longest) : begin + 1], values[begin + length - 1 : begin + length + longest][::-1])):
        if len(part) < 5:
            continue
        noise = float(np.std(np.diff(part[-STUCK_SAMPLES:], 2))) / np.sqrt(6.0)
        away = np.abs(part[::-1] - part[-1])
        far = np.flatnonzero(away[4:] > CLEAR_MOVE * noise)
        if not len(far):
            continue
        reach = (int(far[0]) + 5) // 2 * 2
        if reach >= len(part):
            continue
        moved, half = float(part[-1] - part[-1 - reach]), float(part[-1] - part[-1 - reach // 2])
        slope = (4.0 * half - moved) / reach
        if abs(slope) * reach > AT_SPEED * abs(moved) and slope * moved > 0.0:
            heights[edge] = abs(slope) * min(length / 4.0, reach)
    return heights
