"""Programs of one structure side by side: their numbers in memory, and the runs of all lanes at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.machine import machine
from hdrive_mbs.compiled.program import Program
from hdrive_mbs.compiled.time_inputs import Grid

FloatArray = npt.NDArray[np.float64]

BLOCK = 500_000
"""Half steps whose inputs are held at a time."""


class Lanes:
    """Programs of one structure side by side, ready to run.

    programs : of one structure, at most ``width``; the last one fills lanes that are left
    """

    def __init__(self, programs: Sequence[Program], width: int) -> None:
        filled = [*programs, *[programs[-1]] * (width - len(programs))]
        self.width, self.structure = width, programs[0].structure
        self.shared = all(program.inputs == programs[0].inputs for program in programs[1:])
        self._sources = [programs[0]] * width if self.shared else filled
        self._constants = side_by_side([program.constants for program in filled])
        self._tables = _tables(filled)
        self._grid: Grid | None = None
        self._kept: list[list[FloatArray]] = []
        self._run = machine(self.structure, width, shared=self.shared or width == 1).run

    def state(self, initial: FloatArray) -> FloatArray:
        """Memory for the states of all lanes from those of the programs, shape (programs, states)."""
        return side_by_side([*initial, *[initial[-1]] * (self.width - len(initial))])

    def run(self, state: FloatArray, grid: Grid, out: FloatArray, good: npt.NDArray[np.int64], *, last: bool) -> None:
        """Move the states through the samples of a grid, and past the last one unless it is the last of all.

        out : readings, shape (readings, width, samples), of which those of the grid are written
        good : for each lane the number of finite samples, counted on
        """
        addresses = self._addresses(grid)
        self._run(
            state.ctypes.data, grid.every / grid.inner, grid.inner, grid.samples, int(last), self._constants.ctypes.data,
            self._tables.ctypes.data, addresses.ctypes.data, good.ctypes.data, out.ctypes.data + 8 * grid.first, out.shape[2],
        )  # fmt: skip

    def _addresses(self, grid: Grid) -> npt.NDArray[np.int64]:
        """Where the inputs at the times of a grid lie."""
        if grid != self._grid:
            columns = [[program.inputs[k].column(grid) for program in self._sources] for k in range(self.structure.inputs)]
            self._grid, self._kept = grid, columns
            self._at = np.array([[column.ctypes.data for column in row] for row in columns], np.int64)
        return self._at

    def forget(self) -> None:
        """Let go of the inputs at the times of the last grid."""
        self._grid, self._kept = None, []

    def counted(self) -> npt.NDArray[np.int64]:
        """Memory for the number of finite samples of each lane, none yet."""
        good = _aligned(self.width, np.int64)
        good[:] = 0
        return good


def run_lanes(
    lanes: Lanes, initial: FloatArray, samples: int, every: float, inner: int, start: float
) -> tuple[FloatArray, npt.NDArray[np.int64]]:
    """Readings, shape (readings, width, samples), and for each lane the number of samples up to which it is finite.

    initial : states at the start, shape (programs, states)
    """
    state, good = lanes.state(initial), lanes.counted()
    out = np.empty((len(lanes.structure.readings), lanes.width, samples))
    block = max(1, BLOCK // (2 * inner))
    for first in range(0, samples, block):
        rows = min(block, samples - first)
        lanes.run(state, Grid(start, every, inner, first, rows), out, good, last=first + rows == samples)
        if np.max(good) < first + rows:
            break
    lanes.forget()
    return out, good


def _aligned(count: int, kind: type = np.float64) -> npt.NDArray[Any]:
    """Memory on a boundary of 64 bytes, where a vector is loaded in one go."""
    whole = np.empty(8 * count + 64, np.uint8)
    first = -whole.ctypes.data % 64
    return whole[first : first + 8 * count].view(kind)


def side_by_side(rows: Sequence[FloatArray]) -> FloatArray:
    """Number 0 of every lane, number 1 of every lane, ..."""
    made = _aligned(max(1, len(rows[0])) * len(rows))
    made[: len(rows[0]) * len(rows)].reshape(-1, len(rows))[:] = np.column_stack(rows) if len(rows) > 1 else rows[0][:, None]
    return made


def _tables(programs: Sequence[Program]) -> npt.NDArray[np.int64]:
    """For each table where it lies in every lane, then its pieces in every lane."""
    structure = programs[0].structure
    made = _aligned(2 * max(1, structure.tables) * len(programs), np.int64)
    for k in range(structure.tables):
        row = made[2 * k * len(programs) :]
        for lane, program in enumerate(programs):
            row[lane] = program.tables[k].values.ctypes.data
            row[len(programs) + lane] = program.tables[k].pieces
    return made
