"""Moving pictures to files: GIF, HTML with its own player, MP4; whole or not at all, without a display."""

from __future__ import annotations

import base64
import contextlib
import html
import io
import os
import shutil
import subprocess
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, BinaryIO, Protocol

import matplotlib
import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from hdrive_mbs.errors import AnalysisError, DependencyError, ParameterError
from hdrive_mbs.plots.look import house_look
from hdrive_mbs.progress import progress_bar
from hdrive_mbs.writing import write_whole

Pixels = npt.NDArray[np.uint8]

COLOURS = 128
"""Of the palette, which is that of the first frame."""


class MovingPicture(Protocol):
    """A figure that can show each of its frames.

    description : the text alternative: what is seen, in a sentence or two
    moving : what changes from frame to frame, drawn over all the rest, which is drawn once; empty to draw everything anew
    """

    figure: Figure
    count: int
    description: str

    @property
    def moving(self) -> Sequence[Artist]: ...

    def show(self, number: int) -> None:
        """Draw frame number 0 .. count - 1."""


def check_request(path: str | os.PathLike[str], frames: int, seconds: float, dpi: float) -> None:
    """Raise before anything is drawn: an unknown ending, a missing encoder, numbers that make no film."""
    ending = Path(path).suffix.lower()
    if ending not in _WRITERS:
        raise ParameterError(f"{path}: an animation is written as {', '.join(_WRITERS)}; the ending {ending!r} is none of them.")
    if ending == ".mp4" and _encoder() is None:
        raise DependencyError(
            "An MP4 file needs the program ffmpeg, which is not found. Install it (pip install 'hdrive-mbs[video]', 'apt install "
            "ffmpeg' or 'conda install ffmpeg'), or write a .gif or .html file."
        )
    if not (isinstance(frames, (int, np.integer)) and 2 <= frames <= 5000):
        raise ParameterError(f"frames = {frames!r}: must be a whole number from 2 to 5000.")
    if not (0.0 < seconds <= 3600.0):
        raise ParameterError(f"seconds = {seconds!r} s: the animation must take more than 0 s, and at most 3600 s.")
    if not (20.0 <= dpi <= 400.0):
        raise ParameterError(f"dpi = {dpi!r}: must be between 20 and 400 points per inch.")


def record(
    picture: MovingPicture,
    path: str | os.PathLike[str],
    *,
    seconds: float,
    dpi: float,
    progress: bool | None = None,
    cancel: threading.Event | None = None,
) -> Path:
    """Draw all frames and write the file.

    seconds : that the animation takes
    progress : show a progress bar; None for "when stderr is a terminal"
    cancel : when it is set, nothing is written (an older file stays) and AnalysisError is raised
    """
    check_request(path, picture.count, seconds, dpi)
    writer = _WRITERS[Path(path).suffix.lower()]
    step = seconds / picture.count
    with progress_bar(f"{Path(path).name}: {picture.count} frames", picture.count, progress) as report:
        frames = _frames(picture, dpi, report, cancel)
        return write_whole(path, lambda file: writer(file, frames, step, picture.description))


def _frames(picture: MovingPicture, dpi: float, report: Callable[[float], None] | None, cancel: threading.Event | None) -> Iterator[Pixels]:
    with house_look():
        picture.figure.set_dpi(dpi)
        canvas = FigureCanvasAgg(picture.figure)
        moving = sorted(picture.moving, key=lambda artist: artist.get_zorder())
        for artist in moving:
            artist.set_animated(True)
        still: Any = None
        for k in range(picture.count):
            if cancel is not None and cancel.is_set():
                raise AnalysisError(f"The animation was cancelled after {k} of {picture.count} frames; nothing was written.")
            picture.show(k)
            if still is None:
                canvas.draw()  # type: ignore[no-untyped-call]
                picture.figure.set_layout_engine("none")  # after the first frame the axes keep their place
                still = canvas.copy_from_bbox(picture.figure.bbox) if moving else None  # type: ignore[no-untyped-call]
            else:
                canvas.restore_region(still)  # type: ignore[no-untyped-call]
            for artist in moving:
                picture.figure.draw_artist(artist)
            yield np.asarray(canvas.buffer_rgba())[..., :3].copy()  # type: ignore[no-untyped-call]
            if report is not None:
                report(k + 1)


def _images(frames: Iterator[Pixels]) -> Iterator[Any]:
    """The frames in the palette of the first one, so that nothing flickers."""
    from PIL import Image

    nearest: npt.NDArray[np.uint8] | None = None
    palette: list[int] = []
    for frame in frames:
        if nearest is None:
            palette = Image.fromarray(frame).quantize(COLOURS, dither=Image.Dither.NONE).getpalette() or []
            nearest = _nearest(palette)
        parts = frame >> 3
        image = Image.fromarray(nearest[parts[..., 0], parts[..., 1], parts[..., 2]], mode="P")
        image.putpalette(palette)
        yield image


