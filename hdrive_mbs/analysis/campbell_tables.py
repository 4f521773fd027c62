"""Tables that both Campbell diagrams print."""

from __future__ import annotations

from collections.abc import Sequence

from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.signals import FloatArray

ROUNDING = 1e-9
"""A damping ratio below this is printed as 0."""

NONE_MET = PrintedTable(heads=(), rows=(), notes=("no critical speed in this range",))
"""In place of the critical speeds where there are none."""


def branch_table(speeds: FloatArray, frequencies: FloatArray, ratios: FloatArray, kind: str, whirl: Sequence[str] = ()) -> PrintedTable:
    """Frequency and damping ratio of each branch at the first and the last speed.

    frequencies : rad/s, (s, b);  ratios : (s, b);  kind : "damped" or "undamped";  whirl : of each branch, if it has one
    """
    heads = ["mode", *(["whirl"] if whirl else [])]
    for speed in (speeds[0], speeds[-1]):
        heads += [f"at {speed:g} rad/s: {kind} [rad/s]", "damping ratio"]
    rows = []
    for k in range(frequencies.shape[1]):
        numbers = [value for row in (0, -1) for value in (float(frequencies[row, k]), unrounded(float(ratios[row, k])))]
        rows.append((str(k + 1), *whirl[k : k + 1], *numbers))
    return PrintedTable(title="branches", heads=tuple(heads), rows=tuple(rows))


def unrounded(ratio: float) -> float:
    """A damping ratio, 0 where it is rounding."""
    return 0.0 if abs(ratio) < ROUNDING else ratio
