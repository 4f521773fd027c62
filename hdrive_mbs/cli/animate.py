"""``hdrive-mbs animate``: a saved run in motion."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hdrive_mbs.cli.options import EffectFiles, JsonFile
from hdrive_mbs.cli.output import write_json
from hdrive_mbs.cli.python_file import own_types


def animate(
    result: Annotated[Path, typer.Argument(metavar="RESULT", help="A saved run: response.npz or run_up.npz.")],
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="The animation; its ending .gif, .html or .mp4 chooses the format.")],
    view: Annotated[str | None, typer.Option(help="'line' (shafts, bearings) or 'drive' (teeth); what there is if not given.")] = None,
    gear: Annotated[str | None, typer.Option(help="Name of the drive with teeth; the first one if not given.")] = None,
    from_: Annotated[float | None, typer.Option("--from", help="First time shown [s].")] = None,
    to: Annotated[float | None, typer.Option(help="Last time shown [s].")] = None,
    frames: Annotated[int, typer.Option(help="Number of frames.")] = 120,
    seconds: Annotated[float, typer.Option(help="How long the animation takes [s].")] = 10.0,
    magnification: Annotated[float | None, typer.Option(help="Of displacements; one that can be seen if not given.")] = None,
    dpi: Annotated[float, typer.Option(help="Points per inch; 100 gives about 1000 points across.")] = 100.0,
    effects: EffectFiles = None,
    json: JsonFile = None,
) -> None:
    """Draw a saved run in motion, without a display: the rotor line, or the teeth of its gear beside speed and torque."""
    from hdrive_mbs.analysis.result import load
    from hdrive_mbs.analysis.time_response import Response
    from hdrive_mbs.errors import AnalysisError
    from hdrive_mbs.plots import animate as draw

    for file in effects or ():
        own_types(file)  # the scene of the run names their classes
    run = load(result)
    if not isinstance(run, Response):
        raise AnalysisError(f"{result} holds a {type(run).__name__}; only a Response or a RunUp can be animated.")
    window = None
    if from_ is not None or to is not None:
        window = (float(run.times[0]) if from_ is None else from_, float(run.times[-1]) if to is None else to)
    made = draw(run, out, view=view, gear=gear, times=window, frames=frames, seconds=seconds, magnification=magnification, dpi=dpi)
    write_json(json, {"animation": str(made), "frames": frames, "seconds": seconds, "bytes": made.stat().st_size})
    if json != "-":
        print(f"{made}: {frames} frames, {seconds:g} s, {made.stat().st_size / 1e6:.2f} MB.")
