"""``hdrive-mbs modes``: modes at an operating point; of a rotor line whirl, torsion and axial motion."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hdrive_mbs.cli.options import EffectFiles, Effects, ExportFiles, JsonFile, OutFolder, ScenePath, Settings
from hdrive_mbs.cli.output import print_tables, write_exports, write_json
from hdrive_mbs.cli.scene_source import open_scene

if TYPE_CHECKING:
    from hdrive_mbs.scene import Scene


def modes(
    scene: ScenePath,
    set_: Settings = None,
    effect: Effects = None,
    effects: EffectFiles = None,
    torque: Annotated[float | None, typer.Option(help="Load torque [N m] in place of the scene's load at t = 0.")] = None,
    speed: Annotated[
        float | None, typer.Option(help="Motor speed [rad/s]; by default where motor and load balance, of a rotor line 0.")
    ] = None,
    count: Annotated[int, typer.Option(help="Number of modes of a rotor line.")] = 12,
    out: OutFolder = None,
    export: ExportFiles = None,
    json: JsonFile = None,
) -> None:
    """Natural frequencies, damping ratios and mode shapes of the linearised scene."""
    from hdrive_mbs.analysis.drive_train.modes import modes as analyse

    chosen = open_scene(scene, set_ or (), effect or (), effects or ())
    if chosen.network().is_lateral:
        _whirl_modes(chosen, torque, speed, count, out, export, json)
        return
    result = analyse(chosen, torque=torque, motor_speed=speed)
    if out is not None:
        from hdrive_mbs.plots import plot, save_figure

        result.save(out / "modes.npz")
        result.to_csv(out / "modes.csv")
        save_figure(plot(result), out / "modes")
    write_exports(result, export)
    write_json(
        json,
        {
            "undamped": result.undamped,
            "damped": result.damped,
            "damping_ratio": result.damping_ratio,
            "decay_rates": result.decay_rates,
            "rigid_modes": result.rigid_modes,
            "bodies": result.bodies,
            "shapes": result.shapes.T,
            "motor_speed": result.motor_speed,
            "torques": dict(result.torques),
            "status": result.status,
            "origin": result.made_from(),
        },
    )
    if json != "-":
        print_tables(chosen.name, result.status, result.tables())


def _whirl_modes(
    scene: Scene, torque: float | None, speed: float | None, count: int, out: Path | None, export: list[Path] | None, json: str | None
) -> None:
    from hdrive_mbs.analysis.operating_point import with_load
    from hdrive_mbs.analysis.whirl.whirl_modes import whirl_modes

    result = whirl_modes(scene if torque is None else with_load(scene, torque), speed or 0.0, count=count)
    if out is not None:
        from hdrive_mbs.plots import plot, save_figure

        result.save(out / "modes.npz")
        result.to_csv(out / "modes.csv")
        save_figure(plot(result), out / "modes")
    fields = zip(result.whirl, result.frequencies, result.natural, result.damping_ratios, result.log_decrements, strict=True)
    rows = [list(row) for row in fields]
    write_exports(result, export)
    write_json(
        json,
        {
            "speed": result.speed,
            "modes": [dict(zip(("whirl", "frequency", "natural", "damping_ratio", "log_decrement"), row, strict=True)) for row in rows],
            "decay_rates": result.decay_rates,
            "free_motions": result.free_motions,
            "status": result.status,
            "origin": result.made_from(),
        },
    )
    if json != "-":
        print_tables(scene.name, result.status, result.tables())
