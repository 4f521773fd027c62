"""Numbers that have to do with each other."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def groups(joined: npt.NDArray[np.bool_]) -> list[list[int]]:
    """Groups of rows and columns of a square matrix that are joined by its entries, those with no entry left out."""
    owner = list(range(len(joined)))

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
    return list(found.values())
