"""``hdrive-mbs sweep``: an analysis of a scene over a grid of values."""

from __future__ import annotations

import contextlib
import hashlib
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from hdrive_mbs.campaign.points import shown
from hdrive_mbs.cli.options import EffectFiles, Effects, ExportFiles, JsonFile, ScenePath, Settings
from hdrive_mbs.cli.output import print_table, write_exports, write_json
from hdrive_mbs.cli.scene_source import open_scene
from hdrive_mbs.cli.speeds import parse_orders, parse_speeds
from hdrive_mbs.cli.wording import on_command_line
from hdrive_mbs.errors import FileFormatError, HdriveError, ParameterError
from hdrive_mbs.quantities import Described
from hdrive_mbs.scene import Scene
from hdrive_mbs.writing import write_text

if TYPE_CHECKING:
    from hdrive_mbs.campaign.campaign import Campaign


@dataclass(frozen=True, kw_only=True)
class SceneFileAnalysis:
    """A scene file opened anew with the values of a point, and analysed: for scenes whose code only the file holds.

    sha256 : of the file and of those in ``own``, by their paths, so that a changed file makes another job
    own : files with effect classes
    """

    path: str
    sha256: Mapping[str, str]
    settings: tuple[str, ...]
    effects: tuple[str, ...]
    own: tuple[str, ...]
    analysis: str
    options: Mapping[str, Any]
    known_units: Mapping[str, str]

    def __call__(self, point: Mapping[str, Any]) -> Any:
        from hdrive_mbs.campaign.scene_figures import analysis_of

        return analysis_of(self.analysis)(self._scene(point), **self.options)

    def _scene(self, point: Mapping[str, Any]) -> Scene:
        settings = (*self.settings, *(f"{name}={value}" for name, value in point.items()))
        return open_scene(Path(self.path), settings, self.effects, [Path(file) for file in self.own])

    def check(self, point: Mapping[str, Any]) -> None:
        """Raise PlaceError at once for a name that neither the scene nor build() has."""
        with contextlib.suppress(ParameterError):  # a value out of range is that job's own failure
            self._scene(point)

    def units(self) -> dict[str, str]:
        """Unit of every number of the scene that has one."""
        return dict(self.known_units)

    def made_of(self) -> tuple[Scene, dict[str, Any]]:
        """The scene before any value of a point is put in, and the file, its digest and what the command was given."""
        return self._scene({}), {
            "file": self.path,
            "sha256": dict(self.sha256),
            "set": self.settings,
            "effect": self.effects,
            "effects": self.own,
            "analysis": self.analysis,
            "options": dict(self.options),
        }


def sweep(
    scene: ScenePath,
    vary: Annotated[
        list[str],
        typer.Option(
            metavar="PATH=VALUES",
            help="FIRST:LAST:COUNT, FIRST:LAST:COUNT:log, or A,B,C; with units '9 arcmin:12 arcmin:4'. Several times: every combination.",
        ),
    ],
    analysis: Annotated[str, typer.Option(help="modes, campbell, run-up or start-up.")] = "modes",
    set_: Settings = None,
    effect: Effects = None,
    effects: EffectFiles = None,
    torque: Annotated[float | None, typer.Option(help="Of modes: load torque [N m].")] = None,
    speed: Annotated[float | None, typer.Option(help="Of modes: motor speed [rad/s].")] = None,
    speeds: Annotated[str | None, typer.Option(metavar="FIRST:LAST:COUNT", help="Of campbell: speeds [rad/s] or with units.")] = None,
    orders: Annotated[str | None, typer.Option(metavar="N,N,...", help="Of campbell: order lines.")] = None,
    count: Annotated[int | None, typer.Option(help="Of modes and campbell: number of modes or branches.")] = None,
    duration: Annotated[float | None, typer.Option(help="Of run_up and start_up: simulated time [s].")] = None,
    initial_speed: Annotated[float | None, typer.Option(help="Of run_up: speed at t = 0 [rad/s].")] = None,
    accuracy: Annotated[float | None, typer.Option(help="Of run_up: relative error of peaks.")] = None,
    step: Annotated[float | None, typer.Option(help="Of run_up: step of the trapezoidal rule [s].")] = None,
    workers: Annotated[int | None, typer.Option(help="Processes on this machine; as many as it has cores if not given.")] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Use the dask cluster of this scheduler, like tcp://host:8786.")
    ] = None,
    retries: Annotated[int, typer.Option(help="How often a job is begun again whose worker was lost.")] = 2,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder of the campaign: jobs, result and table.")] = None,
    export: ExportFiles = None,
    json: JsonFile = None,
) -> None:
    """Run an analysis for every combination of values, on processes or a cluster; the same command with the same --out goes on."""
    from hdrive_mbs.campaign.points import grid
    from hdrive_mbs.campaign.scene_analysis import SceneAnalysis
    from hdrive_mbs.campaign.sweeping import sweep as run

    analysis = analysis.replace("-", "_")  # like the commands run-up and start-up

    given: dict[str, Any] = {
        "torque": torque,
        "speed": speed,
        "speeds": None if speeds is None else tuple(parse_speeds("--speeds", speeds).tolist()),
        "orders": None if orders is None else parse_orders("--orders", orders),
        "count": count,
        "duration": duration,
        "initial_speed": initial_speed,
        "accuracy": accuracy,
        "step": step,
    }
    options = {name: value for name, value in given.items() if value is not None}
    chosen = open_scene(scene, set_ or (), effect or (), effects or ())
    points = grid(dict(parse_values(chosen, text) for text in vary))
    plain = SceneAnalysis(scene=chosen, analysis=analysis, options=options)  # checks the options too
    task: Any = plain
    if not _travels(plain, points[0]):
        files = [file.resolve() for file in (scene, *(effects or ()))]
        task = SceneFileAnalysis(
            path=str(files[0]),
            sha256={str(file): hashlib.sha256(file.read_bytes()).hexdigest() for file in files},
            settings=tuple(set_ or ()),
            effects=tuple(effect or ()),
            own=tuple(str(file) for file in files[1:]),
            analysis=analysis,
            options=options,
            known_units=plain.units(),
        )
    folder = out or Path("results") / re.sub(r"\W+", "_", f"sweep {chosen.name}")
    result = run(task, points, executor=scheduler or "processes", workers=workers, folder=folder, retries=retries)
    result.save(folder / "campaign.npz")
    table = result.to_csv(folder / "campaign.csv")
    write_exports(result, export)
    write_json(json, document(result, str(table)))
    if json != "-":
        _print(chosen.name, result, table)
    tell_failures(result.failures, folder)
    if not bool(result.done.all()):
        raise typer.Exit(1 if result.failures and "stopped" not in result.status else 130)


