"""What pictures of the time-domain analyses are checked for."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.text import Text

from tests.unit.test_plots import drawn, figure_of, ticks_outside


def written(ax: Axes) -> list[str]:
    """Every text on the figure that is not empty."""
    return [text.get_text() for text in figure_of(ax).findobj(Text) if text.get_visible() and text.get_text().strip()]


def assert_nothing_is_cut_off(ax: Axes) -> None:
    """Every text lies inside the picture."""
    renderer = drawn(ax)
    figure = figure_of(ax)
    hidden = ticks_outside(figure)
    width, height = figure.canvas.get_width_height()
    for text in figure.findobj(Text):
        if not text.get_visible() or not text.get_text().strip() or text in hidden:
            continue
        box = text.get_window_extent(renderer)
        assert box.x0 > -2.0, text.get_text()
        assert box.x1 < width + 2.0, text.get_text()
        assert box.y0 > -2.0, text.get_text()
        assert box.y1 < height + 2.0, text.get_text()
