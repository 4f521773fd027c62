"""Figures to files: PNG and SVG, whole or not at all."""

from __future__ import annotations

import io
import os
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hdrive_mbs.plots.look import house_look
from hdrive_mbs.writing import write_whole


def save_figure(figure: Figure | Axes, stem: str | os.PathLike[str]) -> tuple[Path, Path]:
    """Write ``stem.png`` and ``stem.svg``; returns both paths.

    figure : a figure, or axes on it (what ``plot`` returns)
    Both are drawn before the first is written.  The SVG carries no date, so that the same picture
    gives the same file.  Raises FileFormatError for a folder that cannot be written to.
    """
    whole = figure if isinstance(figure, Figure) else figure.figure.figure
    assert isinstance(whole, Figure)
    target = Path(stem)
    if target.suffix in (".png", ".svg"):
        target = target.with_suffix("")
    drawn: dict[str, bytes] = {}
    with house_look():
        for kind, metadata in (("png", {"Software": None}), ("svg", {"Date": None})):
            buffer = io.BytesIO()
            whole.savefig(buffer, format=kind, metadata=metadata)
            drawn[kind] = buffer.getvalue()
    png, svg = (
        write_whole(target.with_name(f"{target.name}.{kind}"), lambda file, kind=kind: file.write(drawn[kind]))  # type: ignore[misc]
        for kind in ("png", "svg")
    )
    return png, svg
