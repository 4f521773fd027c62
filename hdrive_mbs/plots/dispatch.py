"""``plot(result)``: one function for all results; each type's picture is in a file of its own."""

from __future__ import annotations

import functools
from typing import Any

from matplotlib.axes import Axes

from hdrive_mbs.errors import AnalysisError


@functools.singledispatch
def plot(result: Any, ax: Axes | None = None, **options: Any) -> Axes:
    """Draw a result; returns its (first) Axes.

    ax : draw there; if not given, on a new figure (``axes.figure``), which may have several axes
    Raises AnalysisError for something that has no picture.  ``matplotlib.pyplot`` is never used, so no
    window opens and no display is needed.
    """
    known = sorted(kind.__name__ for kind in plot.registry if kind is not object)
    raise AnalysisError(f"There is no picture of a {type(result).__name__}. There are pictures of: {', '.join(known)}.")
