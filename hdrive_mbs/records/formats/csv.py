"""CSV and other text tables: delimiter, decimal comma, header and unit line are found, not asked for."""

from __future__ import annotations

import codecs
import csv
import io
import re
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.records.formats.file_format import Column, Contents, Format, Wanted, broken, check_width, named_unit
from hdrive_mbs.records.si_units import is_unit

DELIMITERS = ("\t", ";", ",", "|", " ")
"""In the order in which they are believed."""

COMMENTS = ("#", "%")
LOOKED_AT = 200
"""Lines from which the layout is found."""

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?")
_COMMA_NUMBER = re.compile(r"[+-]?(?:\d+,?\d*|,\d+)(?:[eEdD][+-]?\d+)?")
_MISSING = {"", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "---", "inf", "-inf", "+inf", "infinity", "-infinity"}
_DATE = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(?::\d\d(?:[.,]\d{1,9})?)?Z?")


def read(path: Path, wanted: Wanted) -> Contents:
    """All columns of a text table.

    Lines before the header and lines that begin with # or % are left out.  The header is the line before
    the first line of numbers (or the two lines before it, where the second one holds units; a comment
    where there is no other).  A cell of a
    column of numbers that is no number becomes NaN and is told of.
    """
    text, notes = _decoded(path)
    remarks, lines = _lines(text)
    if not lines:
        raise FileFormatError(f"{path} holds no line of a table.")
    delimiter, comma = _layout(path, lines)
    try:
        rows = _rows(lines, delimiter)
        first, width = _first_data_row(path, rows[:LOOKED_AT], comma)
    except csv.Error as error:
        raise broken(path, "text table", error) from error
    headings, units = _header([*_rows(remarks, delimiter)[-1:], *rows[:first]], width)
    data = rows[first:]
    ragged = [number for number, row in enumerate(data) if len(row) != width]
    if ragged and not (len(ragged) == 1 and ragged[0] == len(data) - 1):
        row = data[ragged[0]]
        raise FileFormatError(
            f"{path}: line {ragged[0] + 1} of the data has {len(row)} fields, the first one has {width}: {delimiter.join(row)[:60]!r}. "
            "Is the decimal sign the same as the delimiter?"
        )
    if ragged:
        data = data[:-1]
        notes.append("the last line is cut off and was left out")
    if not headings:
        headings = [f"column_{index + 1}" for index in range(width)]
        notes.append(f"the table has no header; its columns are named {headings[0]} to {headings[-1]}")
    check_width(path, headings)
    return _contents(headings, units, data, comma, notes, wanted)


def _decoded(path: Path) -> tuple[str, list[str]]:
    raw = path.read_bytes()
    for mark, encoding in ((codecs.BOM_UTF8, "utf-8-sig"), (codecs.BOM_UTF16_LE, "utf-16"), (codecs.BOM_UTF16_BE, "utf-16")):
        if raw.startswith(mark):
            try:
                return raw.decode(encoding), []
            except UnicodeDecodeError as error:
                raise broken(path, "text", error) from error
    if b"\0" in raw[:4096]:
        raise FileFormatError(f"{path} is no text: it holds zero bytes.")
    try:
        return raw.decode("utf-8"), []
    except UnicodeDecodeError:
        return raw.decode("latin-1"), ["the text is no UTF-8 and was read as Latin-1"]


def _lines(text: str) -> tuple[list[str], list[str]]:
    """Comment lines before the table (without their sign), and the lines of the table."""
    remarks: list[str] = []
    lines: list[str] = []
    for line in text.splitlines():
        bare = line.strip()
        if bare.startswith(COMMENTS):
            if not lines:
                remarks.append(bare.lstrip("#% "))
        elif bare:
            lines.append(line)
    return remarks, lines


def _rows(lines: Sequence[str], delimiter: str) -> list[list[str]]:
    if delimiter == " ":
        return [line.split() for line in lines]
    rows = csv.reader(io.StringIO("\n".join(lines)), delimiter=delimiter, strict=True)
    return [[cell.strip() for cell in row] for row in rows if row]


def _layout(path: Path, lines: Sequence[str]) -> tuple[str, bool]:
    """Delimiter and whether the decimal sign is a comma: what makes most cells of the last lines numbers."""
    sample = lines[:LOOKED_AT]
    best: tuple[float, str, bool] | None = None
    for delimiter in DELIMITERS:
        try:
            rows = _rows(sample, delimiter)
        except csv.Error:
            continue
        for comma in (False, True):
            if comma and delimiter == ",":
                continue
            score = _score(rows, comma)
            if best is None or score > best[0] + 1e-9:
                best = (score, delimiter, comma)
    if best is None or best[0] == 0.0:
        raise FileFormatError(f"{path} holds no table of numbers: no delimiter of tab ; , | or space gives lines of equally many numbers.")
    return best[1], best[2]


def _score(rows: Sequence[Sequence[str]], comma: bool) -> float:
    """Share of cells that are numbers in the lines of the most common width from 1; wider is better."""
    widths = [len(row) for row in rows if _is_data(row, comma)]
    if not widths:
        return 0.0
    width = max(set(widths), key=widths.count)
    alike = [row for row in rows if len(row) == width and _is_data(row, comma)]
    numbers = sum(_number(cell, comma) or bool(_DATE.fullmatch(cell)) for row in alike for cell in row)
    return numbers / (len(alike) * width) * len(alike) / len(rows) * (1.0 if width > 1 else 0.5)


