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


def run_lanes(
    programs: Sequence[Program], width: int, initial: FloatArray, samples: int, every: float, inner: int, start: float
) -> tuple[FloatArray, npt.NDArray[np.int64]]:
    """Readings, shape (readings, width, samples), and for each lane the number of samples up to which it is finite.

    programs : of one structure, at most ``width``; the last one fills lanes that are left
    initial : states at the start, shape (programs, states)
    """
    structure = programs[0].structure
    lanes = [*range(len(programs)), *[len(programs) - 1] * (width - len(programs))]
    state = _side_by_side([initial[lane] for lane in lanes])
    constants = _side_by_side([programs[lane].constants for lane in lanes])
    tables = _tables([programs[lane] for lane in lanes])
    shared = all(program.inputs == programs[0].inputs for program in programs[1:])
    run = machine(structure, width, shared=shared or width == 1).run
    out = np.empty((len(structure.readings), width, samples))
    good = _aligned(width, np.int64)
    good[:] = 0
    block = max(1, BLOCK // (2 * inner))
    for first in range(0, samples, block):
        rows = min(block, samples - first)
        grid = Grid(start, every, inner, first, rows)
        sources = [programs[lanes[0]]] * width if shared else [programs[lane] for lane in lanes]
        columns = [[program.inputs[k].column(grid) for program in sources] for k in range(structure.inputs)]
        addresses = np.array([[column.ctypes.data for column in row] for row in columns], np.int64)
        at = out.ctypes.data + 8 * first
        last = int(first + rows == samples)
        run(
            state.ctypes.data, every / inner, inner, rows, last,
            constants.ctypes.data, tables.ctypes.data, addresses.ctypes.data, good.ctypes.data, at, samples,
        )  # fmt: skip
        if np.max(good) < first + rows:
            break
    return out, good


def _aligned(count: int, kind: type = np.float64) -> npt.NDArray[Any]:
    """Memory on a boundary of 64 bytes, where a vector is loaded in one go."""
    whole = np.empty(8 * count + 64, np.uint8)
    first = -whole.ctypes.data % 64
    return whole[first : first + 8 * count].view(kind)


def _side_by_side(rows: Sequence[FloatArray]) -> FloatArray:
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
