"""``hdrive-mbs demo``: the main job on a bundled scene, in under a minute."""

from __future__ import annotations

import time
from importlib import resources
from pathlib import Path
from typing import Annotated

import numpy as np
import typer

from hdrive_mbs.cli.options import JsonFile
from hdrive_mbs.cli.output import print_table, write_json
from hdrive_mbs.scene import Scene
from hdrive_mbs.scene_file import load_scene


def demo_scene() -> Scene:
    """The train of seed F (the same as models/harmonic_drive_train.py), from its scene file."""
    with resources.as_file(resources.files("hdrive_mbs") / "data" / "harmonic_drive_train.toml") as path:
        return load_scene(path)


def demo(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder for results and pictures.")] = Path("demo"),
    json: JsonFile = None,
) -> None:
    """Start a motor - harmonic drive - machine train, find its modes, torsion and critical speeds."""
    from hdrive_mbs.analysis.drive_train.campbell import torsional_campbell
    from hdrive_mbs.analysis.drive_train.modes import modes
    from hdrive_mbs.analysis.drive_train.torsion import torsion
    from hdrive_mbs.analysis.result import Result
    from hdrive_mbs.analysis.time_response import simulate
    from hdrive_mbs.effects.kinematic_error import KinematicError
    from hdrive_mbs.plots import plot, save_figure
    from hdrive_mbs.scene_file import save_scene

    started = time.perf_counter()
    scene = demo_scene()
    out.mkdir(parents=True, exist_ok=True)
    save_scene(scene, out / "scene.toml")
    with_error = scene.with_effect(KinematicError(amplitude=1e-4, order=2.0), at="gear.mesh")
    results: dict[str, Result] = {
        "start_up": simulate(scene, 1.5, sample_step=5e-4),
        "start_up_kinematic_error": simulate(with_error, 1.5, sample_step=5e-4),
        "torsion": torsion(scene),
        "modes": modes(scene),
        "campbell": torsional_campbell(scene, np.linspace(2.0, 160.0, 60), orders={"gear.wave_generator": (1.0, 2.0, 4.0)}, torque=20.0),
    }
    rows = []
    for name, result in results.items():
        result.save(out / f"{name}.npz")
        result.to_csv(out / f"{name}.csv")
        pictures = save_figure(plot(result), out / name)
        rows.append([name, result.status, str(pictures[0])])
    seconds = time.perf_counter() - started
    document = {"seconds": seconds, "folder": str(out), "results": {row[0]: {"status": row[1], "picture": row[2]} for row in rows}}
    write_json(json, document)
    if json != "-":
        print_table(f"{scene.name}: {seconds:.1f} s", ["result", "status", "picture"], rows)
