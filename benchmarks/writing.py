"""Results of a benchmark as results.json, results.md and pictures, each written whole or not at all."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from hdrive_mbs.writing import write_text, write_whole


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A Markdown table that also reads well in a terminal; cells beyond 48 characters are not padded."""
    cells = [[str(item).replace("|", "\\|") for item in row] for row in rows]
    widths = [min(max(len(row[k]) for row in [list(head), *cells]), 48) for k in range(len(head))]

    def line(row: Sequence[str]) -> str:
        return "| " + " | ".join(item.ljust(width) for item, width in zip(row, widths, strict=True)) + " |"

    return "\n".join([line(head), "|" + "|".join("-" * (width + 2) for width in widths) + "|", *map(line, cells)])


def facts(values: Mapping[str, Any]) -> str:
    """One line of ``name: value`` pairs."""
    return "; ".join(f"{name}: {value}" for name, value in values.items()) + "."


def write_results(folder: Path, numbers: Mapping[str, Any], text: str, figures: Mapping[str, Figure]) -> list[Path]:
    """results.json, results.md and one PNG per figure; returns what was written."""
    written = [
        write_text(folder / "results.json", json.dumps(_plain(numbers), indent=1, allow_nan=False) + "\n"),
        write_text(folder / "results.md", text.rstrip() + "\n"),
    ]
    for name, figure in figures.items():
        written.append(write_whole(folder / f"{name}.png", lambda file, f=figure: f.savefig(file, format="png", dpi=130)))  # type: ignore[misc]
    return written


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(item) for item in value]
    if isinstance(value, (np.floating, np.integer, np.bool_)):
        return _plain(value.item())
    if isinstance(value, float):
        # 5 digits are more than any of these measurements is worth; None for "not reached"
        return float(f"{value:.5g}") if np.isfinite(value) else None
    return value
