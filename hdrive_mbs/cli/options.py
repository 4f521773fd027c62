"""Options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from hdrive_mbs.analysis.result import check_export


def _exportable(files: list[Path] | None) -> list[Path] | None:
    """The same files.  Raises FileFormatError or DependencyError for one that nothing can be written to, before any computation."""
    for file in files or ():
        check_export(file)
    return files


ScenePath = Annotated[
    Path,
    typer.Argument(metavar="SCENE", help="A .py file with build() -> Scene, a .toml or .json scene file, or a rotor saved by ROSS."),
]
Settings = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="PATH=VALUE", help="Change a value, e.g. motor.inertia=2e-3 or 'gear.stiffness.lost_motion=3 arcmin'."),
]
Effects = Annotated[
    list[str] | None,
    typer.Option("--effect", metavar="TYPE@PLACE:field=value,...", help="Add an effect, e.g. CoulombStribeckFriction@load:coulomb=2."),
]
EffectFiles = Annotated[
    list[Path] | None,
    typer.Option("--effects", metavar="FILE.py", help="A file of your own with effects, laws or parts that the scene or --effect names."),
]
JsonFile = Annotated[str | None, typer.Option("--json", metavar="FILE", help="Write figures as JSON ('-' for stdout).")]
OutFolder = Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder for results and pictures.")]
ExportFiles = Annotated[
    list[Path] | None,
    typer.Option(
        "--export",
        metavar="FILE",
        callback=_exportable,
        help="Write the table for other programs; the ending .csv, .parquet, .h5 or .mat chooses (several times).",
    ),
]
