"""What a check found in a record, or what a repair did to it."""

from __future__ import annotations

from dataclasses import dataclass

KINDS = {
    "order": "time runs backward",
    "duplicates": "several samples at one time",
    "gaps": "missing samples",
    "uneven": "steps of time that vary",
    "not_finite": "NaN, infinite or unreadable values",
    "wrapped": "an angle that begins again after each turn",
    "units": "channels that contradict each other by a factor",
    "saturated": "flat at an extreme",
    "stuck": "constant while it should move",
    "constant": "one value all along",
    "clock": "two clocks that differ",
    "short": "too few samples",
}
"""Kinds of findings."""


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One fault, repaired or not.

    kind : one of KINDS
    channel : its name; empty for the time of all channels
    where : the stretch of time, in words
    text : what was found, with values and units, and the way out
    blocks : a result from the record would be wrong until somebody decides about it
    repaired : the record at hand has it no longer; the text says what was changed
    """

    kind: str
    channel: str
    where: str
    text: str
    blocks: bool = False
    repaired: bool = False

    def __str__(self) -> str:
        state = "repaired" if self.repaired else "refused" if self.blocks else "reported"
        of = f" {self.channel}" if self.channel else ""
        where = f" ({self.where})" if self.where else ""
        return f"{state}: {self.kind}{of}{where}: {self.text}"
