"""What the pictures of a diagnosis share: the same colour for the same model everywhere."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from hdrive_mbs.diagnosis.readable import scale
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.plots.look import COLOURS, GREY, unit_text

FloatArray = npt.NDArray[np.float64]

WIDTH = 5.6
"""Of a picture [inch]: its text can still be read across a phone."""

MEASURED: dict[str, Any] = {"color": "#A8A8A8", "linestyle": "-", "linewidth": 3.6, "solid_capstyle": "round"}
"""Pale and wide, below the models: one that follows it does not hide it."""
NOMINAL: dict[str, Any] = {"color": GREY, "linestyle": ":", "linewidth": 1.3}
REFIT: dict[str, Any] = {"color": COLOURS[1], "linestyle": "--", "linewidth": 1.2}
EFFECT: dict[str, Any] = {"color": COLOURS[0], "linestyle": "-", "linewidth": 1.2}
STEPS = {"nominal": "nominal", "refit": "parameters refitted", "effect": "with the cause"}
"""What the three models are called."""
LOOKS = {"nominal": NOMINAL, "refit": REFIT, "effect": EFFECT}


def steps_of(claimed: bool) -> dict[str, str]:
    """Models that are shown: the third one only where a cause is claimed."""
    return STEPS if claimed else {name: text for name, text in STEPS.items() if name != "effect"}


def drawn_unit(unit: str, values: FloatArray) -> tuple[float, str]:
    """Size in SI and name of the unit in which values are drawn."""
    finite = np.abs(values[np.isfinite(values)])
    name, size = scale(unit, float(finite.max()) if len(finite) else 0.0)
    return size, unit_text(name.replace("um", "\u00b5m").replace("urad", "\u00b5rad"))


def shade(ax: Axes, times: FloatArray, mask: npt.NDArray[np.bool_]) -> None:
    """A grey ground under the stretches where ``mask`` holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    label: str | None = "held out"
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        ax.axvspan(float(times[first]), float(times[last - 1]), color="#E8E8E8", linewidth=0.0, zorder=0.1, label=label)
        label = None


def binned(x: FloatArray, y: FloatArray, bins: int = 30) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Middle, mean, and mean -+ standard deviation of y in even bins of x that hold eight samples or more."""
    there = np.isfinite(x) & np.isfinite(y)
    x, y = x[there], y[there]
    if len(x) < 8 or not np.ptp(x) > 0.0:
        return tuple(np.empty(0) for _ in range(4))  # type: ignore[return-value]
    place = np.minimum(((x - x.min()) / np.ptp(x) * bins).astype(int), bins - 1)
    number = np.bincount(place, minlength=bins)
    full = number >= 8
    mean = np.bincount(place, y, minlength=bins)[full] / number[full]
    square = np.bincount(place, y**2, minlength=bins)[full] / number[full]
    spread = np.sqrt(np.maximum(square - mean**2, 0.0))
    middle = (x.min() + (np.arange(bins) + 0.5) * np.ptp(x) / bins)[full]
    return middle, mean, mean - spread, mean + spread


def needed(items: Sequence[Any], what: str, way_out: str) -> None:
    """Raise AnalysisError where a diagnosis has nothing of a kind to draw."""
    if not items:
        raise AnalysisError(f"This diagnosis has no {what} to draw. {way_out}")


def varies(values: FloatArray, samples: int) -> bool:
    """Whether values can be an axis for so many samples."""
    finite = values[np.isfinite(values)]
    return len(values) == samples and len(finite) > 1 and bool(finite.max() > finite.min())
