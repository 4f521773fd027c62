"""How much memory a file may unfold to: a few bytes can claim any size."""

from __future__ import annotations

import os
from pathlib import Path

from hdrive_mbs.errors import FileFormatError

UNKNOWN = 2**32
"""Bytes, where the machine does not say how much memory it has."""


def largest() -> int:
    """Half of this machine's memory [byte]."""
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
    except (AttributeError, OSError, ValueError):
        return UNKNOWN


def check_claim(path: str | os.PathLike[str], claimed: int, way_out: str = "") -> None:
    """Refuse a file whose numbers would fill the memory.  Raises FileFormatError."""
    if claimed > largest():
        size = Path(path).stat().st_size / 2**20
        raise FileFormatError(
            f"{path} has {size:.3g} MiB and claims to hold {claimed / 2**30:.3g} GiB of numbers, more than half of this machine's memory."
            f"{f' {way_out}' if way_out else ''}"
        )
