"""Pictures of where in the operating range the misfit lies: bars over speed, torque, ..., and a map over speed and order."""

from __future__ import annotations

import itertools
import math
import textwrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm

from hdrive_mbs.diagnosis.result import Diagnosis, DomainBin
from hdrive_mbs.diagnosis.sentences import bin_name, over_name
from hdrive_mbs.errors import unknown_place
from hdrive_mbs.plots.diagnosis_look import EFFECT, REFIT, WIDTH, drawn_unit, needed
from hdrive_mbs.plots.look import house_look, legend_above, new_figure, readable, unit_text

MOST = 9
"""Ticks of an axis."""
LEAST = 0.01
"""Excess below which a bar is not drawn: a hundredth of the noise's mean square."""
RANGE = 1e-3


def plot_domain(diagnosis: Diagnosis, ax: Axes | None = None, *, over: str | None = None) -> Axes:
    """Mean square of the residual above the noise, by bins of speed, torque, direction, order, frequency and time.

    over : only one of these;  with ``ax`` the first of them goes there
    """
    needed(diagnosis.domain, "domain map", "It is made where there is a gap.")
    names = list(dict.fromkeys(item.over for item in diagnosis.domain))
    if over is not None and over not in names:
        raise unknown_place("domain", over, names, "This diagnosis")
    chosen = names if over is None else [over]
    bins = {name: [item for item in diagnosis.domain if item.over == name] for name in chosen}
    with house_look():
        if ax is not None:
            _bars(ax, bins[chosen[0]], bool(diagnosis.causes))
            legend_above(ax, columns=2)
            return ax
        figure = new_figure(WIDTH, 0.5 + 1.85 * len(chosen))
        panels = list(np.atleast_1d(figure.subplots(len(chosen), 1)))
        for panel, name in zip(panels, chosen, strict=True):
            _bars(panel, bins[name], bool(diagnosis.causes))
        figure.align_ylabels(panels)
        legend_above(panels[0], columns=2)
    first: Axes = panels[0]
    return first


def plot_orders(diagnosis: Diagnosis, ax: Axes | None = None, *, record: str | None = None) -> Axes:
    """Amplitudes, 0-peak, of the residual over speed and order, before and, where a cause is claimed, after, on one scale of colours.

    record : which; the first map if not given;  with ``ax`` only "before" is drawn, there
    """
    needed(diagnosis.order_maps, "order map", "It is made where a record runs through a range of speeds.")
    known = [item.record for item in diagnosis.order_maps]
    if record is not None and record not in known:
        raise unknown_place("record", record, dict.fromkeys(known), "Among the order maps this diagnosis")
    chosen = next(item for item in diagnosis.order_maps if record in (None, item.record))
    size, unit = drawn_unit(chosen.unit, chosen.before)
    top = float(np.nanmax(chosen.before)) / size
    if not (math.isfinite(top) and top > 0.0):
        top = 1.0
    norm = LogNorm(RANGE * top, top)
    maps = [("before (parameters refitted)", chosen.before)]
    if diagnosis.causes and np.isfinite(chosen.after).any():
        maps.append(("after (with the cause)", chosen.after))
    with house_look():
        panels: list[Axes] = []
        if ax is not None:
            maps, panels = maps[:1], [ax]
        else:
            figure = new_figure(WIDTH, 0.9 + 2.3 * len(maps))
            panels = list(np.atleast_1d(figure.subplots(len(maps), 1, sharex=True)))
        drawn: Any = None
        for panel, (text, amplitude) in zip(panels, maps, strict=True):
            values = np.clip(np.nan_to_num(amplitude / size, nan=RANGE * top), RANGE * top, None)
            drawn = panel.pcolormesh(chosen.orders, chosen.speeds, values, norm=norm, cmap="viridis", shading="nearest", rasterized=True)
            panel.set_title(text)
            panel.set_ylabel(f"speed of\n{readable(chosen.reference)} [rad/s]")
            panel.grid(False)
        panels[-1].set_xlabel(f"order (periods per revolution of {readable(chosen.reference)})")
        bar = panels[0].figure.colorbar(drawn, ax=panels, aspect=30)
        bar.set_label(f"residual of {readable(chosen.column)}, 0-peak [{unit}]")
        if ax is None:
            figure.suptitle(f"{chosen.record}: {readable(chosen.column)}", x=0.01, ha="left", fontsize=10)
    return panels[0]


def _bars(ax: Axes, bins: list[DomainBin], claimed: bool) -> None:
    before = np.array([item.excess for item in bins])
    after = np.array([item.after for item in bins])
    at = np.arange(len(bins))
    two = claimed and bool(np.isfinite(after).any())
    width = 0.42 if two else 0.7
    ax.bar(at - (0.21 if two else 0.0), _tall(before), width, bottom=LEAST, color=REFIT["color"], label="parameters refitted")
    if two:
        ax.bar(at + 0.21, _tall(after), width, bottom=LEAST, color=EFFECT["color"], label="with the cause")
    ax.axhline(1.0, color="black", linestyle="--", linewidth=1.0, label="as much as the noise")
    ax.set_yscale("log")
    ax.yaxis.set_major_formatter("{x:g}")
    tallest = max([float(value) for value in (*before, *after) if math.isfinite(value)], default=1.0)
    ax.set_ylim(LEAST, 2.0 * max(tallest, 1.0))
    over, unit, name = bins[0].over, bins[0].unit, over_name(bins[0])
    ends = [item.low for item in bins] + [bins[-1].high]
    touching = all(a.high == b.low for a, b in itertools.pairwise(bins)) and all(map(math.isfinite, ends)) and len(bins) > 2
    if over == "order":
        every = -(-len(bins) // MOST)
        ax.set_xticks(at[::every], [f"{0.5 * (item.low + item.high):.3g}" for item in bins[::every]])
    elif touching and over != "direction":
        every = -(-len(ends) // MOST)
        ax.set_xticks((np.arange(len(ends)) - 0.5)[::every], [f"{end:.3g}" for end in ends[::every]])
    else:
        ax.set_xticks(at, ["\n".join(textwrap.wrap(bin_name(item).removesuffix(f" {unit}"), 16)) for item in bins])
    ax.set_xlabel(name if unit in ("", "1") or over == "direction" else f"{name} [{unit_text(unit)}]")
    ax.set_ylabel("mean square\nabove noise")
    ax.set_xlim(-0.6, len(bins) - 0.4)
    ax.grid(False, axis="x")


def _tall(values: np.ndarray[Any, np.dtype[np.float64]]) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.asarray(np.maximum(np.nan_to_num(values, nan=0.0) - LEAST, 0.0))
