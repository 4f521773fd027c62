"""Numbers that have to do with each other."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt


def groups(joined: npt.NDArray[np.bool_]) -> Sequence[Sequence[int]]:
    """Groups of rows and columns of a square matrix that are joined by its entries, those with no entry left out."""
    return _groups(len(joined), joined.tobytes())


@lru_cache(maxsize=1024)
def _groups(size: int, entries: bytes) -> tuple[tuple[int, ...], ...]:
    joined = np.frombuffer(entries, bool).reshape(size, size)
    owner = list(range(size))

    def root(k: int) -> int:
        while owner[k] != k:
            k = owner[k]
        return k

    pairs = np.argwhere(joined).tolist()
    for i, j in pairs:
        a, b = root(i), root(j)
        owner[max(a, b)] = min(a, b)
    found: dict[int, list[int]] = {}
    for k in sorted({k for pair in pairs for k in pair}):
        found.setdefault(root(k), []).append(k)
    return tuple(tuple(members) for members in found.values())
