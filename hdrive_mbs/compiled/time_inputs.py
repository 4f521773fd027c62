"""Parts of equations that are known before a run: tables of time, read once for all steps and all lines that share them."""

from __future__ import annotations

import hashlib
import threading
from collections import OrderedDict
from collections.abc import Hashable
from dataclasses import dataclass, field
from weakref import WeakKeyDictionary, WeakValueDictionary

import numpy as np
import numpy.typing as npt

from hdrive_mbs.expression import Expression, Pieces, evaluate, in_order
from hdrive_mbs.tracked import plain

FloatArray = npt.NDArray[np.float64]

KEPT_BYTES = 48_000_000
"""Memory for columns that are kept for later runs; what was let go is read again in milliseconds."""

_kept: OrderedDict[Hashable, FloatArray] = OrderedDict()
_keeping = threading.RLock()
_digests: WeakKeyDictionary[Pieces, bytes] = WeakKeyDictionary()
_alive: WeakValueDictionary[Hashable, TimeInput] = WeakValueDictionary()


@dataclass(frozen=True)
class Grid:
    """The times of a Runge-Kutta run: samples, and between two of them 2 * inner half steps.

    Sample s is at start + every s exactly, whatever stands between.
    """

    start: float
    every: float
    inner: int
    first: int
    samples: int

    def times(self) -> FloatArray:
        """From sample ``first`` to one sample after the last, shape (2 inner samples + 1,)."""
        points = self.start + self.every * np.arange(self.first, self.first + self.samples + 1)
        between = np.arange(2 * self.inner) * (0.5 * self.every / self.inner)
        return np.append((points[:-1, None] + between).ravel(), points[-1])


@dataclass(frozen=True)
class TimeInput:
    """An expression of time alone; equal ones have the same content."""

    content: Hashable
    expression: Expression = field(compare=False)

    def column(self, grid: Grid) -> FloatArray:
        """Its values at the times of a grid; not to be changed."""
        with _keeping:
            return _column((self.content, grid), self.expression, grid)


def time_input(expression: Expression) -> TimeInput:
    """An expression of time (or the time itself) with its content: operations, numbers and tables.

    While one of the same content is in use it is that one, so that many lines of one record hold its tables once.
    """
    number: dict[int, int] = {}
    content = []
    for node in in_order(expression):
        data = digest(node.data) if node.operation == "pieces" else plain(node.data)
        content.append((node.operation, data, *(number[id(item)] for item in node.arguments)))
        number[id(node)] = len(number)
    found = TimeInput(tuple(content), expression)
    return _alive.setdefault(found.content, found)


def _column(key: Hashable, expression: Expression, grid: Grid) -> FloatArray:
    if key in _kept:
        _kept.move_to_end(key)
        return _kept[key]
    times = grid.times() if expression.operation == "variable" else _column((TIME.content, grid), TIME.expression, grid)
    values = times
    if expression.operation != "variable":
        with np.errstate(all="ignore"):
            values = np.ascontiguousarray(np.broadcast_to(evaluate(expression, {"t": times}), times.shape), float)
    _kept[key] = values
    while len(_kept) > 1 and sum(item.nbytes for item in _kept.values()) > KEPT_BYTES:
        _kept.popitem(last=False)
    return values


def forget() -> None:
    """Let go of the columns that are kept for later runs."""
    with _keeping:
        _kept.clear()


def digest(pieces: Pieces) -> bytes:
    """What tells tables of different content apart."""
    if pieces not in _digests:
        found = hashlib.blake2b(digest_size=16)
        for array in (pieces.breaks, pieces.starts, pieces.coefficients):
            found.update(np.int64(array.size).tobytes())
            found.update(np.ascontiguousarray(array, float).tobytes())
        _digests[pieces] = found.digest()
    return _digests[pieces]


TIME = time_input(Expression("variable", (), "t"))
"""The time itself."""
