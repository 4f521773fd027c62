"""What a law leaves that is nearly right: a law never is what the machine does."""

from __future__ import annotations

SMALL = 0.03
"""Of the logarithm of the nominal model's mean square: left by a law that is nearly right beside a cause that is strong.  Of the practice
cases, rotor-p03 leaves 1.2 to 1.5 of 4,100 with the right law at the right place, another plant's clearance."""


def nearly_right(gap: float) -> float:
    """Mean square that a law which is nearly right may leave of a gap.

    gap : mean square that the refitted nominal model leaves
    """
    return float(max(gap, 1.0) ** SMALL)
