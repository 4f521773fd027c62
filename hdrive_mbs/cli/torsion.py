"""``hdrive-mbs torsion``: static torsion curve."""

from __future__ import annotations

from typing import Annotated

import typer

from hdrive_mbs.cli.options import EffectFiles, Effects, ExportFiles, JsonFile, OutFolder, ScenePath, Settings
from hdrive_mbs.cli.output import print_tables, write_exports, write_json
from hdrive_mbs.cli.scene_source import open_scene
from hdrive_mbs.errors import ParameterError


def torsion(
    scene: ScenePath,
    set_: Settings = None,
    effect: Effects = None,
    effects: EffectFiles = None,
    at: Annotated[str, typer.Option(help="Gear or shaft whose twist is measured.")] = "gear",
    between: Annotated[str | None, typer.Option(metavar="A,B", help="Twist between two places instead, input A held.")] = None,
    torques: Annotated[str | None, typer.Option(metavar="T,T,...", help="Torques [N m].")] = None,
    largest: Annotated[float | None, typer.Option(help="Largest torque of an even grid [N m].")] = None,
    out: OutFolder = None,
    export: ExportFiles = None,
    json: JsonFile = None,
) -> None:
    """Torque against angle with the input held, as a gear catalogue measures it."""
    from hdrive_mbs.analysis.drive_train.torsion import torsion as analyse

    chosen = open_scene(scene, set_ or (), effect or (), effects or ())
    wanted = None if torques is None else _numbers(torques)
    if between is not None:
        first, _, second = between.partition(",")
        result = analyse(chosen, wanted, between=(first.strip(), second.strip()), largest_torque=largest)
    else:
        result = analyse(chosen, wanted, at=at, largest_torque=largest)
    if out is not None:
        from hdrive_mbs.plots import plot, save_figure

        result.save(out / "torsion.npz")
        result.to_csv(out / "torsion.csv")
        save_figure(plot(result), out / "torsion")
    write_exports(result, export)
    write_json(json, {"torque": result.torque, "angle": result.angle, "origin": result.made_from()})
    if json != "-":
        print_tables(chosen.name, result.status, result.tables())


def _numbers(text: str) -> list[float]:
    try:
        return [float(item) for item in text.split(",")]
    except ValueError:
        raise ParameterError(f"--torques {text!r}: write numbers in N m with commas, like 23.5,98,137.") from None
