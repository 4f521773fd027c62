"""Picture of a balance of energy and angular momentum."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from hdrive_mbs.analysis.energy import EnergyBalance
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import house_look, legend_above, new_figure, readable, style
from hdrive_mbs.plots.thinning import thinned

FloatArray = npt.NDArray[np.float64]


@plot.register
def plot_energy(result: EnergyBalance, ax: Axes | None = None) -> Axes:
    """What flows in and out, what connections store and turn into heat, and what does not balance.

    With ``ax`` only the first of these three.
    """
    with house_look():
        if ax is not None:
            _flows(ax, result)
            ax.set_xlabel("time [s]")
            return ax
        figure = new_figure(7.2, 6.6)
        axes = figure.subplots(3, 1, sharex=True)
        _flows(axes[0], result)
        _kept(axes[1], result)
        _residuals(axes[2], result)
        axes[2].set_xlabel("time [s]")
        figure.align_ylabels(axes)
        if result.scene is not None:
            what = "energy and angular momentum" if len(result.momentum) else "energy"
            figure.suptitle(f"{result.scene.name}: balance of {what}", x=0.01, ha="left")
    first: Axes = axes[0]
    return first


def _draw(ax: Axes, times: FloatArray, columns: list[tuple[str, FloatArray]]) -> None:
    for k, (name, values) in enumerate(columns):
        ax.plot(*thinned(times, values), label=name, **style(k))
    ax.margins(x=0.0)


def _flows(ax: Axes, result: EnergyBalance) -> None:
    outer = {name: values for name, values in result.work.items() if name not in result.stored}
    # what never does work (a torque on a body that stands) would only lengthen the legend
    moved = [(name, values) for name, values in outer.items() if np.any(values != 0.0)]
    columns = [("kinetic", result.kinetic)]
    for name, values in moved[:5]:
        drives = values[-1] < 0.0
        columns.append((f"{'from' if drives else 'to'} {readable(name)}", -values if drives else values))
    columns += [(f"from the drive of {readable(name)}", values) for name, values in result.driven.items()]
    heat = sum(result.dissipated.values(), np.zeros_like(result.kinetic))
    columns.append(("heat in connections", heat))
    _draw(ax, result.times, columns)
    ax.set_ylabel("energy [J]")
    legend_above(ax, columns=2)


def _kept(ax: Axes, result: EnergyBalance) -> None:
    columns = [(f"stored in {readable(name)}", values) for name, values in result.stored.items()]
    columns += [(f"heat in {readable(name)}", values) for name, values in result.dissipated.items()]
    size = max((float(np.max(np.abs(values))) for _, values in columns), default=0.0)
    seen = [(name, values) for name, values in columns if np.max(np.abs(values)) > 0.01 * size]
    _draw(ax, result.times, seen[:6])
    ax.set_ylabel("energy [J]")
    legend_above(ax, columns=2)


def _residuals(ax: Axes, result: EnergyBalance) -> None:
    columns = [("energy", np.abs(result.energy_residual) / result.energy_scale)]
    if len(result.momentum):
        columns.append(("angular momentum", np.abs(result.momentum_residual) / result.momentum_scale))
    for k, (name, values) in enumerate(columns):
        x, y = thinned(result.times, np.maximum(values, 1e-18))
        ax.plot(x, y, label=f"{name}, at most {float(values.max()):.2g}", **style(k))
    ax.set_yscale("log")
    ax.margins(x=0.0)
    ax.set_ylim(bottom=1e-17)
    ax.set_ylabel("imbalance / largest [1]")
    legend_above(ax, columns=2)
