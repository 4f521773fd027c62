"""``hdrive-mbs modes``: torsional modes at an operating point."""

from __future__ import annotations

from typing import Annotated

import typer

from hdrive_mbs.cli.options import Effects, JsonFile, OutFolder, ScenePath, Settings
from hdrive_mbs.cli.output import print_table, write_json
from hdrive_mbs.cli.scene_source import open_scene


def modes(
    scene: ScenePath,
    set_: Settings = None,
    effect: Effects = None,
    torque: Annotated[float | None, typer.Option(help="Load torque [N m] in place of the scene's load at t = 0.")] = None,
    speed: Annotated[float | None, typer.Option(help="Motor speed [rad/s]; by default where motor and load balance.")] = None,
    out: OutFolder = None,
    json: JsonFile = None,
) -> None:
    """Natural frequencies, damping ratios and mode shapes of the linearised scene."""
    from hdrive_mbs.analysis.modes import modes as analyse

    chosen = open_scene(scene, set_ or (), effect or ())
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