def _nearest(palette: list[int]) -> npt.NDArray[np.uint8]:
    """Index of the nearest colour for 32 levels of red, green and blue; the lightest colour becomes white, which quantising blurs."""
    colours = np.array(palette, float).reshape(-1, 3)
    lightest = int(np.argmax(colours.sum(axis=1)))
    palette[3 * lightest : 3 * lightest + 3] = [255, 255, 255]
    colours[lightest] = 255.0
    level = 8.0 * np.arange(32) + 4.0
    found = np.empty((32, 32, 32), np.uint8)
    for k, red in enumerate(level):
        cells = np.stack(np.broadcast_arrays(red, level[:, None], level[None, :]), axis=-1)
        found[k] = np.argmin(np.sum((cells[:, :, None, :] - colours) ** 2, axis=-1), axis=-1)
    found[-1, -1, -1] = lightest
    return found


def _gif(file: BinaryIO, frames: Iterator[Pixels], step: float, description: str) -> None:
    images = _images(frames)
    first = next(images)
    hundredths = max(2, round(100.0 * step))  # browsers play shorter steps slowly
    first.save(
        file,
        format="GIF",
        save_all=True,
        append_images=images,
        duration=10 * hundredths,
        loop=0,
        optimize=True,
        comment=description.encode("ascii", "replace")[:250],
    )


def _mp4(file: BinaryIO, frames: Iterator[Pixels], step: float, description: str) -> None:
    first = next(frames)
    encoder = _encoder()
    assert encoder is not None
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as messages:
        target = Path(folder) / "animation.mp4"
        height, width = first.shape[:2]
        command = [encoder, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"]
        command += ["-r", f"{1.0 / step:.6g}", "-i", "-", "-an", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white"]
        command += ["-pix_fmt", "yuv420p", "-movflags", "+faststart", "-metadata", f"comment={description}", str(target)]
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=messages)
        assert process.stdin is not None
        try:
            process.stdin.write(first.tobytes())
            for frame in frames:
                process.stdin.write(frame.tobytes())
            process.stdin.close()
            done = process.wait()
        except BrokenPipeError:
            done = process.wait()
        except BaseException:
            process.kill()
            process.wait()
            raise
        if done or not target.exists():
            messages.seek(0)
            said = messages.read().decode(errors="replace").strip()
            raise DependencyError(
                f"ffmpeg ({encoder}) could not write the file: {said or f'exit code {done}'}. Write a .gif or .html file."
            )
        with open(target, "rb") as made:
            shutil.copyfileobj(made, file)


def _encoder() -> str | None:
    """That of matplotlib's settings, or else the one that the package imageio-ffmpeg brings."""
    found = shutil.which(str(matplotlib.rcParams["animation.ffmpeg_path"]))
    if found is None:
        with contextlib.suppress(ImportError, RuntimeError):  # RuntimeError: it has none for this machine
            import imageio_ffmpeg

            found = imageio_ffmpeg.get_ffmpeg_exe()
    return found


def _html(file: BinaryIO, frames: Iterator[Pixels], step: float, description: str) -> None:
    """A page that needs nothing but itself: frames as PNG in the page, a player of some lines."""
    sources = []
    for image in _images(frames):
        packed = io.BytesIO()
        image.save(packed, format="PNG")
        sources.append("data:image/png;base64," + base64.b64encode(packed.getvalue()).decode())
    listed = ",\n".join(f'"{source}"' for source in sources)
    words = html.escape(description, quote=True)
    page = _PAGE.replace("@WORDS@", words).replace("@FIRST@", sources[0]).replace("@LAST@", str(len(sources) - 1))
    file.write(page.replace("@STEP@", f"{1e3 * step:.6g}").replace("@FRAMES@", listed).encode())


_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>@WORDS@</title>
<style>
body { margin: 0; font: 16px/1.4 system-ui, sans-serif; color: #222; background: #fff; }
figure { margin: 0 auto; padding: 0.5rem; max-width: 1100px; }
img { width: 100%; height: auto; display: block; }
.player { display: flex; gap: 0.5rem; align-items: center; padding: 0.5rem 0; }
.player input { flex: 1; min-width: 4rem; }
button { font: inherit; min-width: 5rem; padding: 0.3rem 0.6rem; }
</style>
</head>
<body>
<figure>
<img id="frame" alt="@WORDS@" src="@FIRST@">
<div class="player">
<button id="play" type="button">Pause</button>
<input id="place" type="range" min="0" max="@LAST@" value="0" aria-label="frame">
</div>
<figcaption>@WORDS@</figcaption>
</figure>
<script>
const frames = [
@FRAMES@
];
const image = document.getElementById("frame"), place = document.getElementById("place"), play = document.getElementById("play");
let at = 0, timer = null;
function show(k) { at = (k + frames.length) % frames.length; image.src = frames[at]; place.value = at; }
function stop() { clearInterval(timer); timer = null; play.textContent = "Play"; }
function start() { timer = setInterval(() => show(at + 1), @STEP@); play.textContent = "Pause"; }
play.onclick = () => (timer === null ? start() : stop());
place.oninput = () => { stop(); show(Number(place.value)); };
if (window.matchMedia("(prefers-reduced-motion: reduce)").matches) { stop(); } else { start(); }
</script>
</body>
</html>
"""

_WRITERS: dict[str, Callable[[BinaryIO, Iterator[Pixels], float, str], None]] = {".gif": _gif, ".html": _html, ".mp4": _mp4}
