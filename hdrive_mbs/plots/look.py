"""The house look: sizes, colours that colour-blind readers tell apart, line styles that also work in grey."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib
import numpy as np
import numpy.typing as npt
from cycler import cycler
from matplotlib import font_manager
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.textpath import TextPath

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#56B4E9", "#E69F00")
"""Okabe and Ito, without yellow."""

LINES: tuple[Any, ...] = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 2)), (0, (1, 2)))

GREY = "#666666"

HOUSE: Any = {
    "axes.prop_cycle": cycler(color=COLOURS) + cycler(linestyle=LINES),
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.labelsize": 10,
    "axes.formatter.limits": (-3, 5),
    "axes.formatter.use_mathtext": True,
    "font.size": 9.5,
    "figure.titlesize": 11,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 9,
    "legend.handlelength": 2.6,
    "lines.linewidth": 1.3,
    "savefig.dpi": 150,
    "svg.hashsalt": "hdrive-mbs",
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
}


@contextmanager
def house_look() -> Iterator[None]:
    """The look inside a ``with`` block; the user's own settings are as before afterwards."""
    with matplotlib.rc_context(HOUSE):
        yield


def new_figure(width: float = 7.2, height: float = 4.2) -> Figure:
    """An empty figure [inch] that needs no display."""
    return Figure(figsize=(width, height), layout="constrained")


def given_or_new(ax: Axes | None, width: float = 7.2, height: float = 4.2) -> Axes:
    """The axes given, or those of a new figure."""
    return ax if ax is not None else new_figure(width, height).add_subplot()


def style(index: int) -> dict[str, Any]:
    """Colour and line style number ``index``."""
    return {"color": COLOURS[index % len(COLOURS)], "linestyle": LINES[index % len(LINES)]}


def legend_above(ax: Axes, columns: int = 3) -> None:
    """A legend above the axes, where it hides no data."""
    handles, labels = ax.get_legend_handles_labels()
    if labels:
        ax.legend(handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=min(columns, len(labels)), borderaxespad=0.2)


def headed(figure: Figure, text: str) -> None:
    """The title of a whole figure, in as many lines as its width asks for."""
    size = font_manager.FontProperties(size=matplotlib.rcParams["figure.titlesize"])
    room, lines = 72.0 * figure.get_figwidth() * 0.97, [""]
    for word in text.split(" "):
        longer = f"{lines[-1]} {word}".strip()
        if lines[-1] and TextPath((0.0, 0.0), longer, prop=size).get_extents().width > room:
            lines.append(word)
        else:
            lines[-1] = longer
    figure.suptitle("\n".join(lines), x=0.01, ha="left")


def readable(channel: str) -> str:
    """``gear.wave_generator.speed`` -> ``gear wave generator speed``."""
    return channel.replace(".", " ").replace("_", " ")


def number(value: float) -> str:
    """Four significant digits, without an exponent where that is readable."""
    return f"{float(f'{value:.4g}'):.10g}" if 1e-3 <= abs(value) < 1e6 else f"{value:.4g}"


def unit_text(unit: str) -> str:
    """``N m s/rad`` with dots, ``rad/s^2`` with a raised 2."""
    return raised(unit).replace(" ", "\u2009")


def raised(text: str) -> str:
    """Powers of units raised: ``rad/s^2`` with a small 2."""
    return text.replace("^2", "²").replace("^3", "³")


def other_unit(factor: float) -> tuple[Callable[[npt.ArrayLike], Any], Callable[[npt.ArrayLike], Any]]:
    """Functions of a second scale that shows ``factor`` times the values."""
    return lambda values: np.asarray(values) * factor, lambda values: np.asarray(values) / factor
