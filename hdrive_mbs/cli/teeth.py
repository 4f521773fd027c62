"""``hdrive-mbs teeth``: positions and clearances of the teeth; ``hdrive-mbs teeth design``: the design window."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from hdrive_mbs.cli.options import JsonFile, OutFolder, Settings
from hdrive_mbs.cli.output import print_table, write_json
from hdrive_mbs.cli.scene_source import call, module_of, open_scene
from hdrive_mbs.errors import ParameterError, SceneError

if TYPE_CHECKING:
    from hdrive_mbs.teeth.gear import WaveGear
    from hdrive_mbs.teeth.stage import Stage


def teeth(
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="[design] SCENE",
            help="A .py file with gear() or build(), or a scene file with a gear that has teeth; 'design' before it.",
        ),
    ],
    set_: Settings = None,
    stage: Annotated[int | None, typer.Option(help="Only this stage, counted from 1.")] = None,
    step: Annotated[float, typer.Option(help="Step of the generator angle [deg].")] = 10.0,
    to: Annotated[float, typer.Option(help="Last generator angle [deg].")] = 180.0,
    per_variable: Annotated[int, typer.Option(help="design: points per variable of the grid.")] = 10,
    animation: Annotated[bool, typer.Option(help="With --out, write the animation meshing.gif too, some seconds.")] = True,
    out: OutFolder = None,
    json: JsonFile = None,
) -> None:
    """Successive tooth positions, clearances and zones of a wave gear; 'design' searches the window of its parameters.

    Angles are counted from the tooth's starting axis: the minor axis of the generator in stage 1, the major one in stage 2.
    """
    designing = words[0] == "design"
    paths = words[1:] if designing else words
    if len(paths) != 1:
        raise ParameterError(f"teeth takes one SCENE, found {len(paths)}: write 'teeth SCENE.py' or 'teeth design SCENE.py'.")
    gear = find_gear(Path(paths[0]), set_ or ())
    stages = gear.stages()
    if stage is not None and not 1 <= stage <= len(stages):
        raise ParameterError(f"--stage {stage}: this gear has the stages 1 to {len(stages)}.")
    numbers = range(1, len(stages) + 1) if stage is None else (stage,)
    chosen = [(number, stages[number - 1]) for number in numbers]
    if designing:
        _design(chosen, per_variable, out, json)
        return
    if not step > 0.0 or not to >= step:
        raise ParameterError(f"--step {step:g} --to {to:g}: the step must be greater than 0 deg and at most the last angle.")
    _positions(gear, chosen, step, to, out, json, animation)


def find_gear(path: Path, settings: tuple[str, ...] | list[str] = ()) -> WaveGear:
    """The gear of a .py file (its gear(), or what build() returns) or of the first part with teeth in a scene."""
    from hdrive_mbs.scene import Scene
    from hdrive_mbs.teeth.gear import WaveGear

    found: Any = None
    if path.suffix == ".py":
        module = module_of(path)
        make = getattr(module, "gear", None)
        if callable(make):
            found, rest = call(make, settings)
            if rest:
                raise ParameterError(f"--set {rest[0]}: gear() of {path} has no such argument.")
    if found is None:
        scene: Scene = open_scene(path, settings)
        found = next((part.teeth for part in scene.parts.values() if getattr(part, "teeth", None) is not None), None)  # type: ignore[attr-defined]
    if not isinstance(found, WaveGear):
        raise SceneError(
            f"{path} has no gear with teeth. Give it a function gear() that returns a HarmonicGear or DoubleHarmonicGear, "
            "or make the drive of the scene with HarmonicDrive.from_gear."
        )
    return found


def _positions(
    gear: WaveGear, stages: list[tuple[int, Stage]], step: float, to: float, out: Path | None, json: str | None, animation: bool
) -> None:
    from hdrive_mbs.teeth.clearance import clearances
    from hdrive_mbs.teeth.motion import steps, tooth_motion
    from hdrive_mbs.teeth.zones import stage_zones

    angles = steps(np.radians(step), np.radians(to))
    entries: list[dict[str, Any]] = []
    rows = []
    for number, stage in stages:
        printed, exact = tooth_motion(stage, angles, exact=False), tooth_motion(stage, angles)
        clear = clearances(stage)
        entries.append(
            {
                "stage": number,
                "angle_deg": np.round(np.degrees(angles), 9),
                "P": _millimetres(printed.P),
                "R": _millimetres(printed.R),
                "P_exact": _millimetres(exact.P),
                "R_exact": _millimetres(exact.R),
                "M": _millimetres(printed.M),
                "N": _millimetres(printed.N),
                "angular_velocity": exact.angular_velocity,
                "min_clearance_mm": 1e3 * clear.minimum,
                "min_clearance_angle_deg": float(np.degrees(clear.angles[clear.worst])),
                "radial_clearance_mm": 1e3 * min(clear.radial_tip, clear.radial_root),
                "interferes": clear.interferes,
                "teeth_in_engagement": clear.teeth_in_engagement,
                "zones_from_major_axis_deg": sorted(np.degrees([zone.begin, zone.end]).tolist() for zone in stage_zones(stage)),
                "lost_motion_arcmin": 60.0 * float(np.degrees(clear.lost_motion)),
            }
        )
        rows.append(
            [
                stage.name,
                f"{stage.flexible.teeth}/{stage.rigid.teeth}",
                "yes" if clear.interferes else "no",
                f"{1e6 * clear.minimum:.1f} at {np.degrees(clear.angles[clear.worst]):.1f} deg",
                f"{1e6 * min(clear.radial_tip, clear.radial_root):.1f}",
                f"{clear.teeth_in_engagement:.0f}",
                f"{60.0 * np.degrees(clear.lost_motion):.2f}",
            ]
        )
    if out is not None:
        _pictures(gear, stages, angles, out, animation)
    write_json(json, {"ratio": gear.ratio, "explanation": gear.explain(), "lost_motion_rad": gear.lost_motion, "stages": entries})
    if json != "-":
        heads = ["stage", "teeth", "clash", "gap [um]", "bottom [um]", "in mesh", "lost [arcmin]"]
        print_table(f"ratio {gear.ratio:.8g}", heads, rows)
        print(gear.explain())


def _pictures(gear: WaveGear, stages: list[tuple[int, Stage]], angles: Any, out: Path, animation: bool) -> None:
    from hdrive_mbs.plots import animate, plot, save_figure
    from hdrive_mbs.teeth.clearance import clearances
    from hdrive_mbs.teeth.clearance_map import clearance_map
    from hdrive_mbs.teeth.motion import tooth_motion

    save_figure(plot(gear), out / "section")
    for number, stage in stages:
        save_figure(plot(tooth_motion(stage, angles)), out / f"positions_{number}")
        save_figure(plot(clearances(stage)), out / f"clearance_{number}")
        save_figure(plot(clearance_map(stage)), out / f"clearance_map_{number}")
    if animation:
        animate(gear, out / "meshing.gif")


def _design(stages: list[tuple[int, Stage]], per_variable: int, out: Path | None, json: str | None) -> None:
    from hdrive_mbs.teeth.design import DesignTask, common_amplitude

    entries = []
    windows = []
    for number, stage in stages:
        window = DesignTask.of(stage).window(per_variable=per_variable)
        windows.append(window)
        entries.append(
            {
                "stage": number,
                "status": window.status,
                "designs": len(window.points.verdict),
                "admissible": int(np.sum(window.points.admissible)),
                "best": {_unit(name): _shown(name, value) for name, value in window.best.items()},
                "bounds": [
                    {
                        "variable": _unit(bound.variable),
                        "low": _shown(bound.variable, bound.low),
                        "high": _shown(bound.variable, bound.high),
                        "below": bound.reason_low,
                        "above": bound.reason_high,
                    }
                    for bound in window.bounds
                ],
            }
        )
        if out is not None:
            from hdrive_mbs.plots import plot, save_figure

            save_figure(plot(window), out / f"design_{number}")
    shared = common_amplitude(windows)
    document: dict[str, Any] = {"stages": entries}
    if len(stages) > 1:
        document["common_amplitude_mm"] = None if shared is None else [1e3 * end for end in shared]
    write_json(json, document)
    if json != "-":
        for (_, stage), window in zip(stages, windows):
            print(f"{stage.name}, {stage.flexible.teeth}/{stage.rigid.teeth} teeth: {window.explain()}")
        if len(stages) > 1:
            found = "there is no common w0" if shared is None else f"w0 from {1e3 * shared[0]:.4f} to {1e3 * shared[1]:.4f} mm suits all"
            print(f"The stages share the flexspline: at the best points {found}.")


def _millimetres(points: Any) -> Any:
    """Lengths in mm to a femtometre, so that zeros are zeros."""
    return np.round(1e3 * points, 12) + 0.0


def _unit(name: str) -> str:
    return f"{name}_deg" if name == "profile_angle" else f"{name}_mm"


def _shown(name: str, value: float) -> float:
    return float(np.degrees(value)) if name == "profile_angle" else 1e3 * value
