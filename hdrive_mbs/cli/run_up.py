"""``hdrive-mbs run-up``: a rotor line through its critical speeds, driven by its own torque."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hdrive_mbs.cli.options import EffectFiles, Effects, ExportFiles, JsonFile, OutFolder, ScenePath, Settings
from hdrive_mbs.cli.output import print_tables, write_exports, write_json
from hdrive_mbs.cli.scene_source import open_scene

if TYPE_CHECKING:
    from hdrive_mbs.analysis.run_up.run_up import RunUp


def run_up(
    scene: ScenePath,
    set_: Settings = None,
    effect: Effects = None,
    effects: EffectFiles = None,
    duration: Annotated[float, typer.Option(help="Simulated time [s].")] = 2.5,
    initial_speed: Annotated[float, typer.Option(help="Speed at t = 0 [rad/s].")] = 0.0,
    coast_down: Annotated[bool, typer.Option("--coast-down", help="Drive switched off, from --initial-speed.")] = False,
    accuracy: Annotated[float, typer.Option(help="Relative error of peak amplitudes that the step is chosen for.")] = 1e-3,
    step: Annotated[float | None, typer.Option(help="Step of the trapezoidal rule [s] in place of that.")] = None,
    estimate_error: Annotated[bool, typer.Option("--estimate-error", help="Run again with half the step and state the error.")] = False,
    csv: Annotated[bool, typer.Option("--csv", help="Write the histories as CSV too.")] = False,
    out: OutFolder = None,
    export: ExportFiles = None,
    json: JsonFile = None,
) -> None:
    """Peak amplitude of each rotor and its speed, and the final speed; choose a bearing model with --set bearing=improved."""
    from hdrive_mbs.analysis.run_up import run_up as analysis
    from hdrive_mbs.engine.solvers import Trapezoidal
    from hdrive_mbs.plots import plot, save_figure

    chosen = open_scene(scene, set_ or (), effect or (), effects or ())
    options: dict[str, Any] = {"accuracy": accuracy, "initial_speed": initial_speed, "estimate_error": estimate_error}
    if step is not None:
        options["solver"] = Trapezoidal(step=step, newton_tolerance=min(max(0.01 * accuracy, 1e-10), 1e-5))
    result = (analysis.coast_down if coast_down else analysis.run_up)(chosen, duration, **options)
    folder = out or Path("results") / re.sub(r"\W+", "_", chosen.name)
    name = "coast_down" if coast_down else "run_up"
    saved = result.save(folder / f"{name}.npz")
    pictures = save_figure(plot(result), folder / name)
    table = result.to_csv(folder / f"{name}.csv") if csv else None
    files = {"result": str(saved), "csv": None if table is None else str(table), "pictures": [str(path) for path in pictures]}
    write_exports(result, export)
    write_json(json, {"scene": chosen.name, **figures(result), **files, "origin": result.made_from()})
    if json != "-":
        print_tables(chosen.name, result.status, result.tables())
        print(f"{result.steps} steps, {result.seconds:.3f} s CPU. Result: {saved}. Picture: {pictures[0]}.")
    if not result.status.startswith("complete"):
        raise typer.Exit(130)


def figures(result: RunUp) -> dict[str, Any]:
    """What the JSON file holds: amplitudes in m, 0-peak; speeds in rad/s, true sense."""
    rotors = {
        name: {
            "peak_amplitude": result.peak_amplitude[name],
            "speed_at_peak": result.peak_speed[name],
            "time_at_peak": result.peak_time[name],
            "estimated_error": result.peak_error.get(name),
            "mass_centre_peak_amplitude": result.mass_centre_amplitude[name],
            "mass_centre_speed_at_peak": result.mass_centre_speed[name],
            "peak_distance_from_axis": result.peak_distance[name],
            "final_speed": result.final_speeds[name],
            "peaks": [peak._asdict() for peak in result.peaks(name)],
        }
        for name in result.rotors
    }
    return {
        "status": result.status,
        "duration": float(result.times[-1]),
        "rotors": rotors,
        "final_speed": result.final_speed,
        "reference": result.reference,
        "captured": result.captured,
        "acceleration": result.acceleration,
        "applied_torque": result.applied_torque,
        "whirl_torque": result.whirl_torque,
        "driven_speed": result.driven_speed,
        "critical_speeds": result.critical_speeds,
        "amplitudes": "m, 0-peak, about the static position",
        "solver": result.settings["solver"],
        "step": result.settings["step"],
        "steps": result.steps,
        "seconds": result.seconds,
    }
