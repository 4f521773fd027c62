"""An order line of a Campbell diagram, named where it ends."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from hdrive_mbs.plots.look import GREY
from hdrive_mbs.plots.point_names import name_point


def draw_order(ax: Axes, text: str, speeds: npt.NDArray[np.float64], slope: float, top: float, **look: Any) -> None:
    """The line slope * |speed|, with its name at the fastest speed at which it is below the top of the picture."""
    ax.plot(speeds, slope * np.abs(speeds), color=GREY, **look)
    fastest = float(speeds[np.argmax(np.abs(speeds))])
    end = np.copysign(min(abs(fastest), top / slope), fastest)
    if speeds[0] <= end <= speeds[-1]:
        name_point(ax, text, float(end), slope * abs(float(end)), color="#333333")