def parse_values(scene: Scene, text: str) -> tuple[str, list[Any]]:
    """``gear.ratio=80:120:5``, ``gear.damping=1:100:7:log``, ``bearing=full,simplified`` -> path and values in SI."""
    from hdrive_mbs.scene_file import parse_setting

    path, sign, values = (part.strip() for part in text.partition("="))
    if not sign or not path or not values:
        raise FileFormatError(f"--vary {text!r}: write PATH=FIRST:LAST:COUNT or PATH=A,B,C.")

    def one(value: str) -> Any:
        return parse_setting(scene, f"{path}={value.strip()}")[1]

    parts = values.split(":")
    if len(parts) == 1:
        return path, [one(value) for value in values.split(",")]
    if len(parts) not in (3, 4) or (len(parts) == 4 and parts[3].strip() != "log"):
        raise FileFormatError(f"--vary {text!r}: write PATH=FIRST:LAST:COUNT, PATH=FIRST:LAST:COUNT:log or PATH=A,B,C.")
    first, last = one(parts[0]), one(parts[1])
    try:
        count = int(parts[2])
        numbers = [float(first), float(last)]
    except ValueError:
        raise FileFormatError(f"--vary {text!r}: FIRST and LAST must be numbers and COUNT a whole number.") from None
    if count < 2:
        raise ParameterError(f"--vary {text!r}: {count} values are not a range; write at least 2, or PATH={parts[0]}.")
    if len(parts) == 4:
        if min(numbers) <= 0.0:
            raise ParameterError(f"--vary {text!r}: a logarithmic range needs values above 0.")
        return path, [float(value) for value in np.geomspace(numbers[0], numbers[1], count)]
    return path, [float(value) for value in np.linspace(numbers[0], numbers[1], count)]


def document(result: Campaign, table: str) -> dict[str, Any]:
    """What --json writes."""
    return {
        "status": result.status,
        "jobs": len(result),
        "done": int(result.done.sum()),
        "reused": result.reused,
        "columns": result.columns(),
        "failures": [dict(failure) for failure in result.failures],
        "table": table,
        "origin": result.made_from(),
    }


def _travels(task: Any, point: Mapping[str, Any]) -> bool:
    """Whether the scene itself can be sent to another process, and the names are paths in it."""
    from hdrive_mbs.scene_file import scene_to_dict

    try:
        scene_to_dict(task.scene)
        task.check(point)
    except HdriveError:
        return False  # its code is in the file; or the name is an argument of build(), and if not, opening the file says so
    items: list[Any] = [*task.scene.parts.values(), *(placed.effect for placed in task.scene.effects)]
    return all(_is_ours(item) for item in items)


def _is_ours(item: Any) -> bool:
    """Whether an object and all in it are of classes that a worker with this package has."""
    if isinstance(item, tuple):
        return all(_is_ours(entry) for entry in item)
    if not isinstance(item, Described):
        return True
    return type(item).__module__.startswith("hdrive_mbs.") and all(_is_ours(value) for _, value, _ in item.fields())


def tell_failures(failures: Sequence[Mapping[str, Any]], folder: Path, of: Callable[[Mapping[str, Any]], str] = shown) -> None:
    """Failed jobs with their parameters on stderr, and with traceback in a file; that file goes when none failed.

    of : a point in words
    """
    file = folder / "failures.txt"
    if not failures:
        file.unlink(missing_ok=True)
        return
    told = [f"failed: {of(failure['parameters'])}: {failure['error']}\n" for failure in failures]
    write_text(file, "\n".join(line + failure["traceback"] for line, failure in zip(told, failures, strict=True)))
    print(on_command_line("".join(told[:10])), end="", file=sys.stderr)
    print(f"{len(failures)} failed; all of them with traceback: {file}", file=sys.stderr)


def _print(name: str, result: Campaign, table: Path) -> None:
    columns = result.columns()
    told = [head for head in columns if head != "job" and not head.endswith("status")][:6] + (["job"] if result.failures else [])
    rows = [[cell(columns[head][k]) for head in told] for k in range(min(len(result), 40))]
    print_table(f"{name}: {result.status}", told, rows)
    reused = f", {result.reused} of them found finished" if result.reused else ""
    print(f"{int(result.done.sum())} of {len(result)} jobs done{reused}. All columns: {table}.")


def cell(value: Any) -> str:
    """A value of a table for people."""
    if isinstance(value, np.floating):
        return "-" if np.isnan(value) else f"{value:.6g}"
    return str(value)
