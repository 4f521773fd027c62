"""Animation of the meshing of a wave gear; needs no display."""

from __future__ import annotations

import os
import threading
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from hdrive_mbs.plots.animation import animate
from hdrive_mbs.plots.look import COLOURS, GREY, house_look, new_figure
from hdrive_mbs.plots.recording import check_request, record
from hdrive_mbs.teeth.gear import WaveGear
from hdrive_mbs.teeth.motion import tooth_motion
from hdrive_mbs.teeth.section import flexible_teeth, rigid_teeth
from hdrive_mbs.teeth.stage import Stage

SIDE = 3


@animate.register
def animate_meshing(
    result: WaveGear,
    path: str | os.PathLike[str],
    *,
    frames: int = 40,
    seconds: float = 4.0,
    dpi: float = 90,
    progress: bool | None = None,
    cancel: threading.Event | None = None,
) -> Path:
    """Write all stages over one wave, seen from the rigid wheel; it repeats without a jump.

    In one wave every flexible tooth moves on by one pitch.  The marked tooth draws the path of its tip.
    """
    check_request(path, frames, seconds, dpi)
    return record(MeshingPicture(result, frames), path, seconds=seconds, dpi=dpi, progress=progress, cancel=cancel)


class MeshingPicture:
    """All stages of a gear over one wave."""

    def __init__(self, gear: WaveGear, count: int) -> None:
        stages = gear.stages()
        self.count = count
        self.moving: tuple[Artist, ...] = ()
        self.description = f"Meshing teeth over one wave of the generator: {', '.join(stage.name for stage in stages)}."
        with house_look():
            self.figure = new_figure(5.2 * len(stages), 2.8)
            self._panels = [_Panel(ax, stage) for ax, stage in zip(np.atleast_1d(self.figure.subplots(1, len(stages))), stages)]

    def show(self, number: int) -> None:
        for panel in self._panels:
            panel.show(number / self.count)


class _Panel:
    """One stage in the frame of its rigid wheel."""

    def __init__(self, ax: Axes, stage: Stage) -> None:
        self.ax, self.stage = ax, stage
        self.shift = np.array([0.0, stage.fibre_radius])
        self.numbers = np.arange(-SIDE - 2.0, SIDE + 3.0)
        line = 1e3 * (rigid_teeth(stage, self.numbers).reshape(-1, 2) - self.shift)
        self._fill(line, stage.direction, "#E0E0E0", GREY)
        self.body = self._fill(self._contour(0.0), -stage.direction, "#CFE4F2", COLOURS[0])
        (self.marked,) = ax.fill([0.0], [0.0], facecolor="#F4B183", edgecolor=COLOURS[1], linewidth=1.0)
        self.path = 1e3 * tooth_motion(stage, np.linspace(0.0, 2.0 * np.pi / stage.waves, 181)).P
        ax.plot(self.path[:, 0], self.path[:, 1], color=COLOURS[1], linestyle="-", linewidth=0.8)
        pitch = 1e3 * stage.rigid.pitch_angle * stage.rigid.tip_radius
        middle = 0.5 * (self.path[0, 0] + self.path[-1, 0])
        ax.set_xlim(middle - 2.4 * pitch, middle + 2.4 * pitch)
        reach = 1e3 * stage.flexible.height
        tips = 1e3 * (np.array([stage.flexible.tip_radius, stage.rigid.root_radius]) - stage.fibre_radius)
        inside, outside = np.sort(tips - 1e3 * stage.direction * np.array([1.9, -0.5]) * stage.flexible.height)
        ax.set_ylim(inside - 0.2 * reach, outside + 0.2 * reach)
        ax.set_aspect("equal", adjustable="box")
        ax.grid(False)
        ax.set_xlabel("x [mm]")
        ax.set_ylabel("y from the fibre [mm]")

    def _contour(self, phi: float) -> Any:
        return 1e3 * (flexible_teeth(self.stage, phi, self.numbers).reshape(-1, 2) - self.shift)

    def _closed(self, line: Any, side: int) -> Any:
        ends = line[[-1, 0]].copy()
        ends[:, 1] += side * 4.0
        return np.vstack((line, ends))

    def _fill(self, line: Any, side: int, colour: str, edge: str) -> Polygon:
        patch = Polygon(self._closed(line, side), closed=True, facecolor=colour, edgecolor=edge, linewidth=0.9)
        self.ax.add_patch(patch)
        return patch

    def show(self, part: float) -> None:
        """The position after this part of a wave."""
        phi = 2.0 * np.pi / self.stage.waves * part
        self.body.set_xy(self._closed(self._contour(phi), -self.stage.direction))
        own = 1e3 * (flexible_teeth(self.stage, phi, np.zeros(1))[0] - self.shift)
        self.marked.set_xy(own)
        self.ax.set_title(f"{self.stage.name}: generator at {np.degrees(phi):5.1f}° from the starting axis")
