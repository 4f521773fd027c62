"""Which columns of a file share a time, and the times themselves."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from hdrive_mbs.errors import ParameterError, UnitError, unknown_place
from hdrive_mbs.records.formats.file_format import Column, Contents, check_width, is_time
from hdrive_mbs.records.request import Request
from hdrive_mbs.records.si_units import conversion


@dataclass(frozen=True, kw_only=True, eq=False)
class Clock:
    """The time of some channels: a column, or an even step."""

    label: str
    length: int
    column: Column | None = None
    step: float = 0.0

    def times(self, request: Request) -> tuple[np.ndarray, float, tuple[str, ...]]:
        """Times [s], what the clock showed at time 0 [s], and notes."""
        if self.column is None:
            return self.step * np.arange(self.length), 0.0, (f"the file holds no time; an even step of {self.step:.6g} s was given",)
        unit = request.unit(self.column.name, self.column.unit)
        if unit is None:
            raise UnitError(f"{request.path}: the time {self.column.name!r} has no unit; give it with units={{{self.column.name!r}: 's'}}.")
        where = f"{request.path}, time {self.column.name!r}"
        scale = conversion(unit, where)
        if scale.unit != "s":
            raise UnitError(
                f"{where}: unit {unit!r} is no unit of time; "
                f"give the right one with units={{{self.column.name!r}: 's'}}, or another column with time='...'."
            )
        values = self.column.values
        start = values[0]
        if np.isfinite(start) and abs(float(start)) * scale.factor > 1e6:  # a clock since 1970, say: keep its digits
            times = np.asarray((values - start) * scale.factor, dtype=np.float64)
            origin = float(start) * scale.factor
            return times, origin, (f"times count from the first sample, at which the clock showed {origin:.9g} s",)
        return np.asarray(values * scale.factor, dtype=np.float64), 0.0, ()


def by_clock(request: Request, contents: Contents) -> tuple[list[tuple[Clock, list[Column]]], list[str]]:
    """Channels by the time that they share, and names of columns without one."""
    columns = contents.columns
    if isinstance(request.time, str) and not any(column.name == request.time for column in columns):
        step = _step(request, columns)
    elif isinstance(request.time, str) or request.time is None:
        step = None
    else:
        step = float(request.time)
    if step is not None:
        if not (np.isfinite(step) and step > 0.0):
            raise ParameterError(f"{request.path}: time = {step:g} s must be greater than 0 s: the step of an even sampling.")
        return _even_clocks(request, columns, step)
    clocks = [
        column
        for column in columns
        if column.values.ndim == 1 and (column.name == request.time if request.time else column.clock or is_time(column.name))
    ]
    members: dict[int, list[Column]] = {}
    left: list[str] = []
    for column in columns:
        if any(column is clock for clock in clocks):
            continue
        clock = _nearest(column, clocks, anywhere=request.time is not None)
        if clock is None:
            left.append(column.name)
        else:
            members.setdefault(clock, []).extend(flattened(request.path, column, len(clocks[clock].values)))
    return [
        (Clock(label=_label(clocks[index]), length=len(clocks[index].values), column=clocks[index]), found)
        for index, found in members.items()
    ], left


def _label(clock: Column) -> str:
    return ".".join(clock.group) or clock.name


def _step(request: Request, columns: Sequence[Column]) -> float:
    """A step or rate that was given as text, like "0.2 ms" or "5 kHz"; else PlaceError for a column that does not exist."""
    assert isinstance(request.time, str)
    if re.match(r"\s*[+-]?[\d.]", request.time):
        where = f"{request.path}, time = {request.time!r}"
        given = conversion(request.time, where)
        if given.unit not in ("s", "Hz"):
            raise UnitError(f"{where}: the step of an even sampling is in s, or its rate in Hz.")
        return given.factor if given.unit == "s" else 1.0 / given.factor
    raise unknown_place("time column", request.time, [column.name for column in columns][:60], str(request.path))


def _even_clocks(request: Request, columns: Sequence[Column], step: float) -> tuple[list[tuple[Clock, list[Column]]], list[str]]:
    """One clock for each length; a matrix counts along its longer side."""
    members: dict[int, list[Column]] = {}
    for column in columns:
        length = max(column.values.shape)
        members.setdefault(length, []).extend(flattened(request.path, column, length))
    return [(Clock(label=f"{length} samples", length=length, step=step), found) for length, found in members.items()], []


def _nearest(column: Column, clocks: Sequence[Column], anywhere: bool) -> int | None:
    """The time in the column's own group, or in the nearest group around it, of one of its lengths."""
    fitting = [index for index, clock in enumerate(clocks) if len(clock.values) in column.values.shape]
    around = [index for index in fitting if anywhere or clocks[index].group == column.group[: len(clocks[index].group)]]
    return max(around, key=lambda index: (len(clocks[index].group), clocks[index].clock, -index), default=None)


def flattened(path: Path, column: Column, length: int) -> list[Column]:
    """A matrix as channels ``name[1]``, ``name[2]``, ... of that length."""
    if column.values.ndim == 1:
        return [column]
    rows = column.values if column.values.shape[1] == length else column.values.T
    check_width(path, range(len(rows)))
    return [
        Column(name=f"{column.name}[{index}]", unit=column.unit, values=row, group=column.group) for index, row in enumerate(rows, start=1)
    ]
