"""Animation of a time response: its rotor line, or the teeth of its gear."""

from __future__ import annotations

import os
import threading
from pathlib import Path

from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.errors import AnalysisError, ParameterError
from hdrive_mbs.plots.animation import animate
from hdrive_mbs.plots.drive_animation import DrivePicture, toothed_drives
from hdrive_mbs.plots.line_animation import LinePicture
from hdrive_mbs.plots.recording import check_request, record
from hdrive_mbs.scene import Scene

VIEWS = ("line", "drive")


@animate.register
def animate_response(
    result: Response,
    path: str | os.PathLike[str],
    *,
    view: str | None = None,
    gear: str | None = None,
    times: tuple[float, float] | None = None,
    frames: int = 120,
    seconds: float = 10.0,
    magnification: float | None = None,
    dpi: float = 100,
    progress: bool | None = None,
    cancel: threading.Event | None = None,
) -> Path:
    """Write a run in motion, GIF, HTML or MP4 by the ending of the path; returns the path.

    view : "line" (deflected shafts, orbits, bearings) or "drive" (teeth, generator, torque over twist); if not given the
        line where there is one, else the drive
    gear : name of the drive with teeth; if not given, the first one
    times : first and last time shown [s]; the whole run if not given
    frames, seconds : number of frames and how long they take [s]
    magnification : of displacements in the line (and of the generator's w0 in the drive); if not given, one that can be seen
    progress, cancel : a progress bar; an event that stops it, so that nothing is written

    Where the shaft turns too far from frame to frame the frames are those of a stroboscope, which the picture says.
    Raises AnalysisError for a run without what the view shows, DependencyError for MP4 without ffmpeg.
    """
    check_request(path, frames, seconds, dpi)
    scene = result.scene
    if scene is None:
        raise AnalysisError(
            "The scene of this run cannot be made from its file, so its parts cannot be drawn. Where the scene has classes of your own,"
            " import their module before the file is loaded (--effects FILE.py on the command line); otherwise simulate it again."
        )
    chosen = view or ("line" if scene.network().is_lateral else "drive")
    if chosen not in VIEWS:
        raise ParameterError(f"view = {view!r}: must be one of {', '.join(VIEWS)}.")
    if magnification is not None and not 0.0 < magnification < 1e9:
        raise ParameterError(f"magnification = {magnification!r}: must be greater than 0.")
    if chosen == "line":
        _check_line(scene)
        picture: LinePicture | DrivePicture = LinePicture(result, scene, times, frames, seconds, magnification)
    else:
        picture = DrivePicture(result, scene, toothed_drives(scene, gear), times, frames, seconds, magnification)
    return record(picture, path, seconds=seconds, dpi=dpi, progress=progress, cancel=cancel)


def _check_line(scene: Scene) -> None:
    if not scene.network().is_lateral:
        raise AnalysisError(f"Nothing in {scene.name!r} moves across its axis, so there is no line to draw; take view='drive'.")
