"""How many threads runs of machine code may take: more than one where a process has cores of others to itself.

What they compute does not depend on it: each group of lanes is run by one thread, as it would be alone.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
Answer = TypeVar("Answer")


def _one() -> int:
    return 1


_count: Callable[[], int] = _one


def at_hand() -> int:
    """Threads that runs may take now."""
    return _count()


@contextlib.contextmanager
def allowed(count: Callable[[], int]) -> Iterator[None]:
    """Within the block runs take so many threads; it is asked anew at each of them."""
    global _count
    before, _count = _count, count
    try:
        yield
    finally:
        _count = before


def side_by_side(function: Callable[[Item], Answer], items: Sequence[Item]) -> list[Answer]:
    """function(item) of each item, in order, in as many threads as are allowed."""
    threads = min(at_hand(), len(items))
    if threads < 2:
        return [function(item) for item in items]
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(function, items))
