"""Piecewise polynomials of one variable: tables in laws, of any length, as one node."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.expression.node import Expression, Value, as_node, choose
from hdrive_mbs.expression.use import in_order, rebuilt

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Pieces:
    """sum_k c[i, k] (x - start[i])^k  in piece i, which reaches from breaks[i-1] to below breaks[i].

    breaks : (n - 1,), rising
    starts : (n,)
    coefficients : (n, order + 1)
    """

    breaks: FloatArray
    starts: FloatArray
    coefficients: FloatArray

    def __call__(self, x: Value) -> Value:
        """The value at numbers or arrays; a node of an expression."""
        if isinstance(x, Expression):
            return Expression("pieces", (x,), self)
        piece = np.searchsorted(self.breaks, x, side="right")
        passed = x - self.starts[piece]
        value = np.zeros_like(passed)
        for k in reversed(range(self.coefficients.shape[1])):
            value = value * passed + self.coefficients[piece, k]
        return value

    def derivative(self) -> Pieces:
        """The derivative, piece by piece."""
        return self._slopes

    @cached_property
    def _slopes(self) -> Pieces:
        powers = np.arange(1, self.coefficients.shape[1])
        lower = self.coefficients[:, 1:] * powers if len(powers) else np.zeros((len(self.starts), 1))
        return Pieces(self.breaks, self.starts, lower)

    def tree(self, x: Expression) -> Expression:
        """The same as a bisection of branches, whose cost grows with log2 of the pieces."""

        def piece(i: int) -> Expression:
            passed = x - float(self.starts[i])
            *lower, top = (float(c) for c in self.coefficients[i])
            value = as_node(top)
            for coefficient in reversed(lower):
                value = value * passed + coefficient
            return value

        def between(first: int, last: int) -> Expression:
            if first == last:
                return piece(first)
            middle = (first + last) // 2
            return choose(x < float(self.breaks[middle]), between(first, middle), between(middle + 1, last))

        return between(0, len(self.starts) - 1)


def lines_between(xs: Sequence[float] | FloatArray, ys: Sequence[float] | FloatArray, left: float, right: float) -> Pieces:
    """np.interp as pieces: straight lines between the points, constants before and after.

    Two values at one point make a step.
    """
    x, y = np.asarray(xs, float), np.asarray(ys, float)
    wide = np.flatnonzero(np.diff(x) > 0.0)
    slopes = np.diff(y)[wide] / np.diff(x)[wide]
    constants = np.concatenate(([left], y[wide], [right]))
    # np.interp gives the last value at the last point and ``right`` only beyond it
    end = np.nextafter(x[-1], np.inf)
    last = [y[-1]] if right != y[-1] else []
    breaks = np.concatenate(([x[0]], x[wide[1:]], [x[-1]], [end] * len(last)))
    if not len(wide):
        breaks = np.concatenate(([x[0]], [end] * len(last)))
    starts = np.concatenate(([x[0]], x[wide], [x[-1]] * (1 + len(last))))
    constants = np.concatenate(([left], y[wide], last, [right]))
    slopes = np.concatenate(([0.0], slopes, [0.0] * (1 + len(last))))
    return Pieces(breaks, starts, np.column_stack((constants, slopes)))


def unfold(*expressions: Expression) -> list[Expression]:
    """The expressions with every table as a bisection of branches."""
    known: dict[int, Expression] = {}
    for node in in_order(*expressions):
        arguments = tuple(known[id(item)] for item in node.arguments)
        if node.operation == "pieces":
            known[id(node)] = node.data.tree(arguments[0])
        elif all(new is old for new, old in zip(arguments, node.arguments)):
            known[id(node)] = node
        else:
            known[id(node)] = rebuilt(node, arguments)
    return [known[id(expression)] for expression in expressions]
