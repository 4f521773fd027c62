"""``hdrive-mbs campbell``: frequencies over speed, critical speeds and stability of a rotor line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from hdrive_mbs.cli.options import EffectFiles, Effects, ExportFiles, JsonFile, OutFolder, ScenePath, Settings
from hdrive_mbs.cli.output import print_tables, write_exports, write_json
from hdrive_mbs.cli.scene_source import open_scene
from hdrive_mbs.cli.speeds import parse_orders, parse_speeds

if TYPE_CHECKING:
    from hdrive_mbs.analysis.whirl.whirl_campbell import WhirlCampbell


def campbell(
    scene: ScenePath,
    set_: Settings = None,
    effect: Effects = None,
    effects: EffectFiles = None,
    speeds: Annotated[
        str, typer.Option(metavar="FIRST:LAST:COUNT", help="Speeds of the reference shaft [rad/s], or with units: '0:12000:101 rpm'.")
    ] = "0:1000:101",
    orders: Annotated[
        str, typer.Option(metavar="N,N,...", help="Order lines, per turn of the reference shaft or 'PLACE=N,N;PLACE=N'.")
    ] = "1",
    count: Annotated[int | None, typer.Option(help="Number of branches; by default all near the highest order line.")] = None,
    out: OutFolder = None,
    export: ExportFiles = None,
    json: JsonFile = None,
) -> None:
    """Damped frequencies, damping and whirl over speed; critical speeds and stability thresholds."""
    from hdrive_mbs.analysis.whirl.whirl_campbell import campbell as analyse

    chosen = open_scene(scene, set_ or (), effect or (), effects or ())
    result = analyse(chosen, parse_speeds("--speeds", speeds), parse_orders("--orders", orders), count=count)
    if out is not None:
        from hdrive_mbs.analysis.result import write_csv
        from hdrive_mbs.plots import plot, save_figure

        result.save(out / "campbell.npz")
        result.to_csv(out / "campbell.csv")
        write_csv(out / "critical_speeds.csv", result.critical_columns())
        save_figure(plot(result), out / "campbell")
    write_exports(result, export)
    write_json(json, {**document(result), "origin": result.made_from()})
    if json != "-":
        print_tables(chosen.name, result.status, result.tables())


def document(result: WhirlCampbell) -> dict[str, Any]:
    """What --json writes."""
    return {
        "status": result.status,
        "speeds": result.speeds,
        "stable": result.stable,
        "branches": [
            {"whirl": word, "frequency": result.frequencies[:, k], "damping_ratio": result.damping_ratios[:, k]}
            for k, word in enumerate(result.whirl)
        ],
        "critical_speeds": [
            {
                "order": result.order_numbers[order],
                "of": result.order_places[order],
                "branch": result.critical_branches[k],
                "whirl": result.critical_whirl[k],
                "speed": float(result.critical_speeds[k]),
                "damping_ratio": float(result.critical_damping_ratios[k]),
                "note": result.critical_notes[k],
            }
            for k, order in enumerate(result.critical_orders)
        ],
        "thresholds": [
            {"branch": branch, "speed": float(speed), "frequency": float(frequency), "note": note}
            for branch, speed, frequency, note in zip(
                result.threshold_branches, result.threshold_speeds, result.threshold_frequencies, result.threshold_notes, strict=True
            )
        ],
    }
