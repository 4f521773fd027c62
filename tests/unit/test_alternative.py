"""Words for a figure, read off it."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from hdrive_mbs.plots.alternative import drawn_words


def test_panels_and_legends_are_told_without_units() -> None:
    figure = Figure()
    above, below = figure.subplots(2, 1, sharex=True)
    above.plot([0.0, 1.0], label="measured")
    above.plot([1.0, 1.0], label="nominal")
    above.set_ylabel("motor angle\n[mrad]")
    above.legend()
    below.set_ylabel("measured minus simulated\n[standard deviations\nof the noise]")
    below.set_xlabel("time [s]")
    assert drawn_words(above) == "Panels: motor angle over time; measured minus simulated over time. Shown: measured, nominal."


def test_an_axis_beside_is_told_over_what_both_are_drawn_over() -> None:
    figure = Figure()
    ax = figure.subplots()
    ax.set_ylabel("speed [rad/s]")
    ax.set_xlabel("time [s]")
    beside = ax.twinx()
    beside.set_ylabel("torque [N m]")
    beside.plot([0.0, 1.0], label="torque of the gear")
    figure.legend()
    assert drawn_words(ax) == "Panels: speed over time; torque over time. Shown: torque of the gear."


def test_a_map_is_told_with_its_titles_and_its_scale_over_nothing() -> None:
    figure = Figure()
    panels = figure.subplots(2, 1, sharex=True)
    for ax, title in zip(panels, ("before", "after"), strict=True):
        drawn = ax.pcolormesh(np.eye(3))
        ax.set_title(title, loc="left")
        ax.set_ylabel("speed [rad/s]")
    panels[-1].set_xlabel("order")
    figure.colorbar(drawn, ax=panels).set_label("amplitude, 0-peak [m]")
    assert drawn_words(panels[0]) == "Panels: before: speed over order; after: speed over order; amplitude, 0-peak."


def test_a_figure_without_names_has_no_words() -> None:
    assert drawn_words(Figure().subplots()) == ""
