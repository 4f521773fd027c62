"""Compiles functions of a plant with numba, with a cache that no edit can make stale.

Numba's own cache looks at the file of a function only and misses a change in what it calls.  Here the
cache folder carries a digest of every source file beside the function.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba


@cache
def _cache_folder(home: Path) -> str | None:
    """Folder for compiled code of these sources, or None where nothing can be written."""
    digest = hashlib.sha256()
    for source in [Path(__file__), *sorted(home.glob("*.py"))]:
        digest.update(source.name.encode() + source.read_bytes())
    folder = home / "__pycache__" / f"compiled-{digest.hexdigest()[:12]}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return str(folder) if os.access(folder, os.W_OK) else None


def compiled(function: Callable[..., Any]) -> Callable[..., Any]:
    """The function as machine code; divisions follow IEEE rules.

    Hand small tuples of numbers to laws: arrays inside a tuple cost a reference count at every call.
    """
    folder = _cache_folder(Path(function.__code__.co_filename).parent)
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = folder or before
    try:
        return numba.njit(cache=folder is not None, error_model="numpy")(function)  # type: ignore[no-any-return]
    finally:
        numba.config.CACHE_DIR = before
