"""Memory that is free again, given back to the system."""

from __future__ import annotations

import ctypes
import gc


def give_back() -> None:
    """Free what only refers to itself, and hand back what the C library keeps of freed memory for later, where it can be told to (glibc).

    glibc keeps arrays of up to 32 MB that were freed below one that is still in use: after a localisation on a rotor line many of
    its arrays.
    """
    gc.collect()
    trim()


def trim() -> None:
    """Hand back what the C library keeps of freed memory, without a search for garbage, which takes longer."""
    try:
        give = ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):
        return
    give(ctypes.c_size_t(0))
