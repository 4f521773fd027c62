"""Picture of a reduction: both transfers and the frequency up to which they agree."""

from __future__ import annotations

import textwrap

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.analysis.drive_train.reduction import Reduction
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import GREY, given_or_new, house_look, legend_above, number, readable, style


@plot.register
def plot_reduction(result: Reduction, ax: Axes | None = None) -> Axes:
    """Speed of the loaded end per torque at the held one, of the full and of the reduced model."""
    with house_look():
        ax = given_or_new(ax)
        ax.loglog(result.frequency, np.abs(result.full_transfer), label="full model", **style(0))
        ax.loglog(result.frequency, np.abs(result.reduced_transfer), label="rigid shafts", **style(1))
        tolerance = 100.0 * float(result.settings.get("transfer_tolerance", np.nan))
        if result.good_to > 0.0:
            label = f"agree within {tolerance:g} % up to {number(result.good_to)} rad/s"
            ax.axvline(result.good_to, color=GREY, linestyle=":", linewidth=1.2, label=label)
        ax.set_xlim(float(result.frequency[0]), float(result.frequency[-1]))
        ax.set_xlabel("frequency [rad/s]")
        source, target = readable(result.held), readable(result.loaded)
        ax.set_ylabel(f"speed of {target} per torque of {source},\n0-peak over 0-peak [rad/s/(N\u2009m)]")
        ax.figure.figure.suptitle(textwrap.fill(result.reason.split(" End to end")[0], 105), x=0.01, ha="left", fontsize=9)
        legend_above(ax)
    return ax
