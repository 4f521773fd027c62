"""Picture of the hysteresis loop at the located connection, before and after."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.errors import unknown_place
from hdrive_mbs.plots.diagnosis_look import EFFECT, MEASURED, REFIT, WIDTH, drawn_unit, needed
from hdrive_mbs.plots.look import given_or_new, house_look, legend_above, number, readable


def plot_loop(diagnosis: Diagnosis, ax: Axes | None = None, *, record: str | None = None, spring: bool = False) -> Axes:
    """Torque against twist of a connection.

    record : which; the first loop if not given
    spring : False takes the straight line through the measured loop out, so that its width can be seen
    """
    needed(diagnosis.loops, "loop", "A loop is kept where the gap lies at a connection.")
    known = [loop.record for loop in diagnosis.loops]
    if record is not None and record not in known:
        raise unknown_place("record", record, dict.fromkeys(known), "Among the loops this diagnosis")
    loop = next(item for item in diagnosis.loops if record in (None, item.record))
    curves = [(loop.measured, "estimated", MEASURED), (loop.refit, "parameters refitted", REFIT)]
    if diagnosis.causes:
        curves.append((loop.effect, "with the cause", EFFECT))
    shown = [(curve, text, look) for curve, text, look in curves if curve.size]
    needed(shown, "points of its loop", "Ask for a diagnosis with traces.")
    twist_size, twist_unit = drawn_unit("rad", shown[0][0][0])
    slope = 0.0 if spring else _slope(shown[0][0][0], shown[0][0][1])
    torque_size, torque_unit = drawn_unit("N m", shown[0][0][1])
    with house_look():
        ax = given_or_new(ax, WIDTH, 4.0)
        for curve, text, look in shown:
            ax.plot(curve[0] / twist_size, (curve[1] - slope * curve[0]) / torque_size, label=text, **{**look, "linewidth": 0.9})
        ax.set_xlabel(f"twist of {readable(loop.at)} [{twist_unit}]")
        line = "" if spring or not slope else f" minus\n{number(slope)}\u2009N\u2009m/rad times twist"
        ax.set_ylabel(f"torque{line} [{torque_unit}]")
        legend_above(ax)
        if loop.record:
            ax.annotate(f"record {loop.record}", (0.99, 0.02), xycoords="axes fraction", ha="right", va="bottom", fontsize=8.5)
    return ax


def _slope(twist: np.ndarray[tuple[int], np.dtype[np.float64]], torque: np.ndarray[tuple[int], np.dtype[np.float64]]) -> float:
    there = np.isfinite(twist) & np.isfinite(torque)
    x, y = twist[there] - twist[there].mean(), torque[there] - torque[there].mean()
    return float(x @ y / (x @ x)) if len(x) and x @ x > 0.0 else 0.0
