"""Pictures of time responses and start-ups."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.analysis.drive_train.start_up import StartUp
from hdrive_mbs.analysis.main_channels import MOST_LINES, main_channels
from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.lengths import shown_unit
from hdrive_mbs.plots.look import GREY, house_look, legend_above, new_figure, readable, style
from hdrive_mbs.plots.thinning import thinned

MOST_PANELS = 5

QUANTITIES = {"rad": "angle", "rad/s": "speed", "rad/s^2": "acceleration", "N m": "torque", "N": "force", "m": "displacement"}
"""What a panel with different quantities of one unit is called."""


@plot.register
def plot_response(
    result: Response,
    ax: Axes | None = None,
    *,
    channels: Sequence[str] | None = None,
    start: float | None = None,
    end: float | None = None,
) -> Axes:
    """Histories over time, one panel per quantity and size; returns the top one.

    channels : names of channels; speeds and torques of motor, gear and machine if not given
    start, end : the part to draw [s]
    With ``ax`` all channels go there and must have one unit.
    """
    chosen = list(channels) if channels is not None else main_channels(result.scene, result.channels)
    for name in chosen:
        if name not in result:
            raise unknown_place("channel", name, result.channels, "This response")
    if not chosen:
        raise ParameterError("channels: name at least one channel to draw.")
    span = (result.times >= (-np.inf if start is None else start)) & (result.times <= (np.inf if end is None else end))
    if span.sum() < 2:
        raise ParameterError(f"Between start = {start} s and end = {end} s there are fewer than 2 samples to draw.")
    if ax is not None:
        units = {result.units[name] for name in chosen}
        if len(units) > 1:
            raise ParameterError(
                f"One Axes shows one unit, but the channels have {', '.join(sorted(units))}; leave ax out for several panels."
            )
        with house_look():
            _panel(ax, result, chosen, span)
            ax.set_xlabel("time [s]")
        return ax
    panels = _panels(result, chosen, split=channels is None)
    with house_look():
        figure = new_figure(7.2, 1.1 + 1.65 * len(panels))
        axes = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
        for one, names in zip(axes, panels, strict=True):
            _panel(one, result, names, span)
        axes[-1].set_xlabel("time [s]")
        figure.align_ylabels(axes)
        if result.scene is not None:
            note = "" if result.status.startswith("complete") else f" ({result.status})"
            figure.suptitle(f"{result.scene.name}{note}", x=0.01, ha="left")
    first: Axes = axes[0]
    return first


@plot.register
def plot_start_up(
    result: StartUp,
    ax: Axes | None = None,
    *,
    channels: Sequence[str] | None = None,
    start: float | None = None,
    end: float | None = None,
) -> Axes:
    """The response with the take-up of lost motion and the rise of the speed marked."""
    first = plot_response(result, ax, channels=channels, start=start, end=end)
    marks = [(f"{readable(name)} takes up its lost motion", time) for name, time in result.take_up_time.items()]
    marks.append(("95 % of the final speed", result.rise_time))
    with house_look():
        for number, one in enumerate(first.figure.axes if ax is None else [first]):
            for k, (text, time) in enumerate(marks):
                if math.isfinite(time) and result.times[0] <= time <= result.times[-1]:
                    label = f"{text}: {1e3 * time:.4g} ms" if number == 0 else None
                    one.axvline(time, color=GREY, linestyle=(":", "--")[k % 2], linewidth=1.0, label=label)
        legend_above(first, columns=2)
    return first


def _panels(result: Response, channels: list[str], *, split: bool) -> list[list[str]]:
    """Channels by unit and, of the automatic choice, by size (a tenth of the largest is a panel of its own)."""
    panels: list[list[str]] = []
    for unit in dict.fromkeys(result.units[name] for name in channels):
        same = [name for name in channels if result.units[name] == unit]
        size = {name: float(np.max(np.abs(result.values[name]))) for name in same}
        rest = same
        while rest:
            largest = max(size[name] for name in rest)
            together = [name for name in rest if not split or size[name] > 0.1 * largest or size[name] == 0.0][
                : MOST_LINES if split else None
            ]
            panels.append(together)
            rest = [name for name in rest if name not in together]
    return panels[:MOST_PANELS] if split else panels


def _panel(ax: Axes, result: Response, channels: list[str], span: np.ndarray) -> None:
    unit = result.units[channels[0]]
    factor, shown = shown_unit(unit, max(float(np.max(np.abs(result.values[name][span]))) for name in channels))
    for k, name in enumerate(channels):
        x, y = thinned(result.times[span], result.values[name][span])
        ax.plot(x, factor * y, label=readable(name), **style(k))
    quantities = {name.rpartition(".")[2] for name in channels}
    quantity = readable(quantities.pop()) if len(quantities) == 1 else QUANTITIES.get(unit, "value")
    ax.set_ylabel(f"{'distance' if quantity == 'radial' else quantity} [{shown}]")
    ax.margins(x=0.0)
    legend_above(ax)
