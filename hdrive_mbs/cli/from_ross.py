"""``hdrive-mbs from-ross``: a rotor saved by ROSS as a scene file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer


def from_ross(
    rotor: Annotated[Path, typer.Argument(metavar="FILE", help="A rotor saved by ROSS (Rotor.save), .toml or .json.")],
    out: Annotated[Path, typer.Option("--out", metavar="SCENE", help="The scene file; its ending .toml or .json chooses the format.")],
    leave_out: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="What does not map and may be left out, like 'Seal 2' or '*.alpha' (several times)."),
    ] = None,
    name: Annotated[str | None, typer.Option(help="Of the scene; that of the file if not given.")] = None,
) -> None:
    """Write a rotor of ROSS as a scene file; what does not map is listed, and left out only where that is agreed to."""
    from hdrive_mbs.ross_file.reading import read_rotor
    from hdrive_mbs.scene_file import save_scene

    scene, left_out = read_rotor(rotor, leave_out=leave_out or (), name=name)
    for line in left_out:
        print(f"left out: {line}", file=sys.stderr)
    print(f"{save_scene(scene, out)}: {scene.name}, {len(scene.parts)} parts.")
