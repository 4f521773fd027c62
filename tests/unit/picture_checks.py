"""What every picture is checked for."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

from hdrive_mbs.plots.look import house_look


def figure_of(ax: Axes) -> Figure:
    figure = ax.figure.figure
    assert isinstance(figure, Figure)
    return figure


def drawn(ax: Axes) -> Any:
    """The renderer after the layout has been worked out."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure_of(ax))
    with house_look():
        canvas.draw()
    return canvas.get_renderer()


def ticks_outside(figure: Figure) -> set[Any]:
    """Labels of ticks outside the limits, which matplotlib keeps but does not draw."""
    hidden = set()
    for one in [*figure.axes, *(child for ax in figure.axes for child in ax.child_axes)]:
        for axis, limits in ((one.xaxis, one.get_xlim()), (one.yaxis, one.get_ylim())):
            low, high = sorted(limits)
            for tick in axis.get_major_ticks() + axis.get_minor_ticks():
                if not low <= tick.get_loc() <= high:
                    hidden |= {tick.label1, tick.label2}
    return hidden


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


def assert_names_cover_nothing(ax: Axes) -> None:
    """No name of a point lies on a curve, a mark or another text of its panel; at least one is there."""
    renderer = drawn(ax)
    seen = 0
    for one in figure_of(ax).axes:
        boxes = [(text.get_text(), Text.get_window_extent(text, renderer)) for text in one.texts if text.get_visible()]
        for k, (name, box) in enumerate(boxes):
            seen += 1
            for other, there in boxes[:k]:
                assert not box.overlaps(there), f"{name!r} on {other!r}"
            for line in one.lines:
                path = line.get_transform().transform_path(line.get_path())
                if line.get_linestyle() != "None":
                    assert not path.cleaned(remove_nans=True).intersects_bbox(box, filled=False), f"{name!r} on {line.get_label()!r}"
                if line.get_marker() != "None":
                    assert not any(box.contains(*point) for point in path.vertices), f"{name!r} on a mark"
    assert seen
