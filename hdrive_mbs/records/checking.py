"""All checks of a record."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from hdrive_mbs.records.checks.clocks import second_clocks
from hdrive_mbs.records.checks.flat import flat_channels
from hdrive_mbs.records.checks.numbers import not_finite
from hdrive_mbs.records.checks.times import uneven_times
from hdrive_mbs.records.checks.units import contradicting_units
from hdrive_mbs.records.checks.wrapped import wrapped_angles
from hdrive_mbs.records.finding import Finding

if TYPE_CHECKING:
    from hdrive_mbs.records.record import Record

CHECKS = (uneven_times, not_finite, wrapped_angles, contradicting_units, second_clocks, flat_channels)
"""In the order in which their findings are listed."""


def check(record: Record) -> tuple[Finding, ...]:
    """Everything that the checks find; nothing is changed."""
    with np.errstate(over="ignore", invalid="ignore"):  # numbers of a damaged file may be of any size, or infinite
        return tuple(finding for one in CHECKS for finding in one(record))
