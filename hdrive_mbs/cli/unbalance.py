"""``hdrive-mbs unbalance``: steady response of a rotor line to its unbalance."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from hdrive_mbs.cli.options import EffectFiles, Effects, ExportFiles, JsonFile, OutFolder, ScenePath, Settings
from hdrive_mbs.cli.output import print_tables, write_exports, write_json
from hdrive_mbs.cli.scene_source import open_scene
from hdrive_mbs.cli.speeds import parse_speeds
from hdrive_mbs.errors import ParameterError, unknown_place

if TYPE_CHECKING:
    from hdrive_mbs.analysis.unbalance.unbalance_response import UnbalanceResponse


def unbalance(
    scene: ScenePath,
    set_: Settings = None,
    effect: Effects = None,
    effects: EffectFiles = None,
    speeds: Annotated[
        str,
        typer.Option(metavar="FIRST:LAST:COUNT", help="Speeds of the reference shaft [rad/s], or with units: '0:12000:401 rpm'."),
    ] = "0:1000:401",
    places: Annotated[str | None, typer.Option(metavar="PLACE,PLACE,...", help="Places to write; all if not given.")] = None,
    extra: Annotated[
        list[str] | None, typer.Option("--extra", metavar="PLACE=KG_M@RAD", help="Trial mass, e.g. rotor_2=1e-5@0.5 (several times).")
    ] = None,
    out: OutFolder = None,
    export: ExportFiles = None,
    json: JsonFile = None,
) -> None:
    """Amplitude and phase of steady whirl over speed; every amplitude is 0-peak."""
    from hdrive_mbs.analysis.unbalance.unbalance_response import unbalance_response

    chosen = open_scene(scene, set_ or (), effect or (), effects or ())
    grid = parse_speeds("--speeds", speeds)
    result = unbalance_response(chosen, grid, extra=dict(_trial(text) for text in extra or ()))
    wanted = result.places if places is None else tuple(name.strip() for name in places.split(","))
    for name in wanted:
        if name not in result.places:
            raise unknown_place("place", name, result.places)
    if out is not None:
        from hdrive_mbs.plots import plot, save_figure

        result.save(out / "unbalance.npz")
        result.to_csv(out / "unbalance.csv")
        drawn = None if places is None else list(wanted)
        for view in ("bode", "polar", "orbits", *(("forces",) if result.bearings else ())):
            save_figure(plot(result, view=view, places=None if view == "forces" else drawn), out / f"unbalance_{view}")
    write_exports(result, export)
    write_json(json, {**_document(result, wanted), "origin": result.made_from()})
    if json != "-":
        (table,) = result.tables()
        shown = dataclasses.replace(table, rows=tuple(row for row in table.rows if row[0] in wanted))
        print_tables(chosen.name, result.status, [shown])
        print(f"{len(grid)} speeds, {result.seconds:.3f} s CPU.")


def _trial(text: str) -> tuple[str, tuple[float, float]]:
    place, sign, value = text.partition("=")
    size, at, angle = value.partition("@")
    try:
        if not sign:
            raise ValueError
        return place.strip(), (float(size), float(angle) if at else 0.0)
    except ValueError:
        raise ParameterError(f"--extra {text!r}: write PLACE=KG_M@RAD, like rotor_2=1e-5@0.5.") from None


def _document(result: UnbalanceResponse, places: tuple[str, ...]) -> dict[str, Any]:
    def place(name: str, group: int) -> dict[str, Any]:
        one = result.of(name, group)
        return {
            "major": one.major,
            "minor": one.minor,
            "inclination": one.inclination,
            "forward": one.forward,
            "backward": one.backward,
            "x": {"amplitude": np.abs(one.x), "phase_lag": one.phase_lag_x},
            "y": {"amplitude": np.abs(one.y), "phase_lag": one.phase_lag_y},
        }

    def response(group: int) -> dict[str, Any]:
        return {
            "frequency_ratio": float(result.frequency_ratios[group]),
            "places": {name: place(name, group) for name in places},
            "bearing_forces": {
                name: {"major": (force := result.force(name, group)).major, "minor": force.minor} for name in result.bearings
            },
        }

    return {
        "status": result.status,
        "speeds": result.speeds,
        "amplitudes": "0-peak",
        **response(0),
        "peaks": [peak._asdict() for peak in result.peaks if peak.place in places],
        "other_frequencies": [response(group) for group in range(1, len(result.frequency_ratios))],
        "seconds": result.seconds,
    }
