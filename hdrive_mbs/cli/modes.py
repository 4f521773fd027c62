"""``hdrive-mbs modes``: modes at an operating point; of a rotor line whirl, torsion and axial motion."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hdrive_mbs.cli.options import EffectFiles, Effects, JsonFile, OutFolder, ScenePath, Settings
from hdrive_mbs.cli.output import print_table, write_json
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
    json: JsonFile = None,
) -> None:
    """Natural frequencies, damping ratios and mode shapes of the linearised scene."""
    from hdrive_mbs.analysis.drive_train.modes import modes as analyse

    chosen = open_scene(scene, set_ or (), effect or (), effects or ())
    if chosen.network().is_lateral:
        _whirl_modes(chosen, torque, speed, count, out, json)
        return
    result = analyse(chosen, torque=torque, motor_speed=speed)
    if out is not None:
        from hdrive_mbs.plots import plot, save_figure

        result.save(out / "modes.npz")
        result.to_csv(out / "modes.csv")
        save_figure(plot(result), out / "modes")
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
        rows = []
        for k, frequency in enumerate(result.undamped):
            shape = ", ".join(f"{body} {result.shapes[i, k]:+.3f}" for i, body in enumerate(result.bodies))
            rows.append([str(k + 1), float(frequency), float(frequency / 6.283185307179586), shape])
        print_table(f"{chosen.name}: undamped ({result.status})", ["mode", "[rad/s]", "[Hz]", "shape: angles, true sense"], rows)
        damped = [[str(k + 1), float(w), float(z)] for k, (w, z) in enumerate(zip(result.damped, result.damping_ratio, strict=True))]
        print_table("damped", ["mode", "[rad/s]", "damping ratio"], damped)
        if len(result.decay_rates):
            print("non-oscillating motions decay with " + ", ".join(f"{rate:.4g}" for rate in result.decay_rates) + " 1/s")


def _whirl_modes(scene: Scene, torque: float | None, speed: float | None, count: int, out: Path | None, json: str | None) -> None:
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
        headers = ["mode", "whirl", "damped [rad/s]", "|eigenvalue| [rad/s]", "damping ratio", "log decrement"]
        shown = [[str(k), row[0], *(f"{value:.6g}" for value in row[1:])] for k, row in enumerate(rows, start=1)]
        print_table(f"{scene.name}: modes at {result.speed:g} rad/s ({result.status})", headers, shown)
        if result.free_motions:
            print(f"{result.free_motions} motions are held by no spring")
        if len(result.decay_rates):
            print("non-oscillating motions decay with " + ", ".join(f"{rate:.4g}" for rate in result.decay_rates) + " 1/s")
