"""Names of points in a picture, each at the nearest place where it covers no curve, no mark and no other text."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.text import Annotation, Text

from hdrive_mbs.plots.look import GREY

FloatArray = npt.NDArray[np.float64]

PAPER = {"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.8}
"""Behind a name, so that the grid does not cross it."""

ROOM = 2.0
"""Around a name [points]."""

NEAR = 8.0
"""Distance of a name from its point [points] above which a thin line joins them."""

MOST_TRIED = 4000
"""Places looked at, the nearest first, for one from which the line to the point crosses no other text."""

FAR = 150.0
"""Distance [points] beyond which a point goes without its name: in a crowd names would no longer tell whose they are."""


def name_point(ax: Axes, text: str, x: float, y: float, **look: Any) -> None:
    """Write a name beside a point (data coordinates); those named first choose first.

    The place is chosen when the picture is drawn, as that of a legend at its best location is, so it holds for any size
    and limits.  A name that finds none is left out.
    """
    thin = {"arrowstyle": "-", "color": GREY, "linewidth": 0.6, "shrinkA": 0.0, "shrinkB": 3.0}
    name = ax.annotate(
        text, (x, y), xytext=(0.0, 0.0), textcoords="offset points", **{"fontsize": 8.5, "bbox": PAPER, "arrowprops": thin, **look}
    )
    name.set_in_layout(False)  # it stays inside the axes
    known = [child for child in ax.artists if isinstance(child, _PointNames)]
    names = known[0] if known else ax.add_artist(_PointNames())
    assert isinstance(names, _PointNames)
    names.members.append(name)


class _PointNames(Artist):
    """Draws nothing itself: moves the names of its axes before they are drawn."""

    def __init__(self) -> None:
        super().__init__()
        self.members: list[Annotation] = []
        self.set_zorder(-100.0)
        self.set_in_layout(False)

    def draw(self, renderer: RendererBase) -> None:
        ax = self.axes
        assert isinstance(ax, Axes)
        taken = _Taken(ax)
        for line in ax.lines:
            if line.get_visible():
                taken.add_line(line)
        for text in ax.texts:
            if text not in self.members and text.get_visible() and text.get_text():
                taken.add_text(*taken.cell(text.get_window_extent(renderer).get_points()).ravel())
        for name in self.members:
            if name in ax.texts:  # not removed since
                self._place(name, taken, renderer)

    @staticmethod
    def _place(name: Annotation, taken: _Taken, renderer: RendererBase) -> None:
        name.set_visible(True)
        point = taken.cell(name.axes.transData.transform(name.xy))  # type: ignore[union-attr]
        box = Text.get_window_extent(name, renderer)  # without the line to the point
        size = np.array([box.width, box.height]) / taken.size
        corner = taken.nearest(point, size)
        name.set_visible(corner is not None)
        if corner is None:
            return
        name.set_horizontalalignment("left")
        name.set_verticalalignment("bottom")
        name.set_position(tuple(corner - point))
        assert name.arrow_patch is not None
        joined = _gap(point, corner, size) > NEAR
        name.arrow_patch.set_visible(joined)
        if joined:
            taken.add_strokes(point[None, :], (corner + 0.5 * size)[None, :])
        taken.add_text(*corner, *(corner + size))


def _gap(point: FloatArray, corner: FloatArray, size: FloatArray) -> float:
    """Distance of a point from a rectangle."""
    return float(np.hypot(*np.maximum(np.maximum(corner - point, point - corner - size), 0.0)))


class _Taken:
    """What of the axes is covered, in cells of one point.

    size : pixels per point
    covered, written : by anything, by text, (rows from below, columns)
    """

    def __init__(self, ax: Axes) -> None:
        figure = ax.figure.figure
        self.size = figure.dpi / 72.0
        self._box = ax.bbox
        self.covered = np.zeros((max(int(self._box.height / self.size), 1), max(int(self._box.width / self.size), 1)), bool)
        self.written = np.zeros_like(self.covered)

    def cell(self, pixels: npt.ArrayLike) -> FloatArray:
        """Points of the screen in cells."""
        return np.asarray((np.asarray(pixels, float) - [self._box.x0, self._box.y0]) / self.size)

    def add_line(self, line: Line2D) -> None:
        """Its strokes, if it has any, and its marks."""
        path = line.get_transform().transform_path(line.get_path())
        if line.get_linestyle() not in ("None", "", " "):
            rows, columns = self.covered.shape
            inside = Path(self.cell(path.vertices), path.codes).cleaned(remove_nans=True, clip=(-1.0, -1.0, columns + 1.0, rows + 1.0))
            assert inside.codes is not None
            corners, ends = np.asarray(inside.vertices, float), np.flatnonzero(inside.codes == Path.LINETO)
            self.add_strokes(corners[ends - 1], corners[ends])
        if line.get_marker() not in ("None", "", " ", None):
            half = 0.5 * (line.get_markersize() + line.get_markeredgewidth())
            for x, y in self.cell(path.vertices):
                if np.isfinite(x) and np.isfinite(y):
                    self._cover(self.covered, x - half, y - half, x + half, y + half)

    def add_text(self, left: float, low: float, right: float, high: float) -> None:
        """A rectangle, in cells."""
        for cells in (self.covered, self.written):
            self._cover(cells, left, low, right, high)

    def add_strokes(self, starts: FloatArray, ends: FloatArray) -> None:
        """Straight lines between points, in cells."""
        self.covered[self._under(starts, ends)] = True

    def _under(self, starts: FloatArray, ends: FloatArray) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Rows and columns that straight lines pass."""
        steps = np.ceil(2.0 * np.max(np.abs(ends - starts), axis=1, initial=0.0)).astype(int) + 1
        which = np.repeat(np.arange(len(steps)), steps)
        share = (np.arange(len(which)) - np.repeat(np.cumsum(steps) - steps, steps)) / steps[which]
        column, row = np.floor(starts[which] + share[:, None] * (ends - starts)[which]).astype(int).T
        rows, columns = self.covered.shape
        seen = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        return row[seen], column[seen]

    @staticmethod
    def _cover(cells: npt.NDArray[np.bool_], left: float, low: float, right: float, high: float) -> None:
        first, last, below, above = (max(int(edge), 0) for edge in (np.floor(left), np.ceil(right), np.floor(low), np.ceil(high)))
        cells[below:above, first:last] = True

    def nearest(self, point: FloatArray, size: FloatArray) -> FloatArray | None:
        """Lower left corner of the nearest place for a text of that width and height; None if none is near."""
        rows, columns = self.covered.shape
        wide, tall = np.ceil(size + 2.0 * ROOM).astype(int)
        if wide > columns or tall > rows or not (0.0 <= point[0] <= columns + 1.0 and 0.0 <= point[1] <= rows + 1.0):
            return None
        total = np.zeros((rows + 1, columns + 1), np.int64)
        total[1:, 1:] = self.covered.cumsum(axis=0, dtype=np.int64).cumsum(axis=1)
        within = total[tall:, wide:] - total[:-tall, wide:] - total[tall:, :-wide] + total[:-tall, :-wide]
        low, left = (np.arange(count, dtype=float) for count in within.shape)
        across = np.maximum(np.maximum(left - point[0], point[0] - left - wide), 0.0)
        upward = np.maximum(np.maximum(low - point[1], point[1] - low - tall), 0.0)
        gap = np.hypot(across[None, :], upward[:, None])
        # of places as near as each other the one whose middle is nearest
        middle = np.hypot((left + 0.5 * wide - point[0])[None, :], (low + 0.5 * tall - point[1])[:, None])
        worth = np.where((within == 0) & (gap <= FAR), gap + 0.05 * middle, np.inf).ravel()
        few = np.argpartition(worth, MOST_TRIED)[:MOST_TRIED] if len(worth) > MOST_TRIED else np.arange(len(worth))
        for k in few[np.argsort(worth[few], kind="stable")]:
            if not np.isfinite(worth[k]):
                break
            corner = np.array([left[k % len(left)], low[k // len(left)]]) + ROOM
            if _gap(point, corner, size) <= NEAR or not self.written[self._under(point[None, :], (corner + 0.5 * size)[None, :])].any():
                return corner
        return None