def _number(cell: str, comma: bool) -> bool:
    return (_COMMA_NUMBER if comma else _NUMBER).fullmatch(cell) is not None


def _is_data(row: Sequence[str], comma: bool) -> bool:
    """At least half of the cells are numbers, dates or signs for a missing value, and one is a number."""
    numbers = sum(_number(cell, comma) for cell in row)
    others = sum(cell.lower() in _MISSING or _DATE.fullmatch(cell) is not None for cell in row)
    return numbers >= 1 and 2 * (numbers + others) >= len(row)


def _first_data_row(path: Path, rows: Sequence[Sequence[str]], comma: bool) -> tuple[int, int]:
    widths = [len(row) for row in rows if _is_data(row, comma)]
    width = max(set(widths), key=widths.count) if widths else 0
    for index, row in enumerate(rows):
        if len(row) == width and _is_data(row, comma):
            return index, width
    raise FileFormatError(f"{path} holds no line of numbers in its first {LOOKED_AT} lines.")


def _header(before: Sequence[Sequence[str]], width: int) -> tuple[list[str], list[str | None]]:
    """Names and units from the lines before the numbers."""
    fitting: list[Sequence[str]] = []
    for row in reversed(before):
        if len(row) != width:
            break
        fitting.insert(0, row)
    if not fitting:
        return [], [None] * width
    if len(fitting) >= 2 and _is_unit_line(fitting[-1]):
        names = [cell.strip() for cell in fitting[-2]]
        units: list[str | None] = [cell.strip("[]() ") or None for cell in fitting[-1]]
    else:
        pairs = [named_unit(cell, is_unit) for cell in fitting[-1]]
        names, units = [name for name, _ in pairs], [unit for _, unit in pairs]
    return [name or f"column_{index + 1}" for index, name in enumerate(names)], units


def _is_unit_line(row: Sequence[str]) -> bool:
    """Most of the cells are units; one that is not is refused later, by name."""
    bare = [cell.strip("[]() ") for cell in row if cell.strip("[]() ")]
    return bool(bare) and 2 * sum(is_unit(cell) for cell in bare) > len(bare)


def _contents(
    headings: list[str], units: Sequence[str | None], data: Sequence[Sequence[str]], comma: bool, notes: list[str], wanted: Wanted
) -> Contents:
    columns: list[Column] = []
    skipped: dict[str, str] = {}
    seen: dict[str, int] = {}
    for index, (heading, unit) in enumerate(zip(headings, units, strict=True)):
        seen[heading] = seen.get(heading, 0) + 1
        name = heading if seen[heading] == 1 else f"{heading}_{seen[heading]}"
        if name != heading:
            notes.append(f"the name {heading!r} occurs again; column {index + 1} is named {name!r}")
        if not wanted(name):
            continue
        cells = [row[index] for row in data]
        values, bad = _values(cells, comma)
        if values is None:
            skipped[name] = f"text, like {cells[0][:30]!r}"
            continue
        if bad:
            notes.append(
                f"column {name!r}: {len(bad)} cells hold no number (the first: {cells[bad[0]][:20]!r} in line {bad[0] + 1} of the data)"
            )
        columns.append(Column(name=name, unit="ns" if values.dtype.kind == "i" else unit, values=values))
    return Contents(columns=tuple(columns), skipped=skipped, notes=tuple(notes))


def _values(cells: Sequence[str], comma: bool) -> tuple[npt.NDArray[np.float64] | npt.NDArray[np.int64] | None, list[int]]:
    """Numbers of a column (dates as whole nanoseconds) and the cells that are none; None for text."""
    if _DATE.fullmatch(cells[0]):
        try:
            dates = np.array([cell.rstrip("Z").replace(",", ".").replace(" ", "T") for cell in cells], dtype="datetime64[ns]")
        except ValueError:
            return None, []
        return (None, []) if np.isnat(dates).any() else (dates.astype(np.int64), [])
    if not comma and "_" not in "".join(cells):
        try:
            return np.array(list(map(float, cells))), []
        except ValueError:
            pass
    number: Callable[[str], float] = _with_comma if comma else _with_point
    values = np.empty(len(cells))
    bad: list[int] = []
    for index, cell in enumerate(cells):
        try:
            values[index] = number(cell)
        except ValueError:
            values[index] = np.nan
            bad.append(index)
    if len(bad) > len(cells) // 2:
        blank = sum(cell.lower() in _MISSING for cell in cells)
        return (values, bad) if blank == len(bad) and blank < len(cells) else (None, [])
    return values, bad


def _with_point(cell: str) -> float:
    if "_" in cell:  # Python's 1_000 is no number of a logger
        raise ValueError(cell)
    try:
        return float(cell)
    except ValueError:
        if re.fullmatch(r"[+-]?(?:\d+\.?\d*|\.\d+)[dD][+-]?\d+", cell):  # Fortran's 1.5D-3
            return float(cell.lower().replace("d", "e"))
        raise


def _with_comma(cell: str) -> float:
    if "." in cell:
        raise ValueError(cell)
    return _with_point(cell.replace(",", "."))


def _recognises(_: bytes) -> bool:
    return False  # any text may be a table: by suffix only


FORMAT = Format(name="text table", suffixes=(".csv", ".tsv", ".txt", ".dat", ".asc"), recognises=_recognises, read=read)
